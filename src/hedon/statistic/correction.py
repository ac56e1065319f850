"""Several tests at once: how sure is each of them then?"""

from collections.abc import Sequence

import numpy as np


def holm(p_values: Sequence[float]) -> list[float]:
    """Holm's (1979) step-down correction: the chance of even one false alarm stays below the level.

    It holds however the tests depend on one another.

    Args:
        p_values: one per test; NaN for a test that could not be made, which then does not count.

    Returns:
        Corrected, in the given order: reject where one is at most the level.
    """
    values = np.asarray(p_values, np.float64)
    order = np.argsort(values, kind="stable")  # NaN last
    order = order[: np.count_nonzero(~np.isnan(values))]
    corrected = np.full(len(values), np.nan)
    steps = values[order] * np.arange(len(order), 0, -1)
    corrected[order] = np.minimum(np.maximum.accumulate(steps), 1.0)
    return corrected.tolist()
