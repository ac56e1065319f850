"""Schedules: factors that vary with time, once or seasonally."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import OURS, setting


@dataclass(frozen=True, slots=True)
class ScheduleConfig:
    """A factor that varies with time, by the name of the setting that it multiplies."""

    points: tuple[tuple[int, float], ...] = setting(
        (),
        "steps and the factor from there on, [[step, factor], …], in order",
        "step",
        OURS,
        max_items=16,
        each=(0, 1e9),
    )
    form: Literal["steps", "linear"] = setting(
        "steps", "whether the factor stays until the next point, or goes there in a straight line", "", OURS
    )
    period: int = setting(
        0, "steps after which the points begin again, as seasons do; 0: never", "step", OURS, ge=0, le=10**9
    )
