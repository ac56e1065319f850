"""Do two groups of worlds differ? Fisher's test for shares, paired or Welch's tests for means, a test for spreads."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL
from hedon.statistic.law import t_quantile
from hedon.statistic.minimum import FOR_INTERVAL

stats: Any = load("scipy.stats", suppress_warning=True)

Floats = NDArray[np.float64]

PERMUTATIONS = 9_999
_SEED = 20261124


def fisher_mid_p(count: int, of: int, other_count: int, other_of: int) -> float:
    """The two-sided mid-p value of Fisher's test that two shares are equal.

    If the shares are equal, the first count, given the total, is hypergeometric. Tables that are less likely than the
    observed one count in full, and equally likely tables count by half. The standard test counts the latter in full and
    is too conservative for small samples. Source: Lancaster (1961), Journal of the American Statistical
    Association 56, 223–234; Lydersen, Fagerland and Laake (2009), Statistics in Medicine 28, 1159–1175.

    Args:
        count: Worlds of the first group with the property.
        of: Number of worlds in the first group.
        other_count: Worlds of the second group with the property.
        other_of: Number of worlds in the second group.
    """
    total = count + other_count
    possible = range(max(0, total - other_of), min(of, total) + 1)
    ways = [math.comb(of, first) * math.comb(other_of, total - first) for first in possible]  # exact, so ties are exact
    observed = ways[count - possible.start]
    halves = sum(2 * way for way in ways if way < observed) + observed * ways.count(observed)
    return halves / (2 * math.comb(of + other_of, total))


def difference_interval(values: Floats, others: Floats, level: float = LEVEL) -> tuple[float, float, float]:
    """The difference of two means, the first minus the second, with Welch's (1947) interval.

    Args:
        values: The first group, shape (n,), two values or more.
        others: The second group, shape (m,), two values or more.
        level: Confidence level.

    Returns:
        Difference, lower and upper bound.
    """
    interval = stats.ttest_ind(values, others, equal_var=False).confidence_interval(level)
    return float(values.mean() - others.mean()), float(interval.low), float(interval.high)


@dataclass(frozen=True)
class Contrast:
    """The difference between two conditions. Unknown values are NaN.

    Attributes:
        difference: Difference of the means, the second minus the first.
        low, high: Bounds of its 95 % interval; NaN below `FOR_INTERVAL` pairs, or worlds of each condition.
        effect: Effect size: the difference in standard deviations, of pairs or within conditions.
        p: Two-sided p value of the difference.
    """

    difference: float
    low: float
    high: float
    effect: float
    p: float


def paired_contrast(values: Floats, others: Floats) -> Contrast:
    """Compares worlds in pairs, with Student's interval of the mean difference and a permutation test within pairs.

    The effect size is Cohen's d_z, the mean difference over the standard deviation of differences.

    Args:
        values: Values of the first condition, shape (pairs,).
        others: Values of the second condition in the same order, shape (pairs,).
    """
    change = others - values
    if len(change) < 2:
        return Contrast(float(change.mean()) if len(change) else math.nan, *[math.nan] * 4)
    mean, spread = float(change.mean()), float(change.std(ddof=1))
    half = t_quantile(0.5 + LEVEL / 2, len(change) - 1) * spread / math.sqrt(len(change))
    p = _permuted((change,), lambda x, axis: x.mean(axis=axis), "samples")
    bounds = (mean - half, mean + half) if len(change) >= FOR_INTERVAL else (math.nan, math.nan)
    return Contrast(mean, *bounds, mean / spread if spread > 0 else math.nan, p)


def independent_contrast(values: Floats, others: Floats) -> Contrast:
    """Compares independent worlds with Welch's (1947) t test, which keeps its level even if variances differ.

    The effect size is Hedges' g (1981).

    Args:
        values: Values of the first condition, shape (n,).
        others: Values of the second condition, shape (m,).
    """
    n, m = len(values), len(others)
    difference = float(others.mean() - values.mean()) if n and m else math.nan
    if min(n, m) < 2:
        return Contrast(difference, *[math.nan] * 4)
    pooled = math.sqrt(((n - 1) * values.var(ddof=1) + (m - 1) * others.var(ddof=1)) / (n + m - 2))
    if pooled == 0:  # no variation within conditions
        return Contrast(difference, difference, difference, math.nan, _permuted((values, others), _change))
    p = float(np.asarray(stats.ttest_ind(others, values, equal_var=False))[1])
    bounds = difference_interval(others, values)[1:] if min(n, m) >= FOR_INTERVAL else (math.nan, math.nan)
    effect = difference / pooled * (1.0 - 3.0 / (4.0 * (n + m) - 9.0))
    return Contrast(difference, *bounds, effect, p)


def _change(x: Floats, y: Floats, axis: int) -> Floats:
    return y.mean(axis=axis) - x.mean(axis=axis)


def _permuted(samples: tuple[Floats, ...], statistic: Any, kind: str = "independent") -> float:
    """The two-sided p value of a permutation test, over all permutations if there are few enough."""
    rng = np.random.default_rng(_SEED)
    result = stats.permutation_test(
        samples, statistic, permutation_type=kind, n_resamples=PERMUTATIONS, rng=rng, vectorized=True
    )
    return float(result.pvalue)


def spread_ratio_interval(values: Floats, others: Floats, level: float = LEVEL) -> tuple[float, float, float]:
    """The ratio of two spreads, the first over the second, with an interval that is valid even for heavy tails.

    The spread of a group is the geometric mean of the distances from its median, and the interval is Welch's interval
    for the mean of their logarithms. It replaces the F test, which assumes normal groups and finds differences in a
    fifth of pairs of groups with Cauchy tails and the same spread. The idea comes from Brown and Forsythe's version of
    Levene's test (1974), Journal of the American Statistical Association 69, 364-367.

    Args:
        values: The first group, shape (n,), two values or more.
        others: The second group, shape (m,), two values or more.
        level: Confidence level.

    Returns:
        Ratio, lower and upper bound; NaN if a group does not vary.
    """
    distances, other_distances = (_log_distances(sample) for sample in (values, others))
    if min(len(distances), len(other_distances)) < 2:
        return math.nan, math.nan, math.nan
    ratio, low, high = (math.exp(bound) for bound in difference_interval(distances, other_distances, level))
    return ratio, low, high


def _log_distances(values: Floats) -> Floats:
    """Logarithms of the distances from the median, without distances of 0, such as that of the middle value."""
    distances = np.abs(values - np.median(values))
    return np.log(distances[distances > 0])
