"""How well does a prediction agree with observations? Correlations, a slope through the origin, and equal signs."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from lazy_loader import load

from hedon.statistic import LEVEL

stats: Any = load("scipy.stats", suppress_warning=True)

NAN = math.nan
FEWEST = 3
"""Smallest number of pairs for a correlation and a slope."""


def prediction(predicted: Iterable[float], seen: Iterable[float]) -> dict[str, Any]:
    """Compares pairs of values; pairs with a missing value are left out.

    Args:
        predicted: Predicted values.
        seen: Observed values, in the same order.

    Returns:
        pairs, the number with both values; correlation, Pearson's; rank_correlation, Spearman's, which a single large
        table does not dominate; slope of seen = slope · predicted, by least squares through the origin, with low and
        high, the bounds of its 95 % interval (Student's t); same_sign, the number of pairs with equal signs; p_sign,
        the two-sided p value of an exact binomial test that signs agree at random. NaN with fewer than three pairs.
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
