"""How sure is a mean over worlds?"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import stats

LEVEL = 0.95
SHOWN_FROM = 3
"""Worlds from which on an interval is shown to a reader: over two it is so wide that it misleads."""


@dataclass(frozen=True)
class Interval:
    """A mean over worlds with its interval of confidence.

    Attributes:
        mean: None where no world has a value.
        low, high: bounds of the interval; None with fewer than two worlds, which say nothing about their spread.
        worlds: how many have a value.
    """

    mean: float | None
    low: float | None
    high: float | None
    worlds: int


def mean_interval(values: Iterable[float | None], level: float = LEVEL) -> Interval:
    """Mean and Student's t interval over independent worlds.

    Worlds are the unit: agents of one world are relatives, so an interval over agents would be far too narrow.

    Args:
        values: one per world; None and NaN are left out.
        level: probability with which such an interval covers the true mean, if worlds are normally distributed.
    """
    known = np.array([value for value in values if value is not None and math.isfinite(value)], np.float64)
    if known.size == 0:
        return Interval(None, None, None, 0)
    mean = float(known.mean())
    if known.size == 1:
        return Interval(mean, None, None, 1)
    half = float(stats.t.ppf(0.5 + level / 2, known.size - 1) * known.std(ddof=1) / math.sqrt(known.size))
    return Interval(mean, mean - half, mean + half, known.size)
