"""Factors that vary with time, as the engine computes them in `world/schedule.h`."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hedon.config.schema.life import BirthConfig, HazardConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.config.schema.species import SpeciesConfig


def factor_at(schedules: Mapping[str, ScheduleConfig], name: str, step: ArrayLike) -> NDArray[np.float64]:
    """Factor of a setting in each step, in the shape of `step`; 1 without a schedule.

    Args:
        schedules: Schedules of one section, by the name of the setting.
        name: Name of the setting.
        step: Times [step], any shape.
    """
    time = np.asarray(step, np.float64)
    schedule = schedules.get(name)
    if schedule is None or not schedule.points:
        return np.ones(time.shape)
    times, factor = np.array(schedule.points, np.float64).T
    period = schedule.period
    if period:
        times, factor, time = np.concatenate([times - period, times, times + period]), np.tile(factor, 3), time % period
    if schedule.form == "linear":
        return np.interp(time, times, factor)
    return factor[np.clip(np.searchsorted(times, time, side="right") - 1, 0, None)]


def mean_factor(schedules: Mapping[str, ScheduleConfig], name: str) -> float:
    """Exact mean of a setting's factor over the steps of a period; without a period, the last factor, which stays."""
    schedule = schedules.get(name)
    if schedule is None or not schedule.points:
        return 1.0
    if not schedule.period:
        return schedule.points[-1][1]
    edges = sorted({0, schedule.period, *(step for step, _ in schedule.points)})
    first, last = factor_at(schedules, name, edges[:-1]), factor_at(schedules, name, np.array(edges[1:]) - 1)
    return float(np.diff(edges) @ (first + last) / 2 / schedule.period)  # an arithmetic series between points


def factor_range(schedules: Mapping[str, ScheduleConfig], name: str) -> tuple[float, float]:
    """Smallest and largest factor that a setting ever has."""
    schedule = schedules.get(name)
    factors = [factor for _, factor in schedule.points] if schedule is not None else []
    return min(factors, default=1.0), max(factors, default=1.0)


def hazard_of(species_config: SpeciesConfig) -> HazardConfig:
    """Hazard of a species by energy and age, with its weight of energy."""
    weight = species_config.energy.hazard_weight if species_config.hazard.form == "age_energy" else 1.0
    return replace(species_config.hazard, kappa=weight * species_config.hazard.kappa)


def birth_of(species_config: SpeciesConfig) -> BirthConfig:
    """Probability of a child by energy, for agents with the best levels of all other stores: full or empty."""
    store_weight = sum(max(store.birth_weight, 0.0) * store.capacity for store in species_config.store.values())
    beta, offset = species_config.birth.beta, species_config.birth.logit_offset
    return replace(
        species_config.birth, beta=species_config.energy.birth_weight * beta, logit_offset=offset - beta * store_weight
    )


def mean_hazard(species_config: SpeciesConfig) -> HazardConfig:
    """Hazard of a species at the mean factor of its schedule."""
    return scaled_hazard(hazard_of(species_config), mean_factor(species_config.hazard.schedule, "scale"))


def scaled_hazard(hazard: HazardConfig, factor: float) -> HazardConfig:
    """A hazard with all probabilities multiplied by a factor, and without a schedule."""
    return replace(hazard, kappa=factor * hazard.kappa, alpha_age=factor * hazard.alpha_age, schedule={})
