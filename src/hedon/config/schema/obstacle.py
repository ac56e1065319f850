"""Obstacles: solid polygons at random places, some of which may be harmful."""

import math
from dataclasses import dataclass
from typing import Literal

from hedon.config.field import OURS, section, setting
from hedon.config.room import MAX_OBSTACLES
from hedon.config.schema.schedule import ScheduleConfig

SEQUEL = OURS + "; the code of the sequel"


@dataclass(frozen=True, slots=True)
class ObstacleConfig:
    """Regular polygons that never move, at places and angles drawn for each world; agents see and feel them.

    `[obstacle.schedule.harmful]` makes the harmful share vary with time.
    """

    count: int = setting(0, "number of obstacles", "", OURS, ge=0, le=MAX_OBSTACLES, shapes=True)
    corners: int = setting(3, "corners of each", "", SEQUEL + " has 3", ge=3, le=8)
    min_side: float = setting(
        40.0, "shortest side; each obstacle draws its own", "u", SEQUEL + " has 20 to 40", gt=0, le=1e4
    )
    max_side: float = setting(40.0, "longest side", "u", SEQUEL + " has 20 to 40", gt=0, le=1e4)
    min_angle: float = setting(
        0.0, "direction of a corner, counter-clockwise of +x; each obstacle draws its own", "rad", OURS, ge=0, le=6.2832
    )
    max_angle: float = setting(math.tau, "the largest such direction", "rad", OURS, ge=0, le=6.2832)
    cell: float = setting(
        0.0,
        "side of the cells of a grid in whose middles they stand, one in a cell, also where they overlap walls; 0: at "
        "any place apart from walls and from one another",
        "u",
        SEQUEL + " has 40",
        ge=0,
        le=1e5,
    )
    sight: Literal["correct", "released"] = setting(
        "correct",
        "whether rays meet obstacles where they are, or read what a wrong transform makes of them",
        "",
        OURS + '; the code of the sequel has "released"',
    )
    friction: float = setting(0.6, "friction coefficient of a contact with one", "", SEQUEL + " has 0.6", ge=0, le=100)
    restitution: float = setting(
        0.6, "share of the approach speed kept in a bounce off one", "", SEQUEL + " has 0.6", ge=0, le=1
    )
    damage: float = setting(
        0.0,
        "energy that an agent loses per step and obstacle that it touches",
        "energy/step",
        SEQUEL + " has 10 and 1",
        ge=0,
        le=1e4,
    )
    schedule: dict[str, ScheduleConfig] = section(names={"harmful": 1.0})
