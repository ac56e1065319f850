"""How likely an agent is to die or to have a child, and factors that change with time."""

import math
from collections.abc import Mapping
from typing import Any

from reference.setting import Rules, Species
from reference.state import Agent


def factor_at(schedules: Mapping[str, Any], name: str, step: int) -> float:
    """The factor of a schedule in a step, or 1 if there is none."""
    if name not in schedules or not schedules[name].points:
        return 1.0
    schedule = schedules[name]
    points, period = [tuple(point) for point in schedule.points], schedule.period
    if period:
        (first, start), (last, end) = points[0], points[-1]
        step %= period
        points = [(last - period, end), *points, (first + period, start)]
    else:
        points = [(-1, points[0][1]), *points, (math.inf, points[-1][1])]
    at = max(i for i, (time, _) in enumerate(points[:-1]) if time <= step)
    (time, factor), (later, goal) = points[at], points[at + 1]
    if schedule.form == "steps" or later == math.inf or goal == factor:
        return factor
    return factor + (step - time) / (later - time) * (goal - factor)


def by_store(hazard: Any, store: float) -> float:
    return hazard.kappa * (1 - 1 / (1 + hazard.alpha_energy * math.exp(-hazard.beta_energy * store)))


def death_chance(species: Species, agent: Agent, step: int) -> float:
    """The chance of dying at the end of this step; the age includes this step."""
    hazard, age = species.hazard, step + 1 - agent.birth_step
    by_stores = (store.hazard_weight * by_store(hazard, agent.held[name]) for name, store in species.stores.items())
    by_age = hazard.alpha_age * math.exp(hazard.beta_age * age)
    chance = {"age_energy": sum(by_stores) + by_age, "gompertz": by_age, "constant": hazard.kappa}[hazard.form]
    return factor_at(hazard.schedule, "scale", step) * chance


def birth_chance(species: Species, agent: Agent) -> float:
    birth, held = species.birth, sum(store.birth_weight * agent.held[name] for name, store in species.stores.items())
    if birth.form == "threshold":
        return birth.kappa if birth.beta * held >= birth.logit_offset else 0.0
    return birth.kappa / (1 + math.exp(birth.logit_offset - birth.beta * held))


def harmful(rules: Rules, step: int) -> int:
    """The number of obstacles that do harm; they are the first ones."""
    return math.floor(factor_at(rules.obstacle.schedule, "harmful", step) * rules.obstacle.count + 0.5)
