"""Obstacles: solid polygons at random places, which may do harm."""

from dataclasses import dataclass, field
from typing import Annotated

from hedon.config.field import OURS, Doc, Range, Table
from hedon.config.room import MAX_OBSTACLES
from hedon.config.schedule import ScheduleConfig

SEQUEL = OURS + "; the code of the sequel"


@dataclass(frozen=True, slots=True)
class ObstacleConfig:
    """Regular polygons that never move, at places and angles drawn for each world; agents see and feel them.

    `[obstacle.schedule.harmful]` makes the share of them that do harm follow time.
    """

    count: Annotated[
        int,
        Doc("number of obstacles", "", OURS, Range(ge=0, le=MAX_OBSTACLES), shapes=True),
    ] = 0
    corners: Annotated[
        int,
        Doc("corners of each", "", SEQUEL + " has 3", Range(ge=3, le=8)),
    ] = 3
    min_side: Annotated[
        float,
        Doc("shortest side; each obstacle draws its own", "u", SEQUEL + " has 20 to 40", Range(gt=0, le=1e4)),
    ] = 40.0
    max_side: Annotated[
        float,
        Doc("longest side", "u", SEQUEL + " has 20 to 40", Range(gt=0, le=1e4)),
    ] = 40.0
    friction: Annotated[
        float,
        Doc("friction coefficient of a contact with one", "", SEQUEL + " has 0.6", Range(ge=0, le=100)),
    ] = 0.6
    restitution: Annotated[
        float,
        Doc("share of the approach speed kept in a bounce off one", "", SEQUEL + " has 0.6", Range(ge=0, le=1)),
    ] = 0.6
    damage: Annotated[
        float,
        Doc(
            "energy that an agent loses per step and obstacle that it touches",
            "energy/step",
            SEQUEL + " has 10 and 1",
            Range(ge=0, le=1e4),
        ),
    ] = 0.0
    schedule: Annotated[dict[str, ScheduleConfig], Table(names={"harmful": 1.0})] = field(default_factory=dict)
