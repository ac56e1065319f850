"""Means, shares and spreads over worlds."""

import numpy as np

from calibrations.calibration import Calibration
from hedon.statistic.interval import mean_interval


def _mean_of_normal_worlds(rng: np.random.Generator) -> bool | None:
    found = mean_interval(rng.normal(3.0, 2.0, rng.integers(3, 21)))
    return None if found.low is None or found.high is None else not found.low <= 3.0 <= found.high


CALIBRATIONS = (
    Calibration(
        "mean over worlds, interval",
        ("topic:lifetime", "topic:food", "topic:energy", "topic:generation"),
        "3 to 20 worlds, normal values",
        "missed",
        0.05,
        _mean_of_normal_worlds,
    ),
)
