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
    own = config.species[species]
    if not gains(config, own):
        return ()
    whole = supply(config, own, lambda food: mean_factor(food.schedule, "growth_rate"))
    met = _met(config, species, ground)
    return (
        _settle("unlearned", own, success, lambda alive, lifetime: met(alive, lifetime)),
        _settle("all", own, success, lambda alive, _: whole),
        _settle("full", own, success, lambda alive, _: math.inf),
    )


def _met(config: Config, species: str, ground: Ground) -> Callable[[float, float], float]:
    """Function for the energy per step of a number of agents with a mean age, without learning [energy/step]."""
    own = config.species[species]
    value = gains(config, own)
    energy = np.array([value.get(kind, 0.0) for kind in config.food])
    growth = np.array([food.growth_rate * mean_factor(food.schedule, "growth_rate") for food in config.food.values()])
    limit = np.array([each.limit for each in ground.places])
    theirs = sum(
        (
            ground.visits[name].mean(axis=1) * each.population.initial_count
            for name, each in config.species.items()
            if name != species
        ),
        np.zeros(len(limit)),
    )

    def energy_met(alive: float, age: float) -> float:
        mine = alive * ground.mean_visits(species, age)
        rate = mine + theirs
        eaten = np.minimum(growth, rate * limit)
        return float(energy @ (eaten * np.divide(mine, rate, out=np.zeros(len(rate)), where=rate > 0)))

    return energy_met


def _settle(how: str, own: SpeciesConfig, success: Floats, found: Callable[[float, float], float]) -> Equilibrium:
    """Equilibrium, given the energy that a number of agents with a mean lifetime find [energy/step]."""
    hazard, birth = mean_hazard(own), birth_of(own)
    pairs = 0.5 if own.birth.mating == "pairs" else 1.0
    falling = np.minimum.accumulate(success)

    def births(energy: float) -> float:
        return pairs * float(reproduction_number(hazard, birth, energy)) if own.birth.kappa else 0.0

    def room(energy: float) -> float:
        """Number of agents at which births and deaths balance, at an energy; 0 if deaths always prevail."""
        r0 = births(energy)
        return float(np.interp(-1.0 / r0, -falling, np.arange(len(falling)))) if r0 > 1 else 0.0

    def surplus(energy: float) -> float:
        """Energy gained per agent and step when the number of agents is in balance [energy/step]."""
        alive, lifetime = max(room(energy), 1.0), float(expected_lifetime(hazard, energy))
        lost = energy * (own.energy.decay + (1.0 / lifetime if lifetime > 0 else 1.0))
        return found(alive, lifetime) / alive - need(own) - lost

    low, high = 0.0, own.energy.capacity
    if surplus(high) >= 0:
        low = high
    elif surplus(low) < 0:
        high = low
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if surplus(middle) >= 0 else (low, middle)
    alive, energy = room(low), low
    if births(low) <= 1:
        return Equilibrium(how, 0.0, math.nan, math.nan, math.nan)
    lifetime, generation = float(expected_lifetime(hazard, energy)), float(generation_time(hazard, energy))
    if own.energy.at_zero == "death" and surplus(low) < 0:
        few, many = 0.0, alive
        for _ in range(_HALVINGS):
            middle = 0.5 * (few + many)
            few, many = (middle, many) if found(middle, lifetime) >= need(own) * middle else (few, middle)
        alive = few
        placed = float(np.interp(alive, np.arange(len(falling)), falling))
        lifetime = generation = 1.0 / (pairs * float(birth_rate(birth, energy)) * placed) if placed else math.nan
    if alive < 1:
        return Equilibrium(how, 0.0, math.nan, math.nan, math.nan)
    return Equilibrium(how, alive, energy, lifetime, generation)
