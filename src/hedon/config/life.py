"""Birth and death: their probabilities per step, by age and energy."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from hedon.config.arena import ArenaConfig
from hedon.config.field import CODE, EITHER, OURS, PAPER, Doc, Range, Table
from hedon.config.room import MAX_FACTOR
from hedon.config.schedule import ScheduleConfig


@dataclass(frozen=True, slots=True)
class HazardConfig:
    """Probability of death: kappa·(1 − 1/(1 + alpha_energy·exp(−beta_energy·e))) + alpha_age·exp(beta_age·age).

    `[hazard.schedule.scale]` makes the whole of it follow time.
    """

    kappa: Annotated[
        float,
        Doc("scale of the part that depends on energy", "1/step", EITHER, Range(ge=0, le=1)),
    ] = 0.01
    alpha_energy: Annotated[
        float,
        Doc("weight of the exponential of energy", "", EITHER, Range(ge=0, le=1e6)),
    ] = 0.02
    beta_energy: Annotated[
        float,
        Doc("how fast energy lowers the probability", "1/energy", EITHER, Range(ge=0, le=100)),
    ] = 0.2
    alpha_age: Annotated[
        float,
        Doc("the part that depends on age, at age 0", "1/step", EITHER, Range(ge=0, le=1)),
    ] = 2e-7
    beta_age: Annotated[
        float,
        Doc("how fast age raises the probability", "1/step", EITHER, Range(ge=0, le=1)),
    ] = 4e-6
    rule: Annotated[
        str,
        Doc(
            "a Python function that gives the probability instead, as FILE.py:NAME; a run adds @ and the digest of the "
            "file. Empty for the formula above (guide/rule.md)",
            "",
            OURS,
        ),
    ] = ""
    schedule: Annotated[dict[str, ScheduleConfig], Table(names={"scale": MAX_FACTOR})] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class BirthConfig:
    """Probability of a child: kappa/(1 + exp(logit_offset − beta·energy)); it is born at a free place by its parent."""

    kappa: Annotated[
        float,
        Doc("probability at high energy", "1/step", EITHER, Range(ge=0, le=1)),
    ] = 4e-4
    beta: Annotated[
        float,
        Doc(
            "how fast energy raises the probability",
            "1/energy",
            PAPER + ", with the sign of the code",
            Range(ge=0, le=100),
        ),
    ] = 0.1
    logit_offset: Annotated[
        float,
        Doc("beta times the energy at which the probability is half of kappa", "", OURS, Range(ge=-1e3, le=1e3)),
    ] = 0.0
    rule: Annotated[
        str,
        Doc(
            "a Python function that gives the probability instead, as FILE.py:NAME; a run adds @ and the digest of the "
            "file. Empty for the formula above (guide/rule.md)",
            "",
            OURS,
        ),
    ] = ""
    attempts: Annotated[
        int,
        Doc("random places tried for the child; if none is free, the birth fails", "", EITHER, Range(ge=1, le=1000)),
    ] = 10
    distance_sd: Annotated[
        float,
        Doc(
            "standard deviation of the child's distance from the parent along x and along y",
            "distance_unit",
            CODE + "; the paper says about 8 % of the width",
            Range(gt=0, le=1e5),
            derived=True,
        ),
    ] = 100.0
    distance_unit: Annotated[
        Literal["u", "arena_width"],
        Doc("unit of distance_sd", "", EITHER, derived=True),
    ] = "u"
    network: Annotated[
        Literal["none", "initial", "learned"],
        Doc(
            "what a child gets of its parent's network: nothing, what its parent was born with, or what its parent has "
            "learned",
            "",
            PAPER + "; the others are ours",
        ),
    ] = "none"
    network_noise: Annotated[
        float,
        Doc(
            "standard deviation of what is added to each parameter of an inherited network",
            "",
            OURS,
            Range(ge=0, le=10),
        ),
    ] = 0.01
    mating: Annotated[
        Literal["none", "pairs"],
        Doc(
            "how many parents a child has: one, or two, each of whose genes it has by a draw",
            "",
            PAPER + "; pairs is ours",
        ),
    ] = "none"
    mating_window: Annotated[
        int,
        Doc(
            "how long an agent whose draw made it a parent waits for another one",
            "step",
            OURS,
            Range(ge=0, le=1_000_000),
        ),
    ] = 1000
    mating_range: Annotated[
        float,
        Doc("how far the surfaces of two parents may be apart; 0: they touch", "u", OURS, Range(ge=0, le=1e4)),
    ] = 20.0


def distance_sd(arena: ArenaConfig, birth: BirthConfig) -> float:
    """Standard deviation of a child's place around its parent, along x and along y [u].

    Args:
        arena: for its width [u].
        birth: with the distance and its unit.
    """
    return birth.distance_sd * (arena.width if birth.distance_unit == "arena_width" else 1.0)
