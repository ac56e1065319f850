"""Quantiles and tails equal those of `scipy.stats`, bit for bit."""

import numpy as np
from scipy import stats

from hedon.statistic import law

SHARES = np.concatenate([np.random.default_rng(1).random(200), [0.025, 0.5, 0.975]]).tolist()
VALUES = np.random.default_rng(2).normal(0.0, 3.0, 200).tolist()


def test_values_match_scipy_stats_bit_for_bit():
    for share in SHARES:
        assert law.normal_quantile(share) == stats.norm.ppf(share)
        for degrees in (1, 4, 11):
            assert law.t_quantile(share, degrees) == stats.t.ppf(share, degrees)
            assert law.chi2_quantile(share, degrees) == stats.chi2.ppf(share, degrees)
            assert law.beta_quantile(share, degrees + 0.5, 3.5) == stats.beta.ppf(share, degrees + 0.5, 3.5)
            assert law.beta_below(share, degrees + 0.5, 3.5) == stats.beta.cdf(share, degrees + 0.5, 3.5)
    for value in VALUES:
        assert (law.normal_below(value), law.normal_above(value)) == (stats.norm.cdf(value), stats.norm.sf(value))
        for degrees in (1, 4, 11):
            assert law.t_above(value, degrees) == stats.t.sf(value, degrees)
            assert law.chi2_below(value**2, degrees) == stats.chi2.cdf(value**2, degrees)
            assert law.chi2_above(value**2, degrees) == stats.chi2.sf(value**2, degrees)
