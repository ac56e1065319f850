"""Do two groups of worlds differ? Shares by Fisher's test, means by Welch's, spreads by the F law."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hedon.statistic.interval import LEVEL

Floats = NDArray[np.float64]

_EQUAL = 1e-9
"""Relative difference below which two chances are the same number, computed in two ways."""


def fisher_mid_p(count: int, of: int, other_count: int, other_of: int) -> float:
    """Two-sided mid-p value of Fisher's test that two shares are equal.

    With the total count given, the first is hypergeometric if the shares are equal. Tables that are less likely than
    the one seen count in full, those as likely as it by half: the plain test, which counts these in full, rejects far
    less often than promised where samples are small. Source: Lancaster (1961), Journal of the American Statistical
    Association 56, 223–234; Lydersen, Fagerland and Laake (2009), Statistics in Medicine 28, 1159–1175.

    Args:
        count: worlds of the first group that have it.
        of: all of its worlds.
        other_count: worlds of the second group that have it.
        other_of: all of its worlds.
    """
    least, most = max(0, count + other_count - other_of), min(of, count + other_count)
    chances = stats.hypergeom.pmf(np.arange(least, most + 1), of + other_of, count + other_count, of)
    seen = float(chances[count - least])
    less, same = chances < seen * (1.0 - _EQUAL), np.abs(chances - seen) <= seen * _EQUAL
    return float(chances[less].sum() + 0.5 * chances[same].sum())


def difference_interval(values: Floats, others: Floats, level: float = LEVEL) -> tuple[float, float, float]:
    """Difference of two means, the first minus the second, with Welch's (1947) interval; each of two values or more.

    Args:
        values: first group, (n,).
        others: second group, (m,).
        level: of confidence.

    Returns:
        Difference, lower and upper bound.
    """
    found = stats.ttest_ind(values, others, equal_var=False).confidence_interval(level)
    return float(values.mean() - others.mean()), float(found.low), float(found.high)


def spread_ratio_interval(values: Floats, others: Floats, level: float = LEVEL) -> tuple[float, float, float]:
    """Ratio of two standard deviations, the first over the second, with its interval from the F law.

    It takes both groups as normally distributed; with heavy tails it is too narrow. NaN where the second does not vary.

    Args:
        values: first group, (n,).
        others: second group, (m,).
        level: of confidence.

    Returns:
        Ratio, lower and upper bound.
    """
    spread = float(others.std(ddof=1))
    ratio = float(values.std(ddof=1)) / spread if spread > 0 else math.nan
    tail, degrees = 0.5 * (1.0 - level), (len(values) - 1, len(others) - 1)
    low, high = (ratio / math.sqrt(float(stats.f.ppf(q, *degrees))) for q in (1.0 - tail, tail))
    return ratio, low, high
