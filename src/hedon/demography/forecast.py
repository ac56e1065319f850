"""Forecast of a condition before it is run: whether its population can grow, can die out, and what limits it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from hedon.config import Config
from hedon.config.expression import of_mean_founders
from hedon.config.layout import choose_species
from hedon.demography.balance import fed, gains, need, supply
from hedon.demography.equilibrium import Equilibrium, equilibria
from hedon.demography.food_place import missing_at_start
from hedon.demography.intake import KindIntake, first_intake, survey
from hedon.demography.level import EnergyLevel, Room, levels_of
from hedon.demography.motion import fresh_force
from hedon.demography.placement import placement_success
from hedon.demography.schedule import mean_factor
from hedon.demography.warning import warnings

_SEED = 1  # of the scenes in which places are sampled, so that a condition always gets the same forecast
_SIZES = 11  # numbers of agents for which places are sampled
_STARTS = 4  # scenes that test whether a world can be created


@dataclass(frozen=True)
class Forecast:
    """Forecast of a condition.

    Attributes:
        levels: Lives at some energies; if the probability of death follows a schedule, at its mean factor.
        room: Probabilities that a newborn finds a place.
        need: Energy that an agent with a fresh policy is charged [energy/step].
        supply: Energy that grows as food that the species eats [energy/step], at the mean factor of a schedule; poison
            does not count.
        fed: Number of agents that the supply can feed, supply / need; infinite if living costs nothing, NaN for a
            species that eats no food.
        force: Mean norm of the forces of a fresh policy.
        intake: Amount eaten in the first steps, for each kind of food that the species eats; empty if a world has no
            room for its initial agents and foods.
        equilibria: Equilibria of births and deaths, if agents never learn, if they eat everything that grows, and if
            they are always full; empty under the same condition as `intake`.
        warnings: Sentences to read before running.
    """

    levels: tuple[EnergyLevel, ...]
    room: tuple[Room, ...]
    need: float
    supply: float
    fed: float
    force: float
    intake: tuple[KindIntake, ...]
    equilibria: tuple[Equilibrium, ...]
    warnings: tuple[str, ...]


def forecast(config: Config, species: str | None = None) -> Forecast:
    """Computes the forecast of a condition.

    Raises:
        ArgumentError: There is no such species.
    """
    species = choose_species(species, config)
    config = _of_mean_founders(config)
    species_config, rng = config.species[species], np.random.default_rng(_SEED)
    capacity = species_config.population.capacity
    sizes = np.unique(np.linspace(1, max(capacity - 1, 1), _SIZES).astype(int)).tolist()
    successes = placement_success(config, species, sizes, rng)
    room = (*(Room(n, float(success)) for n, success in zip(sizes, successes, strict=True)), Room(capacity, 0.0))
    levels = levels_of(species_config, room[:-1])
    supplied = supply(config, species_config, lambda food: mean_factor(food.schedule, "growth_rate"))
    shortages = [each for each in (missing_at_start(config, rng) for _ in range(_STARTS)) if each]
    intake, settled = (), ()
    if gains(config, species_config) and len(shortages) < _STARTS:
        ground = survey(config, rng)
        success = np.interp(np.arange(capacity + 1), [each.alive for each in room], [each.success for each in room])
        intake = first_intake(config, species, ground, success)
        settled = equilibria(config, species, ground, success)
    return Forecast(
        levels=levels,
        room=room,
        need=need(species_config),
        supply=supplied,
        fed=fed(config, species_config, supplied),
        force=fresh_force(species_config.motor),
        intake=intake,
        equilibria=settled,
        warnings=(*_start_warnings(shortages), *_dense_warnings(intake), *warnings(config, species, levels)),
    )


def setting_warnings(config: Config, species: str | None = None) -> tuple[str, ...]:
    """Warnings to read before running a condition: the part of its forecast's warnings that needs no samples.

    Raises:
        ArgumentError: There is no such species.
    """
    species = choose_species(species, config)
    config = _of_mean_founders(config)
    return warnings(config, species, levels_of(config.species[species], ()))


def _of_mean_founders(config: Config) -> Config:
    """The config with gene-set numbers as in founders with mean genes."""
    return replace(config, species={name: of_mean_founders(species) for name, species in config.species.items()})


def _start_warnings(shortages: list[str]) -> Iterator[str]:
    """Warnings about what does not fit into a new world."""
    remedy = "Lower the initial counts, enlarge the arena, or spread the places of food."
    if len(shortages) == _STARTS:
        yield f"A run cannot start: there is no room for all that a world begins with; {shortages[0]}. {remedy}"
    elif shortages:
        yield (
            f"A run may fail to start: in {len(shortages)} of {_STARTS} sampled scenes there was no room for all that "
            f"a world begins with; {shortages[0]}. {remedy}"
        )


def _dense_warnings(intake: tuple[KindIntake, ...]) -> Iterator[str]:
    """Warnings about foods that are too dense to predict how much of them is eaten."""
    dense = [kind_intake.kind for kind_intake in intake if kind_intake.dense]
    if dense:
        yield (
            f"Pieces of {' and '.join(dense)} lie so close together that bodies get stuck between two of them, out of "
            "reach of their mouths: how much of it is eaten is not forecast."
        )
