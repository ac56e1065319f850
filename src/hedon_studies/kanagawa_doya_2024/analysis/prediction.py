"""How well does a prediction agree with what was seen? Correlations, a slope through the origin, equal signs."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import stats

from hedon.statistic import LEVEL

NAN = math.nan
FEWEST = 3
"""Pairs that a correlation and a slope need at least."""


@dataclass(frozen=True)
class Prediction:
    """How well one comparison went, over worlds; NaN with fewer than three pairs.

    Attributes:
        pairs: that have both values.
        correlation: Pearson's.
        rank_correlation: Spearman's, which a single large table does not rule.
        slope: of seen = slope · predicted, by least squares through the origin.
        low, high: bounds of its 95 % interval, Student's t.
        same_sign: pairs of equal sign.
        p_sign: two-sided chance of a count this far from half if signs were tosses of a coin, exact binomial.
    """

    pairs: int
    correlation: float
    rank_correlation: float
    slope: float
    low: float
    high: float
    same_sign: int
    p_sign: float


def prediction(predicted: Iterable[float], seen: Iterable[float]) -> Prediction:
    """Compares pairs; those without both values are left out.

    Args:
        predicted: what was expected of each.
        seen: what happened, in the same order.
    """
    x, y = (np.array(list(values), np.float64) for values in (predicted, seen))
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    n = len(x)
    same = int(np.count_nonzero(np.sign(x) == np.sign(y)))
    p_sign = float(stats.binomtest(same, n).pvalue) if n else NAN
    if n < FEWEST or np.ptp(x) == 0 or np.ptp(y) == 0:
        return Prediction(n, NAN, NAN, NAN, NAN, NAN, same, p_sign)
    slope = float(x @ y / (x @ x))
    error = math.sqrt(float(np.sum((y - slope * x) ** 2)) / (n - 1) / float(x @ x))
    half = float(stats.t.ppf(0.5 + LEVEL / 2, n - 1)) * error
    plain, ranked = (float(np.corrcoef(a, b)[0, 1]) for a, b in ((x, y), (stats.rankdata(x), stats.rankdata(y))))
    return Prediction(n, plain, ranked, slope, slope - half, slope + half, same, p_sign)
