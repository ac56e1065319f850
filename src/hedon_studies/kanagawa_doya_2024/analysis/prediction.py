"""How well does a prediction agree with what was seen? Correlations, a slope through the origin, equal signs."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from lazy_loader import load

from hedon.statistic import LEVEL

stats: Any = load("scipy.stats", suppress_warning=True)

NAN = math.nan
FEWEST = 3
"""Pairs that a correlation and a slope need at least."""


def prediction(predicted: Iterable[float], seen: Iterable[float]) -> dict[str, Any]:
    """Compares pairs; those without both values are left out.

    Returns:
        pairs, that have both values; correlation, Pearson's; rank_correlation, Spearman's, which a single large table
        does not rule; slope of seen = slope · predicted, by least squares through the origin, with low and high, bounds
        of its 95 % interval, Student's t; same_sign, pairs of equal sign; p_sign, the two-sided chance of a count this
        far from half if signs were tosses of a coin, exact binomial. NaN with fewer than three pairs.
    """
    x, y = (np.array(list(values), np.float64) for values in (predicted, seen))
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    n = len(x)
    same = int(np.count_nonzero(np.sign(x) == np.sign(y)))
    ends = {"same_sign": same, "p_sign": float(stats.binomtest(same, n).pvalue) if n else NAN}
    fitted = ("correlation", "rank_correlation", "slope", "low", "high")
    if n < FEWEST or np.ptp(x) == 0 or np.ptp(y) == 0:
        return {"pairs": n} | dict.fromkeys(fitted, NAN) | ends
    slope = float(x @ y / (x @ x))
    error = math.sqrt(float(np.sum((y - slope * x) ** 2)) / (n - 1) / float(x @ x))
    half = float(stats.t.ppf(0.5 + LEVEL / 2, n - 1)) * error
    plain, ranked = (float(np.corrcoef(a, b)[0, 1]) for a, b in ((x, y), (stats.rankdata(x), stats.rankdata(y))))
    return {"pairs": n} | dict(zip(fitted, (plain, ranked, slope, slope - half, slope + half), strict=True)) | ends
