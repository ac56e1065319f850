"""An agent's body: its shape, motors and senses."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import EITHER, OURS, setting
from hedon.config.room import MAX_RAYS


@dataclass(frozen=True, slots=True)
class BodyConfig:
    """Size and mass of the body."""

    radius: float = setting(10.0, "radius of an agent", "u", EITHER, gt=0, le=1e3)
    density: float = setting(0.1, "mass of an agent per area", "mass/u²", EITHER, gt=0, le=1e3)
    collides: tuple[str, ...] = setting(
        ("*",),
        'species and kinds of food that it collides with and feels; "*" for all. It passes through all others, and '
        "they through it",
        "",
        OURS,
        max_items=12,
    )


@dataclass(frozen=True, slots=True)
class MotorConfig:
    """The two motors at the rear: force = min_force + (max_force − min_force)·sigmoid(action)."""

    min_force: float = setting(
        -20.0,
        "limit of each motor's force for very negative actions",
        "mass·u/s²",
        EITHER,
        ge=-1e4,
        le=1e4,
        derived=True,
    )
    max_force: float = setting(
        80.0, "limit of each motor's force for very positive actions", "mass·u/s²", EITHER, gt=0, le=1e4, derived=True
    )
    force_scale: float = setting(
        1.0, "factor on both limits: for bodies of another size", "", OURS, gt=0, le=1e3, derived=True
    )
    angle: float = setting(
        135.0, "angle between each motor and the heading, one on each side", "degree", EITHER, ge=0, le=180
    )


@dataclass(frozen=True, slots=True)
class SensorConfig:
    """Range rays, touch and the mouth."""

    ray_count: int = setting(24, "number of range rays; the first is the rightmost", "", EITHER, ge=1, le=MAX_RAYS)
    ray_spread: float = setting(
        60.0, "angle between the heading and the outermost ray on each side", "degree", EITHER, ge=0, le=180
    )
    ray_length: float = setting(200.0, "length of a ray, from the surface of the body", "u", EITHER, gt=0, le=1e5)
    sees: tuple[str, ...] = setting(
        ("*",),
        'species and kinds of food that rays meet, beside walls; "*" for all. Rays pass through all others',
        "",
        OURS,
        max_items=12,
    )
    smells: tuple[str, ...] = setting(
        (), 'species and kinds of food that it smells; "*" for all', "", OURS, max_items=12
    )
    smell_decay: float = setting(
        0.1,
        "how fast smell falls with distance: a source at distance d adds exp(-smell_decay·d)",
        "1/u",
        OURS,
        ge=1e-3,
        le=10,
    )
    noses: int = setting(
        1,
        "noses on the rim: one ahead, or two, one to each side of the heading",
        "",
        OURS,
        ge=1,
        le=2,
        shapes=True,
    )
    nose_angle: float = setting(45.0, "angle between the heading and each of two noses", "degree", OURS, ge=0, le=180)
    touch_sectors: int = setting(
        6, "number of equal sectors of the surface that feel touch, counter-clockwise", "", EITHER, ge=1, le=32
    )
    mouth_spread: float = setting(
        60.0, "half-width of the mouth: food touched within it is eaten", "degree", EITHER, gt=0, le=180
    )
    mouth_center: float = setting(
        0.0,
        "angle between the heading and the middle of the mouth, counter-clockwise: a mouth that is lopsided",
        "degree",
        OURS + "; the code of the sequel has 10 for predators",
        ge=-180,
        le=180,
    )
    scaling: Literal["raw", "unit"] = setting(
        "raw",
        "observation as in the released code, or each part scaled to about 1, with the heading as sine and cosine",
        "",
        OURS,
        derived=True,
    )
    velocity_scale: float = setting(
        1.5,
        'what the observed velocity is divided by with scaling = "unit"',
        "u/s",
        OURS + ": little above what full thrust reaches",
        ge=1e-3,
        le=1e6,
        derived=True,
    )
    angular_velocity_scale: float = setting(
        0.2,
        'what the observed angular velocity is divided by with scaling = "unit"',
        "rad/s",
        OURS + ": little above what a full turn reaches",
        ge=1e-3,
        le=1e6,
        derived=True,
    )
    observes: dict[str, float] = setting(
        {},
        "channels that it observes beside all that is said above, each with what it is divided by (guide/reward.md)",
        "",
        OURS,
        each=(1e-6, 1e6),
        derived=True,
    )
    season_period: int = setting(
        0,
        "steps of the year whose time season_sine and season_cosine tell; 0: of the first schedule with a period",
        "step",
        OURS,
        ge=0,
        le=10**9,
        derived=True,
    )
    ray_inside: Literal["hit", "behind"] = setting(
        "hit",
        "what a ray reads that starts inside another body or beyond a wall: that object at distance 0, or what "
        "lies behind it",
        "",
        OURS + '; the code has "behind"',
    )
