"""How sure is a mean, a share or a spread over worlds?"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.law import beta_quantile, chi2_quantile, t_quantile
from hedon.statistic.minimum import FOR_INTERVAL

LEVEL = 0.95
Range = tuple[float, float]
"""Least and greatest possible value."""
ANY: Range = (-math.inf, math.inf)
AMOUNT: Range = (0.0, math.inf)
"""Of counts, rates, energies and lifetimes."""
SHARE: Range = (0.0, 1.0)


@dataclass(frozen=True)
class Interval:
    """A mean over worlds with its interval of confidence.

    Attributes:
        mean: None where no world has a value.
        low, high: bounds of the interval; None with fewer than `FOR_INTERVAL` worlds.
        worlds: how many have a value.
    """

    mean: float | None
    low: float | None
    high: float | None
    worlds: int


def mean_interval(values: Iterable[float | None], level: float = LEVEL, within: Range = ANY) -> Interval:
    """Mean and Student's t interval over independent worlds.

    Worlds are the unit: agents of one world are relatives, so an interval over agents would be far too narrow.

    Args:
        values: one per world; None and NaN are left out.
        level: probability with which such an interval covers the true mean, if worlds are normally distributed.
        within: what values are possible. The interval is cut there, which leaves its level as it is, since no true
            mean lies beyond.
    """
    known = np.array([value for value in values if value is not None and math.isfinite(value)], np.float64)
    if known.size == 0:
        return Interval(None, None, None, 0)
    mean = float(known.mean())
    if known.size < FOR_INTERVAL:
        return Interval(mean, None, None, known.size)
    half = float(t_quantile(0.5 + level / 2, known.size - 1) * known.std(ddof=1) / math.sqrt(known.size))
    return Interval(mean, max(mean - half, within[0]), min(mean + half, within[1]), known.size)


def mean_bounds(values: Iterable[float | None], level: float = LEVEL) -> tuple[float, float, float]:
    """Mean and bounds of `mean_interval`, with NaN for what has no value.

    Returns:
        Mean, lower and upper bound.
    """
    found = mean_interval(values, level)
    mean, low, high = (math.nan if number is None else number for number in (found.mean, found.low, found.high))
    return mean, low, high


def share_interval(count: int, of: int, level: float = LEVEL) -> tuple[float, float]:
    """Jeffreys' interval of a share: the middle of the beta law that the count leaves of a prior Beta(1/2, 1/2).

    It covers as often as promised on average over shares, and at single shares a little more or less, where Clopper
    and Pearson's (1934) covers at least so often and is wider: five of five give 0.62 … 1 instead of 0.48 … 1. At no
    world and at all worlds the outer bound is 0 or 1. Source: Brown, Cai and DasGupta (2001), Statistical Science 16,
    101–133, section 4.1.

    Args:
        count: how many have it.
        of: how many there are.
        level: of confidence.

    Returns:
        Lower and upper bound.
    """
    tail = 0.5 * (1.0 - level)
    low, high = (beta_quantile(q, count + 0.5, of - count + 0.5) for q in (tail, 1.0 - tail))
    return low if count else 0.0, high if count < of else 1.0


def exact_share_interval(count: int, of: int, level: float = LEVEL) -> tuple[float, float]:
    """Clopper and Pearson's (1934) interval of a share, for verdicts: each bound is an exact one-sided binomial test.

    Returns:
        Lower and upper bound.
    """
    tail = 0.5 * (1.0 - level)
    low = beta_quantile(tail, count, of - count + 1) if count else 0.0
    return low, beta_quantile(1.0 - tail, count + 1, of - count) if count < of else 1.0


def spread_interval(values: NDArray[np.float64], level: float = LEVEL) -> tuple[float, float, float]:
    """Standard deviation and its interval from the chi-squared law, if the values are normally distributed.

    Args:
        values: (n,), two or more.
        level: of confidence.

    Returns:
        Standard deviation, lower and upper bound.
    """
    sd = float(values.std(ddof=1))
    return sd, *_scale_bounds(sd, len(values) - 1, level)


def distance_interval(values: NDArray[np.float64], level: float = LEVEL) -> tuple[float, float, float]:
    """Root mean square and its interval from the chi-squared law, if the values are normal around 0.

    Args:
        values: (n,), one or more.
        level: of confidence.

    Returns:
        Root mean square, lower and upper bound.
    """
    distance = math.sqrt(float(np.mean(values**2)))
    return distance, *_scale_bounds(distance, len(values), level)


def _scale_bounds(scale: float, degrees: int, level: float) -> tuple[float, float]:
    tail = 0.5 * (1.0 - level)
    low, high = (scale * math.sqrt(degrees / chi2_quantile(q, degrees)) for q in (1.0 - tail, tail))
    return low, high
