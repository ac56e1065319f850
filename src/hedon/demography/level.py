"""Lives at constant energy, and the room that they leave for newborns."""

import math
from dataclasses import dataclass

import numpy as np

from hedon.config.schema.species import SpeciesConfig
from hedon.demography.life import expected_lifetime, reproduction_number
from hedon.demography.schedule import birth_of, mean_hazard


@dataclass(frozen=True)
class EnergyLevel:
    """A life at constant energy.

    Attributes:
        energy: The constant energy [energy].
        lifetime: Mean age at death [step].
        r0: Attempted births in a whole life; fewer find a place.
        refusal: Share of births that may fail before a lineage shrinks, 1 − 1/r0; 0 if it shrinks in any case.
        population: Number of agents in the arena at which that share of births fails: the number that room allows at
            this energy; the capacity if more would find places, NaN if the lineage shrinks in any case.
    """

    energy: float
    lifetime: float
    r0: float
    refusal: float
    population: float


@dataclass(frozen=True)
class Room:
    """Probability that a birth finds a place (and a slot), by the number of agents in the arena."""

    alive: int
    success: float


def levels_of(species_config: SpeciesConfig, places: tuple[Room, ...]) -> tuple[EnergyLevel, ...]:
    """Lives at some energies up to the capacity."""
    capacity = species_config.energy.capacity
    energies = [*(energy for energy in (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if energy < capacity), capacity]
    return tuple(_level(species_config, energy, places) for energy in energies)


def _level(species: SpeciesConfig, energy: float, places: tuple[Room, ...]) -> EnergyLevel:
    hazard = mean_hazard(species)
    lifetime = float(expected_lifetime(hazard, energy))
    r0 = float(reproduction_number(hazard, birth_of(species), energy)) if species.birth.kappa else 0.0
    refusal = max(1.0 - 1.0 / r0, 0.0) if r0 > 0 else 0.0
    population = _alive_at(1.0 / r0, places) if r0 > 1 and places else math.nan
    return EnergyLevel(energy, lifetime, r0, refusal, population)


def _alive_at(success: float, places: tuple[Room, ...]) -> float:
    """Number of agents at which the probability of a place has fallen to a value; the maximum if it never does."""
    falling = np.minimum.accumulate([room.success for room in places])
    alive = np.array([room.alive for room in places], np.float64)
    if success < falling[-1]:
        return float(alive[-1]) + 1.0
    return float(np.interp(-success, -falling, alive))
