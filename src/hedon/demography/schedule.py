"""Factors that follow time, as the engine computes them in `world/schedule.h`."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hedon.config.schedule import ScheduleConfig

_SAMPLES = 10_000


def factor_at(schedules: Mapping[str, ScheduleConfig], name: str, step: ArrayLike) -> NDArray[np.float64]:
    """The factor of a setting in each step, the same shape as `step`; 1 where it has no schedule."""
    time = np.asarray(step, np.float64)
    schedule = schedules.get(name)
    if schedule is None or not schedule.points:
        return np.ones(time.shape)
    at, factor = np.array(schedule.points, np.float64).T
    period = schedule.period
    if period:
        at, factor, time = np.concatenate([at - period, at, at + period]), np.tile(factor, 3), time % period
    if schedule.form == "linear":
        return np.interp(time, at, factor)
    return factor[np.clip(np.searchsorted(at, time, side="right") - 1, 0, None)]


def mean_factor(schedules: Mapping[str, ScheduleConfig], name: str) -> float:
    """The mean factor of a setting over a period, or over the steps between its points if it has none."""
    schedule = schedules.get(name)
    if schedule is None or not schedule.points:
        return 1.0
    start, end = (0, schedule.period) if schedule.period else (schedule.points[0][0], schedule.points[-1][0])
    return float(factor_at(schedules, name, np.linspace(start, end, _SAMPLES, endpoint=False)).mean())
