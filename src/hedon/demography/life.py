"""Life at constant energy, in closed form: probabilities of death and birth, survival, lifetime, children.

The functions take ages in steps and treat time as continuous, whereas the simulation draws once per step with the same
probabilities; the two agree to a relative error of about the probability per step. Source: Kanagawa & Doya (2024); the
hazard's age part is Gompertz's (1825). `hedon.config.schema.life` has the forms of both probabilities.
"""

from typing import TYPE_CHECKING

import numpy as np

from hedon.config.schema.life import BIRTH_FORMS, HAZARD_FORMS, BirthConfig, HazardConfig

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_PANELS = 4
_X, _W = np.polynomial.legendre.leggauss(32)
_NODES, _WEIGHTS = (
    np.add.outer((2 * np.arange(_PANELS) + 1) / _PANELS - 1, _X / _PANELS).ravel(),
    np.tile(_W / _PANELS, _PANELS),
)
"""Gauss-Legendre quadrature on [-1, 1] in panels: as exact as one of 256 nodes, which takes 0.15 s at each start."""
_MAX_CUMULATIVE_HAZARD = 50.0
"""Cumulative hazard that counts as certain death: the surviving share exp(-50) is below the rounding of a sum."""


def hazard(config: HazardConfig, age: "ArrayLike", energy: "ArrayLike") -> "NDArray[np.float64]":
    """Probability of death.

    Args:
        config: Constants of the hazard.
        age: Ages [step], any shape that broadcasts with `energy`.
        energy: Energies [energy], any shape.

    Returns:
        Probabilities by the form of the hazard [1/step], in the broadcast shape.
    """
    age = np.asarray(age, dtype=np.float64)
    return energy_hazard(config, energy) + _alpha_age(config) * np.exp(config.beta_age * age)


def energy_hazard(config: HazardConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """The part of the probability of death that depends on energy [energy], not on age [1/step].

    Args:
        config: Constants of the hazard.
        energy: Energies [energy], any shape.

    Returns:
        Probabilities by the form of the hazard [1/step], in the shape of `energy`.
    """
    return HAZARD_FORMS[config.form][0](config, np.asarray(energy, dtype=np.float64))


def birth_rate(config: BirthConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """Probability of trying to have a child, by the form of births [1/step].

    Args:
        config: Constants of births.
        energy: Energies [energy], any shape.

    Returns:
        Probabilities per step, in the shape of `energy`.
    """
    return BIRTH_FORMS[config.form](config, np.asarray(energy, dtype=np.float64))


def cumulative_hazard(config: HazardConfig, age: "ArrayLike", energy: "ArrayLike") -> "NDArray[np.float64]":
    """The hazard summed from birth to an age [step] at constant energy [energy]; no unit.

    Args:
        config: Constants of the hazard.
        age: Ages [step], any shape that broadcasts with `energy`.
        energy: Energies [energy], any shape.

    Returns:
        Expected number of deaths until then, in the broadcast shape.
    """
    age = np.asarray(age, dtype=np.float64)
    by_age = age if config.beta_age == 0 else np.expm1(config.beta_age * age) / config.beta_age
    return energy_hazard(config, energy) * age + _alpha_age(config) * by_age


def survival(config: HazardConfig, age: "ArrayLike", energy: "ArrayLike") -> "NDArray[np.float64]":
    """Share of newborns that reach an age [step] at constant energy [energy].

    Args:
        config: Constants of the hazard.
        age: Ages [step], any shape that broadcasts with `energy`.
        energy: Energies [energy], any shape.

    Returns:
        exp(−`cumulative_hazard`), in the broadcast shape.
    """
    return np.exp(-cumulative_hazard(config, age, energy))


def expected_lifetime(config: HazardConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """Mean age at death at constant energy.

    Args:
        config: Constants of the hazard.
        energy: Energies [energy], any shape.

    Returns:
        The integral of `survival` over all ages [step], of the shape of `energy`; infinite if nothing kills. In closed
        form for a hazard that does not rise with age; else by Gauss–Legendre quadrature, with a relative error below
        1e-10.
    """
    base_hazard = energy_hazard(config, energy)
    if _alpha_age(config) == 0 or config.beta_age == 0:
        with np.errstate(divide="ignore"):
            return 1.0 / (base_hazard + _alpha_age(config))
    return _integrated_survival(config, energy, _oldest(config, base_hazard))


def generation_time(config: HazardConfig, energy: "ArrayLike") -> "NDArray[np.float64]":
    """Mean age of a parent when a child is born, at constant energy in a population of constant size.

    Births do not depend on age, so it is the mean age of the living agents. Source: Lotka; Charlesworth (1994), section
    1.3.

    Args:
        config: Constants of the hazard.
        energy: Energies [energy], any shape.

    Returns:
        ∫ a·S(a) da / ∫ S(a) da with `survival` S [step], of the shape of `energy`; infinite if nothing kills.
    """
    base_hazard = energy_hazard(config, energy)
    lifetime = expected_lifetime(config, energy)
    if _alpha_age(config) == 0 or config.beta_age == 0:
        return lifetime
    return _integrated_survival(config, energy, _oldest(config, base_hazard), power=1) / lifetime


def reproduction_number(
    hazard: HazardConfig, birth: BirthConfig, energy: "ArrayLike", placed: float = 1.0
) -> "NDArray[np.float64]":
    """R0: mean number of children in a whole life at constant energy; a lineage at this energy grows if > 1.

    Args:
        hazard: Constants of death.
        birth: Constants of birth.
        energy: Energies [energy], any shape.
        placed: Share of the births that find a free place and a free slot; 1 in an empty arena.

    Returns:
        The birth rate times `expected_lifetime` times `placed`, of the shape of `energy`.
    """
    return placed * birth_rate(birth, energy) * expected_lifetime(hazard, energy)


def _alpha_age(config: HazardConfig) -> float:
    """The age part at age 0 [1/step]; 0 for a form without one."""
    return config.alpha_age if HAZARD_FORMS[config.form][1] else 0.0


def _oldest(config: HazardConfig, base_hazard: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """An age [step] by which the cumulative hazard has passed its limit but not twice the limit; infinite if never."""
    with np.errstate(divide="ignore"):
        by_energy = _MAX_CUMULATIVE_HAZARD / base_hazard
        by_age = np.float64(_MAX_CUMULATIVE_HAZARD) / _alpha_age(config)
    if config.beta_age > 0:
        by_age = np.log1p(config.beta_age * by_age) / config.beta_age
    return np.minimum(by_energy, by_age)


def _integrated_survival(
    config: HazardConfig, energy: "ArrayLike", end_age: "NDArray[np.float64]", power: int = 0
) -> "NDArray[np.float64]":
    """Integral of a power of age times `survival`, from 0 to an age [step]."""
    half = 0.5 * end_age[..., None]
    energy = np.asarray(energy, dtype=np.float64)[..., None]
    age = half * (_NODES + 1.0)
    return np.sum(_WEIGHTS * half * age**power * survival(config, age, energy), axis=-1)
