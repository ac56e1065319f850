"""The test in all parts of the study: is the mean over worlds, or over pairs of worlds, 0?"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
from lazy_loader import load
from numpy.typing import NDArray

from hedon.statistic import LEVEL, holm, paired_contrast

stats: Any = load("scipy.stats", suppress_warning=True)


def named_test(name: str, values: NDArray[np.float64]) -> dict[str, Any]:
    """Tests whether the mean of some values is 0.

    Args:
        name: Name of the test in expected.md.
        values: Value of each world or pair of worlds, shape (worlds,).

    Returns:
        "test", "worlds", "effect" (mean), "low" and "high" (95 %, Student's t), "p" (t test) and "p_sign_flip"; NaN
        for what fewer than two values do not give.
    """
    if len(values) < 2:
        effect = float(values[0]) if len(values) else np.nan
        return {"test": name, "worlds": len(values), "effect": effect} | dict.fromkeys(
            ("low", "high", "p", "p_sign_flip"), np.nan
        )
    result = stats.ttest_1samp(values, 0.0)
    bounds = result.confidence_interval(LEVEL)
    return {
        "test": name,
        "worlds": len(values),
        "effect": float(values.mean()),
        "low": float(bounds.low),
        "high": float(bounds.high),
        "p": float(np.asarray(result)[1]),
        "p_sign_flip": paired_contrast(np.zeros_like(values), values).p,
    }


def holm_table(tests: Sequence[dict[str, Any]], p: str = "p_sign_flip") -> pl.DataFrame:
    """The tests of one part of the study, the primary test first.

    Args:
        tests: Rows from `named_test`.
        p: Column with the p value that is corrected.

    Returns:
        One row per test, with "p_holm": Holm's correction over the secondary tests; null for the primary test.
    """
    corrected = [None, *holm([test[p] for test in tests[1:]])]
    return pl.DataFrame(
        [test | {"p_holm": each} for test, each in zip(tests, corrected, strict=True)], infer_schema_length=None
    )
