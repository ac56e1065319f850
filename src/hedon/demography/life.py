"""Life at constant energy, in closed form: chances of death and birth, survival, length of life, children.

The functions take ages in steps and treat time as continuous, where the simulation draws once per step with
the same chances; the two agree to a relative error of about the chance per step. Source: Kanagawa & Doya
(2024); the hazard's age part is Gompertz's (1825). `hedon.config.schema.life` has the forms of both chances.
"""

from typing import TYPE_CHECKING

import numpy as np
from scipy.special import roots_legendre

from hedon.config.schema.life import BIRTH_FORMS, HAZARD_FORMS, BirthConfig, HazardConfig

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_NODES, _WEIGHTS = roots_legendre(256)  # those of NumPy take 0.15 s at each start
_MAX_CUMULATIVE_HAZARD = 50.0
"""Nobody outlives it: the share exp(-50) is below the rounding of a sum."""


def hazard(config: HazardConfig, age: "ArrayLike", energy: "ArrayLike") -> "NDArray[np.float64]":
    """Chance of death.

    Args:
        config: the hazard's constants.
        age: [step], any shape that broadcasts with `energy`.
        energy: [energy], any shape.

    Returns:
        Chances by the form of the hazard [1/step], in the shape of both together.
    """
    age = np.asarray(age, dtype=np.float64)
    return energy_hazard(config, energy) + _alpha_age(config) * np.exp(config.beta_age * age)


def energy_hazard(config: HazardConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """The part of the chance of death that depends on energy [energy], not on age [1/step].

    Args:
        config: the hazard's constants.
        energy: [energy], any shape.

    Returns:
        Chances by the form of the hazard [1/step], in the shape of `energy`.
    """
    return HAZARD_FORMS[config.form][0](config, np.asarray(energy, dtype=np.float64))


def birth_rate(config: BirthConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """Chance of trying to have a child, by the form of births [1/step].

    Args:
        config: the constants of births.
        energy: [energy], any shape.

    Returns:
        Chances per step, in the shape of `energy`.
    """
    return BIRTH_FORMS[config.form](config, np.asarray(energy, dtype=np.float64))


def cumulative_hazard(config: HazardConfig, age: "ArrayLike", energy: "ArrayLike") -> "NDArray[np.float64]":
    """The hazard summed from birth to an age [step] at constant energy [energy]; no unit.

    Args:
        config: the hazard's constants.
        age: [step], any shape that broadcasts with `energy`.
        energy: [energy], any shape.

    Returns:
        The expected number of deaths until then, in the shape of both together.
    """
    age = np.asarray(age, dtype=np.float64)
    by_age = age if config.beta_age == 0 else np.expm1(config.beta_age * age) / config.beta_age
    return energy_hazard(config, energy) * age + _alpha_age(config) * by_age


def survival(config: HazardConfig, age: "ArrayLike", energy: "ArrayLike") -> "NDArray[np.float64]":
    """Share of the newborn that reach an age [step] at constant energy [energy].

    Args:
        config: the hazard's constants.
        age: [step], any shape that broadcasts with `energy`.
        energy: [energy], any shape.

    Returns:
        exp(−`cumulative_hazard`), in the shape of both together.
    """
    return np.exp(-cumulative_hazard(config, age, energy))


def expected_lifetime(config: HazardConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """Mean age at death at constant energy.

    Args:
        config: The hazard's constants.
        energy: [energy], any shape.

    Returns:
        The integral of `survival` over all ages [step], of the shape of `energy`; infinite where nothing
        kills. Closed for a hazard that does not rise with age; else by Gauss–Legendre quadrature, with a
        relative error below 1e-10.
    """
    flat = energy_hazard(config, energy)
    if _alpha_age(config) == 0 or config.beta_age == 0:
        with np.errstate(divide="ignore"):
            return 1.0 / (flat + _alpha_age(config))
    return _integrated_survival(config, energy, _oldest(config, flat))


def generation_time(config: HazardConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """Mean age of a parent when a child is born, at constant energy in a population of constant size.

    Births do not depend on age, so it is the mean age of the living. Source: Lotka; Charlesworth (1994), section 1.3.

    Args:
        config: The hazard's constants.
        energy: [energy], any shape.

    Returns:
        ∫ a·S(a) da / ∫ S(a) da with `survival` S [step], of the shape of `energy`; infinite if nothing kills.
    """
    flat = energy_hazard(config, energy)
    lifetime = expected_lifetime(config, energy)
    if _alpha_age(config) == 0 or config.beta_age == 0:
        return lifetime
    return _integrated_survival(config, energy, _oldest(config, flat), power=1) / lifetime


def reproduction_number(
    hazard: HazardConfig, birth: BirthConfig, energy: "ArrayLike", placed: float = 1.0
) -> "NDArray[np.float64]":
    """R0: mean number of children in a whole life at constant energy; a lineage at this energy grows if > 1.

    Args:
        hazard: Constants of death.
        birth: Constants of birth.
        energy: [energy], any shape.
        placed: Share of the births that find a free place and a free slot; 1 in an empty arena.

    Returns:
        The birth rate times `expected_lifetime` times `placed`, of the shape of `energy`.
    """
    return placed * birth_rate(birth, energy) * expected_lifetime(hazard, energy)


def _alpha_age(config: HazardConfig) -> float:
    """The part by age at age 0 [1/step]; 0 for a form that has none."""
    return config.alpha_age if HAZARD_FORMS[config.form][1] else 0.0


def _oldest(config: HazardConfig, flat: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """An age [step] by which the cumulative hazard has passed its limit, but not twice; infinite if never."""
    with np.errstate(divide="ignore"):
        by_energy = _MAX_CUMULATIVE_HAZARD / flat
        by_age = np.float64(_MAX_CUMULATIVE_HAZARD) / _alpha_age(config)
    if config.beta_age > 0:
        by_age = np.log1p(config.beta_age * by_age) / config.beta_age
    return np.minimum(by_energy, by_age)


def _integrated_survival(
    config: HazardConfig, energy: "ArrayLike", until: "NDArray[np.float64]", power: int = 0
) -> "NDArray[np.float64]":
    """The integral of age to a power times `survival`, from 0 to an age [step]."""
    half = 0.5 * until[..., None]
    energy = np.asarray(energy, dtype=np.float64)[..., None]
    age = half * (_NODES + 1.0)
    return np.sum(_WEIGHTS * half * age**power * survival(config, age, energy), axis=-1)
