"""Birth and death: their probabilities per step, by age and energy."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.arena import ArenaConfig
from hedon.config.field import CODE, EITHER, OURS, PAPER, section, setting
from hedon.config.room import MAX_FACTOR
from hedon.config.schedule import ScheduleConfig


@dataclass(frozen=True, slots=True)
class HazardConfig:
    """Probability of death: kappa·(1 − 1/(1 + alpha_energy·exp(−beta_energy·e))) + alpha_age·exp(beta_age·age).

    `[hazard.schedule.scale]` makes the whole of it follow time.
    """

    kappa: float = setting(0.01, "scale of the part that depends on energy", "1/step", EITHER, ge=0, le=1)
    alpha_energy: float = setting(0.02, "weight of the exponential of energy", "", EITHER, ge=0, le=1e6)
    beta_energy: float = setting(0.2, "how fast energy lowers the probability", "1/energy", EITHER, ge=0, le=100)
    alpha_age: float = setting(2e-7, "the part that depends on age, at age 0", "1/step", EITHER, ge=0, le=1)
    beta_age: float = setting(4e-6, "how fast age raises the probability", "1/step", EITHER, ge=0, le=1)
    rule: str = setting(
        "",
        "a Python function that gives the probability instead, as FILE.py:NAME; a run adds @ and the digest of the "
        "file. Empty for the formula above (guide/rule.md)",
        "",
        OURS,
    )
    schedule: dict[str, ScheduleConfig] = section(names={"scale": MAX_FACTOR})


@dataclass(frozen=True, slots=True)
class BirthConfig:
    """Probability of a child: kappa/(1 + exp(logit_offset − beta·energy)); it is born at a free place by its parent."""

    kappa: float = setting(4e-4, "probability at high energy", "1/step", EITHER, ge=0, le=1)
    beta: float = setting(
        0.1, "how fast energy raises the probability", "1/energy", PAPER + ", with the sign of the code", ge=0, le=100
    )
    logit_offset: float = setting(
        0.0, "beta times the energy at which the probability is half of kappa", "", OURS, ge=-1e3, le=1e3
    )
    rule: str = setting(
        "",
        "a Python function that gives the probability instead, as FILE.py:NAME; a run adds @ and the digest of the "
        "file. Empty for the formula above (guide/rule.md)",
        "",
        OURS,
    )
    attempts: int = setting(
        10, "random places tried for the child; if none is free, the birth fails", "", EITHER, ge=1, le=1000
    )
    distance_sd: float = setting(
        100.0,
        "standard deviation of the child's distance from the parent along x and along y",
        "distance_unit",
        CODE + "; the paper says about 8 % of the width",
        gt=0,
        le=1e5,
        derived=True,
    )
    distance_unit: Literal["u", "arena_width"] = setting("u", "unit of distance_sd", "", EITHER, derived=True)
    network: Literal["none", "initial", "learned"] = setting(
        "none",
        "what a child gets of its parent's network: nothing, what its parent was born with, or what its parent has "
        "learned",
        "",
        PAPER + "; the others are ours",
    )
    network_noise: float = setting(
        0.01, "standard deviation of what is added to each parameter of an inherited network", "", OURS, ge=0, le=10
    )
    mating: Literal["none", "pairs"] = setting(
        "none",
        "how many parents a child has: one, or two, each of whose genes it has by a draw",
        "",
        PAPER + "; pairs is ours",
    )
    mating_window: int = setting(
        1000, "how long an agent whose draw made it a parent waits for another one", "step", OURS, ge=0, le=1_000_000
    )
    mating_range: float = setting(
        20.0, "how far the surfaces of two parents may be apart; 0: they touch", "u", OURS, ge=0, le=1e4
    )


def distance_sd(arena: ArenaConfig, birth: BirthConfig) -> float:
    """Standard deviation of a child's place around its parent, along x and along y [u].

    Args:
        arena: for its width [u].
        birth: with the distance and its unit.
    """
    return birth.distance_sd * (arena.width if birth.distance_unit == "arena_width" else 1.0)
