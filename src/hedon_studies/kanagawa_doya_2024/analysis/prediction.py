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
    is_finite = np.isfinite(x) & np.isfinite(y)
    x, y = x[is_finite], y[is_finite]
    n = len(x)
    same_sign = int(np.count_nonzero(np.sign(x) == np.sign(y)))
    sign_test = {"same_sign": same_sign, "p_sign": float(stats.binomtest(same_sign, n).pvalue) if n else NAN}
    fitted = ("correlation", "rank_correlation", "slope", "low", "high")
    if n < FEWEST or np.ptp(x) == 0 or np.ptp(y) == 0:
        return {"pairs": n} | dict.fromkeys(fitted, NAN) | sign_test
    slope = float(x @ y / (x @ x))
    error = math.sqrt(float(np.sum((y - slope * x) ** 2)) / (n - 1) / float(x @ x))
    half = float(stats.t.ppf(0.5 + LEVEL / 2, n - 1)) * error
    pearson, spearman = (float(np.corrcoef(a, b)[0, 1]) for a, b in ((x, y), (stats.rankdata(x), stats.rankdata(y))))
    return (
        {"pairs": n}
        | dict(zip(fitted, (pearson, spearman, slope, slope - half, slope + half), strict=True))
        | sign_test
    )
