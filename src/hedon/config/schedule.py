"""Schedules: factors that follow time, once or in seasons."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import OURS, Doc, Range


@dataclass(frozen=True, slots=True)
class ScheduleConfig:
    """A factor that follows time, by the name of the setting that it multiplies."""

    points: Annotated[
        tuple[tuple[int, float], ...],
        Doc(
            "steps and the factor from there on, [[step, factor], …], in order",
            "step",
            OURS,
            Range(max_items=16, each=(0, 1e9)),
        ),
    ] = ()
    form: Annotated[
        Literal["steps", "linear"],
        Doc("whether the factor stays until the next point, or goes there in a straight line", "", OURS),
    ] = "steps"
    period: Annotated[
        int,
        Doc("steps after which the points begin again, as seasons do; 0: never", "step", OURS, Range(ge=0, le=10**9)),
    ] = 0
