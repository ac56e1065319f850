"""Equilibria of births and deaths, of meals and costs, with the length of a generation."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.species import SpeciesConfig
from hedon.demography.balance import gains, need, supply
from hedon.demography.intake import Ground
from hedon.demography.life import birth_rate, expected_lifetime, generation_time, reproduction_number
from hedon.demography.schedule import birth_of, mean_factor, mean_hazard

_HALVINGS = 60

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Equilibrium:
    """A population of constant size at constant energy.

    Attributes:
        feeding: What agents eat: "unlearned", what agents that have learned nothing encounter; "all", everything that
            grows, in equal shares; "full", as much as they can hold, as some do when others starve.
        alive: Number of agents; 0 if they die out.
        energy: Energy of each agent [energy]; NaN if they die out.
        lifetime: Mean age at death [step]; NaN if they die out.
        generation: Mean age of a parent when a child is born [step]; NaN if they die out.
    """

    feeding: str
    alive: float
    energy: float
    lifetime: float
    generation: float


def equilibria(config: Config, species: str, ground: Ground, success: Floats) -> tuple[Equilibrium, ...]:
    """Equilibria of a species if its agents never learn, if they eat everything that grows, and if they are always
    full.

    In each, all agents have the same energy. In a run some eat far more than others, and have most of the children; the
    last equilibrium, of agents that are always full, therefore bounds the length of a generation.
    """
    species_config = config.species[species]
    if not gains(config, species_config):
        return ()
    total_supply = supply(config, species_config, lambda food: mean_factor(food.schedule, "growth_rate"))
    unlearned_income = _met(config, species, ground)
    return (
        _settle("unlearned", species_config, success, lambda alive, lifetime: unlearned_income(alive, lifetime)),
        _settle("all", species_config, success, lambda alive, _: total_supply),
        _settle("full", species_config, success, lambda alive, _: math.inf),
    )


def _met(config: Config, species: str, ground: Ground) -> Callable[[float, float], float]:
    """Function for the energy per step of a number of agents with a mean age, without learning [energy/step]."""
    species_config = config.species[species]
    value = gains(config, species_config)
    energy = np.array([value.get(kind, 0.0) for kind in config.food])
    growth = np.array([food.growth_rate * mean_factor(food.schedule, "growth_rate") for food in config.food.values()])
    limit = np.array([each.limit for each in ground.places])
    other_visits = sum(
        (
            ground.visits[name].mean(axis=1) * each.population.initial_count
            for name, each in config.species.items()
            if name != species
        ),
        np.zeros(len(limit)),
    )

    def energy_met(alive: float, age: float) -> float:
        own_visits = alive * ground.mean_visits(species, age)
        rate = own_visits + other_visits
        eaten = np.minimum(growth, rate * limit)
        return float(energy @ (eaten * np.divide(own_visits, rate, out=np.zeros(len(rate)), where=rate > 0)))

    return energy_met


def _settle(
    feeding: str, species: SpeciesConfig, success: Floats, income: Callable[[float, float], float]
) -> Equilibrium:
    """Equilibrium, given the energy that a number of agents with a mean lifetime find [energy/step]."""
    hazard, birth = mean_hazard(species), birth_of(species)
    pairs = 0.5 if species.birth.mating == "pairs" else 1.0
    falling = np.minimum.accumulate(success)

    def births(energy: float) -> float:
        return pairs * float(reproduction_number(hazard, birth, energy)) if species.birth.kappa else 0.0

    def room(energy: float) -> float:
        """Number of agents at which births and deaths balance, at an energy; 0 if deaths always prevail."""
        r0 = births(energy)
        return float(np.interp(-1.0 / r0, -falling, np.arange(len(falling)))) if r0 > 1 else 0.0

    def surplus(energy: float) -> float:
        """Energy gained per agent and step when the number of agents is in balance [energy/step]."""
        alive, lifetime = max(room(energy), 1.0), float(expected_lifetime(hazard, energy))
        loss = energy * (species.energy.decay + (1.0 / lifetime if lifetime > 0 else 1.0))
        return income(alive, lifetime) / alive - need(species) - loss

    low, high = 0.0, species.energy.capacity
    if surplus(high) >= 0:
        low = high
    elif surplus(low) < 0:
        high = low
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if surplus(middle) >= 0 else (low, middle)
    alive, energy = room(low), low
    if births(low) <= 1:
        return Equilibrium(feeding, 0.0, math.nan, math.nan, math.nan)
    lifetime, generation = float(expected_lifetime(hazard, energy)), float(generation_time(hazard, energy))
    if species.energy.at_zero == "death" and surplus(low) < 0:
        low_count, high_count = 0.0, alive
        for _ in range(_HALVINGS):
            middle = 0.5 * (low_count + high_count)
            low_count, high_count = (
                (middle, high_count) if income(middle, lifetime) >= need(species) * middle else (low_count, middle)
            )
        alive = low_count
        success_share = float(np.interp(alive, np.arange(len(falling)), falling))
        lifetime = generation = (
            1.0 / (pairs * float(birth_rate(birth, energy)) * success_share) if success_share else math.nan
        )
    if alive < 1:
        return Equilibrium(feeding, 0.0, math.nan, math.nan, math.nan)
    return Equilibrium(feeding, alive, energy, lifetime, generation)
