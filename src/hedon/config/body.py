"""The body of an agent: its shape, what moves it and what it senses."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import EITHER, OURS, Doc, Range
from hedon.config.room import MAX_RAYS


@dataclass(frozen=True, slots=True)
class BodyConfig:
    """Sizes and mass."""

    radius: Annotated[
        float,
        Doc("radius of an agent", "u", EITHER, Range(gt=0, le=1e3)),
    ] = 10.0
    density: Annotated[
        float,
        Doc("mass of an agent per area", "mass/u²", EITHER, Range(gt=0, le=1e3)),
    ] = 0.1
    collides: Annotated[
        tuple[str, ...],
        Doc(
            'species and kinds of food that it collides with and feels; "*" for all. It passes through all others, and '
            "they through it",
            "",
            OURS,
            Range(max_items=12),
        ),
    ] = ("*",)


@dataclass(frozen=True, slots=True)
class MotorConfig:
    """The two motors at the rear: force = min_force + (max_force − min_force)·sigmoid(action)."""

    min_force: Annotated[
        float,
        Doc(
            "limit of each motor's force for very negative actions",
            "mass·u/s²",
            EITHER,
            Range(ge=-1e4, le=1e4),
            derived=True,
        ),
    ] = -20.0
    max_force: Annotated[
        float,
        Doc(
            "limit of each motor's force for very positive actions",
            "mass·u/s²",
            EITHER,
            Range(gt=0, le=1e4),
            derived=True,
        ),
    ] = 80.0
    force_scale: Annotated[
        float,
        Doc("factor on both limits: for bodies of another size", "", OURS, Range(gt=0, le=1e3), derived=True),
    ] = 1.0
    angle: Annotated[
        float,
        Doc("angle between each motor and the heading, one on each side", "degree", EITHER, Range(ge=0, le=180)),
    ] = 135.0


@dataclass(frozen=True, slots=True)
class SensorConfig:
    """Range rays, touch and the mouth."""

    ray_count: Annotated[
        int,
        Doc("number of range rays; the first is the rightmost", "", EITHER, Range(ge=1, le=MAX_RAYS)),
    ] = 24
    ray_spread: Annotated[
        float,
        Doc(
            "angle between the heading and the outermost ray on each side",
            "degree",
            EITHER,
            Range(ge=0, le=180),
        ),
    ] = 60.0
    ray_length: Annotated[
        float,
        Doc("length of a ray, from the surface of the body", "u", EITHER, Range(gt=0, le=1e5)),
    ] = 200.0
    sees: Annotated[
        tuple[str, ...],
        Doc(
            'species and kinds of food that rays meet, beside walls; "*" for all. Rays pass through all others',
            "",
            OURS,
            Range(max_items=12),
        ),
    ] = ("*",)
    smells: Annotated[
        tuple[str, ...],
        Doc('species and kinds of food that it smells; "*" for all', "", OURS, Range(max_items=12)),
    ] = ()
    smell_decay: Annotated[
        float,
        Doc(
            "how fast smell falls with distance: a source at distance d adds exp(-smell_decay·d)",
            "1/u",
            OURS,
            Range(ge=1e-3, le=10),
        ),
    ] = 0.1
    noses: Annotated[
        int,
        Doc("noses on the rim: one ahead, or two, one to each side of the heading", "", OURS, Range(ge=1, le=2)),
    ] = 1
    nose_angle: Annotated[
        float,
        Doc("angle between the heading and each of two noses", "degree", OURS, Range(ge=0, le=180)),
    ] = 45.0
    touch_sectors: Annotated[
        int,
        Doc(
            "number of equal sectors of the surface that feel touch, counter-clockwise", "", EITHER, Range(ge=1, le=32)
        ),
    ] = 6
    mouth_spread: Annotated[
        float,
        Doc("half-width of the mouth: food touched within it is eaten", "degree", EITHER, Range(gt=0, le=180)),
    ] = 60.0
    scaling: Annotated[
        Literal["raw", "unit"],
        Doc(
            "observation as in the released code, or each part scaled to about 1, with the heading as sine and cosine",
            "",
            OURS,
        ),
    ] = "raw"
    ray_inside: Annotated[
        Literal["hit", "behind"],
        Doc(
            "what a ray reads that starts inside another body or beyond a wall: that object at distance 0, or what "
            "lies behind it",
            "",
            OURS + '; the code has "behind"',
        ),
    ] = "hit"
