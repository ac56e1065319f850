"""The body of an agent: its shape, what moves it and what it senses."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import EITHER, OURS, Doc, Range


@dataclass(frozen=True, slots=True)
class BodyConfig:
    """Sizes and mass."""

    radius: Annotated[
        float,
        Doc("of an agent", "u", EITHER, Range(gt=0, le=1e3)),
    ] = 10.0
    density: Annotated[
        float,
        Doc("mass of an agent per area", "mass/u²", EITHER, Range(gt=0, le=1e3)),
    ] = 0.1
    food_radius: Annotated[
        float,
        Doc("of a piece of food", "u", EITHER, Range(gt=0, le=1e3)),
    ] = 4.0


@dataclass(frozen=True, slots=True)
class MotorConfig:
    """The two motors at the rear: force = min_force + (max_force − min_force)·sigmoid(action)."""

    min_force: Annotated[
        float,
        Doc("force of each motor as the action falls", "mass·u/s²", EITHER, Range(ge=-1e4, le=1e4)),
    ] = -20.0
    max_force: Annotated[
        float,
        Doc("force of each motor as the action rises", "mass·u/s²", EITHER, Range(gt=0, le=1e4)),
    ] = 80.0
    angle: Annotated[
        float,
        Doc("where the motors sit, to either side of the heading", "degree", EITHER, Range(ge=0, le=180)),
    ] = 135.0


@dataclass(frozen=True, slots=True)
class SensorConfig:
    """Range rays, touch and the mouth."""

    ray_count: Annotated[
        int,
        Doc("range rays; the first is the right-most", "", EITHER, Range(ge=1, le=32)),
    ] = 24
    ray_spread: Annotated[
        float,
        Doc(
            "angle of the outermost rays, to either side of the heading",
            "degree",
            EITHER,
            Range(ge=0, le=180),
        ),
    ] = 60.0
    ray_length: Annotated[
        float,
        Doc("reach of a ray from the surface", "u", EITHER, Range(gt=0, le=1e5)),
    ] = 200.0
    touch_sectors: Annotated[
        int,
        Doc("equal sectors of the surface that feel touch, counter-clockwise", "", EITHER, Range(ge=1, le=16)),
    ] = 6
    mouth_spread: Annotated[
        float,
        Doc("half-width of the mouth: food touched within it is eaten", "degree", EITHER, Range(gt=0, le=180)),
    ] = 60.0
    scaling: Annotated[
        Literal["raw", "unit"],
        Doc(
            "observation as released, or with each part scaled to about 1 and the heading as sine and cosine",
            "",
            OURS,
        ),
    ] = "raw"
