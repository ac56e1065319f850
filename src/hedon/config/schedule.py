"""Schedules: factors that follow time, once or in seasons."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hedon.config.field import OURS, Doc, Range

MAX_FACTOR = 1000.0
"""Largest factor of a schedule."""
_SAMPLES = 10_000


@dataclass(frozen=True, slots=True)
class ScheduleConfig:
    """A factor that follows time, by the name of the setting that it multiplies."""

    points: Annotated[
        tuple[tuple[int, float], ...],
        Doc("steps and the factor from there on, [[step, factor], …], in order", "step", OURS, Range(max_items=16)),
    ] = ()
    form: Annotated[
        Literal["steps", "linear"],
        Doc("whether the factor stays until the next point, or goes there in a straight line", "", OURS),
    ] = "steps"
    period: Annotated[
        int,
        Doc("steps after which the points begin again, as seasons do; 0: never", "step", OURS, Range(ge=0, le=10**9)),
    ] = 0


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
