"""Correction of p values for several tests."""

from collections.abc import Sequence

import numpy as np


def holm(p_values: Sequence[float]) -> list[float]:
    """Holm's (1979) step-down correction, which controls the chance of any false positive.

    It is valid for any dependence between the tests.

    Args:
        p_values: p value of each test; NaN for a test that could not be made, which is then not counted.

    Returns:
        Corrected p values in the given order; reject those that are at most the level.
    """
    values = np.asarray(p_values, np.float64)
    order = np.argsort(values, kind="stable")  # sorts NaN last
    order = order[: np.count_nonzero(~np.isnan(values))]
    corrected = np.full(len(values), np.nan)
    steps = values[order] * np.arange(len(order), 0, -1)
    corrected[order] = np.minimum(np.maximum.accumulate(steps), 1.0)
    return corrected.tolist()
