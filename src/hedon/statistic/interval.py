"""How precisely is a mean, a share or a spread over worlds known?"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.law import beta_quantile, chi2_quantile, t_quantile
from hedon.statistic.minimum import FOR_INTERVAL

LEVEL = 0.95
Range = tuple[float, float]
"""Smallest and largest possible value."""
ANY: Range = (-math.inf, math.inf)
AMOUNT: Range = (0.0, math.inf)
"""Range of counts, rates, energies and lifetimes."""
SHARE: Range = (0.0, 1.0)


@dataclass(frozen=True)
class Interval:
    """A mean over worlds with its confidence interval.

    Attributes:
        mean: The mean; None if no world has a value.
        low, high: Bounds of the interval; None with fewer than `FOR_INTERVAL` worlds.
        worlds: Number of worlds with a value.
    """

    mean: float | None
    low: float | None
    high: float | None
    worlds: int


def mean_interval(values: Iterable[float | None], level: float = LEVEL, within: Range = ANY) -> Interval:
    """The mean and Student's t interval over independent worlds.

    Worlds are the sample: agents of one world are relatives, so an interval over agents would be far too narrow.

    Args:
        values: Value of each world; None and NaN are ignored.
        level: Confidence level, which assumes that worlds are normally distributed.
        within: Possible values. The interval is cut to them, which does not change its level, since the true mean
            cannot be beyond.
    """
    finite = np.array([value for value in values if value is not None and math.isfinite(value)], np.float64)
    if finite.size == 0:
        return Interval(None, None, None, 0)
    mean = float(finite.mean())
    if finite.size < FOR_INTERVAL:
        return Interval(mean, None, None, finite.size)
    half = float(t_quantile(0.5 + level / 2, finite.size - 1) * finite.std(ddof=1) / math.sqrt(finite.size))
    return Interval(mean, max(mean - half, within[0]), min(mean + half, within[1]), finite.size)


def mean_bounds(
    values: Iterable[float | None], level: float = LEVEL, within: Range = ANY
) -> tuple[float, float, float]:
    """The mean and bounds of `mean_interval`, with NaN for missing values.

    Args:
        values: Value of each world; None and NaN are ignored.
        level: Confidence level.
        within: Possible values.

    Returns:
        Mean, lower and upper bound.
    """
    interval = mean_interval(values, level, within)
    mean, low, high = (
        math.nan if number is None else number for number in (interval.mean, interval.low, interval.high)
    )
    return mean, low, high


def share_interval(count: int, of: int, level: float = LEVEL) -> tuple[float, float]:
    """Jeffreys' interval of a share: the central part of the posterior for the prior Beta(1/2, 1/2).

    Its coverage equals the level on average over shares, and is slightly higher or lower for single shares. Clopper
    and Pearson's (1934) interval always covers at least as often and is wider: five of five give 0.62 … 1 instead of
    0.48 … 1. If the count is zero or complete, the outer bound is 0 or 1. Source: Brown, Cai and DasGupta (2001),
    Statistical Science 16, 101–133, section 4.1.

    Args:
        count: Number of worlds with the property.
        of: Number of all worlds.
        level: Confidence level.

    Returns:
        Lower and upper bound.
    """
    tail = 0.5 * (1.0 - level)
    low, high = (beta_quantile(q, count + 0.5, of - count + 0.5) for q in (tail, 1.0 - tail))
    return low if count else 0.0, high if count < of else 1.0


def exact_share_interval(count: int, of: int, level: float = LEVEL) -> tuple[float, float]:
    """Clopper and Pearson's (1934) interval of a share, for verdicts: each bound is an exact one-sided binomial test.

    Args:
        count: Number of worlds with the property.
        of: Number of all worlds.
        level: Confidence level.

    Returns:
        Lower and upper bound.
    """
    tail = 0.5 * (1.0 - level)
    low = beta_quantile(tail, count, of - count + 1) if count else 0.0
    return low, beta_quantile(1.0 - tail, count + 1, of - count) if count < of else 1.0


def spread_interval(values: NDArray[np.float64], level: float = LEVEL) -> tuple[float, float, float]:
    """The standard deviation and its chi-squared interval, which assumes normally distributed values.

    Args:
        values: The values, shape (n,), two or more.
        level: Confidence level.

    Returns:
        Standard deviation, lower and upper bound.
    """
    sd = float(values.std(ddof=1))
    return sd, *_scale_bounds(sd, len(values) - 1, level)


def distance_interval(values: NDArray[np.float64], level: float = LEVEL) -> tuple[float, float, float]:
    """The root mean square and its chi-squared interval, which assumes normally distributed values with mean 0.

    Args:
        values: The values, shape (n,), one or more.
        level: Confidence level.

    Returns:
        Root mean square, lower and upper bound.
    """
    distance = math.sqrt(float(np.mean(values**2)))
    return distance, *_scale_bounds(distance, len(values), level)


def _scale_bounds(scale: float, degrees: int, level: float) -> tuple[float, float]:
    tail = 0.5 * (1.0 - level)
    low, high = (scale * math.sqrt(degrees / chi2_quantile(q, degrees)) for q in (1.0 - tail, tail))
    return low, high
