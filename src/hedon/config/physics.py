"""The rigid-body physics: time steps, the solving of contacts, damping."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import EITHER, OURS, Doc, Range


@dataclass(frozen=True, slots=True)
class PhysicsConfig:
    """How bodies move and push one another."""

    dt: Annotated[
        float,
        Doc("length of one substep", "s", EITHER, Range(gt=0, le=1)),
    ] = 0.1
    substeps: Annotated[
        int,
        Doc("substeps in one environment step", "", EITHER, Range(ge=1, le=100)),
    ] = 5
    solver: Annotated[
        Literal["sequential", "jacobi"],
        Doc(
            "how contacts are solved: by sequential impulses (Catto 2005, in the order of Box2D), or by biased Jacobi "
            "passes, with which bodies in a crowd overlap by several units",
            "",
            OURS + '; the code has "jacobi"',
        ),
    ] = "sequential"
    velocity_passes: Annotated[
        int,
        Doc("passes of the velocity solver in a substep", "", EITHER, Range(ge=1, le=100)),
    ] = 6
    position_passes: Annotated[
        int,
        Doc("passes of the position correction in a substep", "", EITHER, Range(ge=0, le=100)),
    ] = 2
    linear_damping: Annotated[
        float,
        Doc("rate at which velocity decays: v ← v·exp(-rate·dt)", "1/s", EITHER, Range(ge=0, le=100)),
    ] = 0.8
    angular_damping: Annotated[
        float,
        Doc("rate at which angular velocity decays", "1/s", EITHER, Range(ge=0, le=100)),
    ] = 0.6
    max_speed: Annotated[
        float,
        Doc("largest velocity along each axis", "u/s", EITHER, Range(gt=0, le=1e4)),
    ] = 10.0
    max_angular_speed: Annotated[
        float,
        Doc("largest angular velocity", "rad/s", EITHER, Range(gt=0, le=1e3)),
    ] = math.pi
    friction: Annotated[
        float,
        Doc("Coulomb friction of every surface; a pair uses the mean", "", EITHER, Range(ge=0, le=10)),
    ] = 0.2
    restitution: Annotated[
        float,
        Doc("share of the approach speed that remains after a bounce", "", EITHER, Range(ge=0, le=1)),
    ] = 0.4
    restitution_threshold: Annotated[
        float,
        Doc("approach speed below which nothing bounces", "u/s", EITHER, Range(ge=0, le=1e4)),
    ] = 1.0
    correction_rate: Annotated[
        float,
        Doc("share of an overlap that one position pass removes", "", EITHER, Range(ge=0, le=1)),
    ] = 0.2
    slop: Annotated[
        float,
        Doc("overlap that is not corrected", "u", EITHER, Range(ge=0, le=10)),
    ] = 0.005
    max_correction: Annotated[
        float,
        Doc("largest shift that one position pass makes", "u", EITHER, Range(gt=0, le=100)),
    ] = 0.2
    neighbor_skin: Annotated[
        float,
        Doc(
            "gap between two surfaces up to which a pair is listed as neighbors",
            "u",
            OURS,
            Range(gt=0, le=1e3),
        ),
    ] = 4.0
