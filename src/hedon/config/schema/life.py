"""Birth and death: probabilities per step as functions of age and energy."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, section, setting
from hedon.config.room import MAX_FACTOR
from hedon.config.schema.arena import ArenaConfig
from hedon.config.schema.schedule import ScheduleConfig

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class HazardConfig:
    """Probability of death per step: the sum of a part by energy and a part by age, as `form` defines them.

    `age_energy` is kappa·(1 − 1/(1 + alpha_energy·exp(−beta_energy·e))) + alpha_age·exp(beta_age·age); the weights of
    stores (`hazard_weight`) apply to the first part. `gompertz` is only the part by age, `constant` is kappa for all.
    `[hazard.schedule.scale]` makes the whole hazard vary with time.
    """

    form: Literal["age_energy", "gompertz", "constant"] = setting(
        "age_energy", "what the probability depends on", "", PAPER + "; the others are ours"
    )
    kappa: float = setting(
        0.01,
        "scale of the part that depends on energy; with constant the probability itself",
        "1/step",
        EITHER,
        ge=0,
        le=1,
    )
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
    """Probability of a child, which is born at a free place near its parent.

    `logistic` is kappa/(1 + exp(logit_offset − beta·energy)); `threshold` is kappa if beta·energy reaches logit_offset,
    and 0 below.
    """

    form: Literal["logistic", "threshold"] = setting(
        "logistic", "how the probability follows energy", "", PAPER + "; threshold is ours"
    )
    kappa: float = setting(4e-4, "probability at high energy", "1/step", EITHER, ge=0, le=1)
    beta: float = setting(
        0.1, "how fast energy raises the probability", "1/energy", PAPER + ", with the sign of the code", ge=0, le=100
    )
    logit_offset: float = setting(
        0.0,
        "beta times the energy at which the probability is half of kappa, or steps to it",
        "",
        OURS,
        ge=-1e3,
        le=1e3,
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
        arena: Arena whose width [u] a relative distance refers to.
        birth: Settings of the distance and its unit.
    """
    return birth.distance_sd * (arena.width if birth.distance_unit == "arena_width" else 1.0)


def logistic_hazard(config: HazardConfig, energy: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """The energy-dependent part of the `age_energy` hazard [1/step].

    Args:
        config: Constants of the hazard.
        energy: Energy of the agents [energy], any shape.
    """
    import numpy as np

    odds = config.alpha_energy * np.exp(-config.beta_energy * energy)
    return config.kappa * odds / (1.0 + odds)


HAZARD_FORMS: dict[str, tuple[Callable[[HazardConfig, Any], Any], bool]] = {
    "age_energy": (logistic_hazard, True),
    "gompertz": (lambda config, energy: 0.0 * energy, True),
    "constant": (lambda config, energy: config.kappa + 0.0 * energy, False),
}
"""For each form of the hazard, the part that does not depend on age, and whether the part by age is added."""


def logistic_birth(config: BirthConfig, energy: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """Probability of a child in the form `logistic` [1/step].

    Args:
        config: Constants of the probability.
        energy: Energy of the parents [energy], any shape.
    """
    import numpy as np

    return config.kappa / (1.0 + np.exp(config.logit_offset - config.beta * energy))


BIRTH_FORMS: dict[str, Callable[[BirthConfig, Any], Any]] = {
    "logistic": logistic_birth,
    "threshold": lambda config, energy: config.kappa * (config.beta * energy >= config.logit_offset),
}
"""Probability of a child [1/step] in each form."""
