"""Energy that grows as food, and energy that agents with a fresh policy are charged."""

import math
from collections.abc import Callable

from hedon.config import Config
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.config.type import diet
from hedon.demography.motion import fresh_force


def need(species_config: SpeciesConfig) -> float:
    """Energy that an agent with a fresh policy is charged [energy/step]."""
    return species_config.energy.basic_cost + species_config.energy.action_cost * fresh_force(species_config.motor)


def gains(config: Config, species_config: SpeciesConfig) -> dict[str, float]:
    """Energy that a species gains from a piece of each kind of food that it eats; negative for poison."""
    eaten = diet(config, species_config)
    return {kind: eaten[kind] * food.gives.get("energy", 0.0) for kind, food in config.food.items() if kind in eaten}


def feeding(config: Config, species_config: SpeciesConfig) -> dict[str, float]:
    """Energy that a species gains from a piece of each kind of food that feeds it."""
    return {kind: energy for kind, energy in gains(config, species_config).items() if energy > 0}


def supply(config: Config, species_config: SpeciesConfig, factor: Callable[[FoodConfig], float]) -> float:
    """Energy that grows as food for a species [energy/step]."""
    return sum(
        config.food[kind].growth_rate * factor(config.food[kind]) * energy
        for kind, energy in feeding(config, species_config).items()
    )


def fed(config: Config, species_config: SpeciesConfig, supplied: float) -> float:
    """Number of agents that a supply can feed; infinite if living costs nothing, NaN if the species eats no food.

    Args:
        config: Settings of the world, for its foods.
        species_config: Settings of the species.
        supplied: Energy that grows as food [energy/step].
    """
    if not gains(config, species_config):
        return math.nan
    needed = need(species_config)
    return supplied / needed if needed else math.inf
