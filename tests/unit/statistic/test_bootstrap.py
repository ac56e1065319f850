import numpy as np
import pytest

from hedon.statistic.bootstrap import percentile_interval, resampled_sums


def test_the_bootstrap_has_the_theoretical_spread() -> None:
    """The mean of n numbers varies by σ/√n; with clusters of equal numbers, n is the number of clusters."""
    rng = np.random.default_rng(7)
    values = rng.normal(size=1000)
    features = np.stack([np.ones(1000), values], axis=1)
    sums = resampled_sums(features, np.arange(1000), rng, 4000)
    means = sums[:, 1] / sums[:, 0]
    assert means.std() == pytest.approx(values.std() / np.sqrt(1000), rel=0.06)
    low, high = percentile_interval(means)
    assert high - low == pytest.approx(2 * 1.96 * values.std() / np.sqrt(1000), rel=0.08)
    tens = np.repeat(values[:100], 10)
    sums = resampled_sums(np.stack([np.ones(1000), tens], axis=1), np.repeat(np.arange(100), 10), rng, 4000)
    assert (sums[:, 1] / sums[:, 0]).std() == pytest.approx(values[:100].std() / 10, rel=0.06)
