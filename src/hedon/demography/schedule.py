"""Factors that follow time, as the engine computes them in `world/schedule.h`."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hedon.config.schema.life import BirthConfig, HazardConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.config.schema.species import SpeciesConfig


def factor_at(schedules: Mapping[str, ScheduleConfig], name: str, step: ArrayLike) -> NDArray[np.float64]:
    """The factor of a setting in each step, the same shape as `step`; 1 where it has no schedule.

    Args:
        schedules: of one section, by the name of the setting.
        name: of the setting.
        step: times [step], any shape.
    """
    time = np.asarray(step, np.float64)
    schedule = schedules.get(name)
    if schedule is None or not schedule.points:
        return np.ones(time.shape)
    at, factor = np.array(schedule.points, np.float64).T
    period = schedule.period
    if period:
        at, factor, time = np.concatenate([at - period, at, at + period]), np.tile(factor, 3), time % period
    if schedule.form == "linear":
        return np.interp(time, at, factor)
    return factor[np.clip(np.searchsorted(at, time, side="right") - 1, 0, None)]


def mean_factor(schedules: Mapping[str, ScheduleConfig], name: str) -> float:
    """The mean factor of a setting over the steps of a period, exactly; without a period the last one, which stays."""
    schedule = schedules.get(name)
    if schedule is None or not schedule.points:
        return 1.0
    if not schedule.period:
        return schedule.points[-1][1]
    edges = sorted({0, schedule.period, *(step for step, _ in schedule.points)})
    first, last = factor_at(schedules, name, edges[:-1]), factor_at(schedules, name, np.array(edges[1:]) - 1)
    return float(np.diff(edges) @ (first + last) / 2 / schedule.period)  # in a piece factors are an arithmetic series


def factor_range(schedules: Mapping[str, ScheduleConfig], name: str) -> tuple[float, float]:
    """The smallest and the largest factor that a setting ever has."""
    schedule = schedules.get(name)
    factors = [factor for _, factor in schedule.points] if schedule is not None else []
    return min(factors, default=1.0), max(factors, default=1.0)


def hazard_of(own: SpeciesConfig) -> HazardConfig:
    """The hazard of a species by energy and age, with its weight of energy."""
    weight = own.energy.hazard_weight if own.hazard.form == "age_energy" else 1.0
    return replace(own.hazard, kappa=weight * own.hazard.kappa)


def birth_of(own: SpeciesConfig) -> BirthConfig:
    """The chance of a child of a species by energy, for who holds the best of its other stores: all it can, or none."""
    others = sum(max(store.birth_weight, 0.0) * store.capacity for store in own.store.values())
    beta, offset = own.birth.beta, own.birth.logit_offset
    return replace(own.birth, beta=own.energy.birth_weight * beta, logit_offset=offset - beta * others)


def mean_hazard(own: SpeciesConfig) -> HazardConfig:
    """The hazard of a species at the mean factor of its schedule."""
    return scaled_hazard(hazard_of(own), mean_factor(own.hazard.schedule, "scale"))


def scaled_hazard(hazard: HazardConfig, factor: float) -> HazardConfig:
    """A hazard with all chances times a factor, and without a schedule."""
    return replace(hazard, kappa=factor * hazard.kappa, alpha_age=factor * hazard.alpha_age, schedule={})
