"""Energy that grows as food, and energy that agents with a fresh policy are charged."""

import math
from collections.abc import Callable

from hedon.config import Config
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.config.type import diet
from hedon.demography.motion import fresh_force


def need(own: SpeciesConfig) -> float:
    """Energy that an agent with a fresh policy is charged [energy/step]."""
    return own.energy.basic_cost + own.energy.action_cost * fresh_force(own.motor)


def gains(config: Config, own: SpeciesConfig) -> dict[str, float]:
    """Energy that a species gains from a piece of each kind of food that it eats; negative for poison."""
    eaten = diet(config, own)
    return {kind: eaten[kind] * food.gives.get("energy", 0.0) for kind, food in config.food.items() if kind in eaten}


def feeding(config: Config, own: SpeciesConfig) -> dict[str, float]:
    """Energy that a species gains from a piece of each kind of food that feeds it."""
    return {kind: energy for kind, energy in gains(config, own).items() if energy > 0}


def supply(config: Config, own: SpeciesConfig, factor: Callable[[FoodConfig], float]) -> float:
    """Energy that grows as food for a species [energy/step]."""
    return sum(
        config.food[kind].growth_rate * factor(config.food[kind]) * energy
        for kind, energy in feeding(config, own).items()
    )


def fed(config: Config, own: SpeciesConfig, supplied: float) -> float:
    """Number of agents that a supply can feed; infinite if living costs nothing, NaN if the species eats no food.

    Args:
        config: Settings of the world, for its foods.
        own: Settings of the species.
        supplied: Energy that grows as food [energy/step].
    """
    if not gains(config, own):
        return math.nan
    needed = need(own)
    return supplied / needed if needed else math.inf
