"""Rigid-body physics: time steps, contact solver, damping."""

import math
from dataclasses import dataclass
from typing import Literal

from hedon.config.field import EITHER, OURS, setting


@dataclass(frozen=True, slots=True)
class PhysicsConfig:
    """How bodies move and push one another."""

    dt: float = setting(0.1, "length of one substep", "s", EITHER, gt=0, le=1)
    substeps: int = setting(5, "substeps in one environment step", "", EITHER, ge=1, le=100)
    solver: Literal["sequential", "jacobi"] = setting(
        "sequential",
        "how contacts are solved: by sequential impulses (Catto 2005, in the order of Box2D), or by biased Jacobi "
        "passes, with which bodies in a crowd overlap by several units",
        "",
        OURS + '; the code has "jacobi"',
    )
    velocity_passes: int = setting(6, "passes of the velocity solver in a substep", "", EITHER, ge=1, le=100)
    position_passes: int = setting(2, "passes of the position correction in a substep", "", EITHER, ge=0, le=100)
    linear_damping: float = setting(
        0.8, "rate at which velocity decays: v ← v·exp(-rate·dt)", "1/s", EITHER, ge=0, le=100
    )
    angular_damping: float = setting(0.6, "rate at which angular velocity decays", "1/s", EITHER, ge=0, le=100)
    max_speed: float = setting(10.0, "largest velocity along each axis", "u/s", EITHER, gt=0, le=1e4)
    max_angular_speed: float = setting(math.pi, "largest angular velocity", "rad/s", EITHER, gt=0, le=1e3)
    friction: float = setting(0.2, "Coulomb friction of every surface; a pair uses the mean", "", EITHER, ge=0, le=10)
    restitution: float = setting(0.4, "share of the approach speed that remains after a bounce", "", EITHER, ge=0, le=1)
    restitution_threshold: float = setting(
        1.0, "approach speed below which nothing bounces", "u/s", EITHER, ge=0, le=1e4
    )
    correction_rate: float = setting(0.2, "share of an overlap that one position pass removes", "", EITHER, ge=0, le=1)
    slop: float = setting(0.005, "overlap that is not corrected", "u", EITHER, ge=0, le=10)
    max_correction: float = setting(0.2, "largest shift that one position pass makes", "u", EITHER, gt=0, le=100)
    neighbor_skin: float = setting(
        4.0, "gap between two surfaces up to which a pair is listed as neighbors", "u", OURS, gt=0, le=1e3
    )
