"""What can be said of a setting before it is run: can it live, can it die, and what will limit it?"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hedon.config import Config
from hedon.config.expression import of_mean_founders
from hedon.config.layout import choose_species
from hedon.config.schema.body import MotorConfig
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.config.type import diet
from hedon.demography.life import energy_hazard, expected_lifetime, reproduction_number
from hedon.demography.placement import placement_success
from hedon.demography.schedule import (
    birth_of,
    factor_at,
    factor_range,
    hazard_of,
    mean_factor,
    mean_hazard,
    scaled_hazard,
)

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(32)
_WEIGHTS = _WEIGHTS / _WEIGHTS.sum()
_SEED = 1  # of the scenes in which places are sampled, so that a setting gets the same answer again
_SIZES = 11  # numbers of agents at which places are sampled
LONG_LIFE = 100_000
"""Mean life [step] beyond which births and deaths are too few for selection to act on."""


@dataclass(frozen=True)
class EnergyLevel:
    """A life at constant energy.

    Attributes:
        energy: [energy].
        lifetime: mean age at death [step].
        r0: children tried in a whole life; those that find a place are fewer.
        refusal: share of them that may fail before a lineage shrinks, 1 − 1/r0; 0 where it shrinks in any case.
        population: agents in the arena at which that share of births fails: the number that room allows at this
            energy; the capacity where more would find places, NaN where the lineage shrinks in any case.
    """

    energy: float
    lifetime: float
    r0: float
    refusal: float
    population: float


@dataclass(frozen=True)
class Room:
    """The chance that a birth finds a place (and a slot), by agents in the arena."""

    alive: int
    success: float


@dataclass(frozen=True)
class Forecast:
    """What a setting promises.

    Attributes:
        levels: lives at some energies; where the chance of death follows a schedule, at its mean factor.
        room: chances of finding a place.
        need: energy that an agent with a fresh policy is charged [energy/step].
        supply: energy that grows as food that the species eats [energy/step], at the mean factor of a schedule; poison
            does not count.
        fed: agents that the supply pays for, supply / need; infinite where living costs nothing, NaN for a species
            that eats no food.
        force: mean norm of the forces of a fresh policy.
        warnings: what to know before running, in sentences.
    """

    levels: tuple[EnergyLevel, ...]
    room: tuple[Room, ...]
    need: float
    supply: float
    fed: float
    force: float
    warnings: tuple[str, ...]


def forecast(config: Config, species: str | None = None) -> Forecast:
    """Computes the forecast of a setting.

    Args:
        config: Of the worlds.
        species: Whose; by default the first.

    Raises:
        ArgumentError: There is no such species.
    """
    species = choose_species(species, config)
    config = _of_mean_founders(config)
    own = config.species[species]
    capacity = own.population.capacity
    sizes = np.unique(np.linspace(1, max(capacity - 1, 1), _SIZES).astype(int)).tolist()
    found = placement_success(config, species, sizes, np.random.default_rng(_SEED))
    places = tuple(Room(n, float(success)) for n, success in zip(sizes, found, strict=True))
    levels = tuple(_level(own, energy, places) for energy in _energies(own))
    force, (need, supply, fed) = fresh_force(own.motor), _balance(config, species)
    warnings = _warnings(config, species, levels, fed)
    return Forecast(levels, (*places, Room(capacity, 0.0)), need, supply, fed, force, warnings)


def setting_warnings(config: Config, species: str | None = None) -> tuple[str, ...]:
    """What to know of a setting before running, in sentences: those of its forecast, without sampling places.

    Args:
        config: Of the worlds.
        species: Whose; by default the first.

    Raises:
        ArgumentError: There is no such species.
    """
    species = choose_species(species, config)
    config = _of_mean_founders(config)
    levels = tuple(_level(config.species[species], energy, ()) for energy in _energies(config.species[species]))
    return _warnings(config, species, levels, _balance(config, species)[2])


def _of_mean_founders(config: Config) -> Config:
    """The config with the numbers that genes set as founders with mean genes have them."""
    return replace(config, species={name: of_mean_founders(own) for name, own in config.species.items()})


def fresh_force(motor: MotorConfig) -> float:
    """Mean norm of both forces under a fresh policy, whose raw actions are standard normal, by quadrature."""
    low, high = (motor.force_scale * force for force in (motor.min_force, motor.max_force))
    force = low + (high - low) / (1.0 + np.exp(-_NODES))
    return float(_WEIGHTS @ np.hypot(force[:, None], force[None, :]) @ _WEIGHTS)


def _energies(own: SpeciesConfig) -> list[float]:
    """Energies at which lives are computed, up to the capacity."""
    most = own.energy.capacity
    return [*(energy for energy in (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if energy < most), most]


def _need(own: SpeciesConfig) -> float:
    """Energy that an agent with a fresh policy is charged [energy/step]."""
    return own.energy.basic_cost + own.energy.action_cost * fresh_force(own.motor)


def _balance(config: Config, species: str) -> tuple[float, float, float]:
    """Energy that an agent with a fresh policy is charged, energy that grows [energy/step], agents that it pays for."""
    supply = _supply(config, species, lambda food: mean_factor(food.schedule, "growth_rate"))
    return _need(config.species[species]), supply, _fed(config, species, supply)


def _supply(config: Config, species: str, factor: Callable[[FoodConfig], float]) -> float:
    """Energy of the food that a species eats that grows [energy/step], for a factor of each kind's growth."""
    feeding = _feeding(config, species).items()
    return sum(config.food[kind].growth_rate * factor(config.food[kind]) * energy for kind, energy in feeding)


def _fed(config: Config, species: str, supply: float) -> float:
    """Agents that a supply pays for; NaN for a species that eats no food."""
    if not _eats_food(config, species):
        return math.nan
    need = _need(config.species[species])
    return supply / need if need else math.inf


def _eats_food(config: Config, species: str) -> bool:
    return any(kind in config.food for kind in diet(config, config.species[species]))


def _feeding(config: Config, species: str) -> dict[str, float]:
    """The energy that a species gains by each kind of food that feeds it."""
    eaten = diet(config, config.species[species])
    energies = {kind: eaten.get(kind, 0.0) * food.gives.get("energy", 0.0) for kind, food in config.food.items()}
    return {kind: energy for kind, energy in energies.items() if energy > 0}


def _level(own: SpeciesConfig, energy: float, places: tuple[Room, ...]) -> EnergyLevel:
    hazard = mean_hazard(own)
    lifetime = float(expected_lifetime(hazard, energy))
    r0 = float(reproduction_number(hazard, birth_of(own), energy)) if own.birth.kappa else 0.0
    refusal = max(1.0 - 1.0 / r0, 0.0) if r0 > 0 else 0.0
    population = _alive_at(1.0 / r0, places) if r0 > 1 and places else math.nan
    return EnergyLevel(energy, lifetime, r0, refusal, population)


def _alive_at(success: float, places: tuple[Room, ...]) -> float:
    """The number of agents at which the chance of a place has fallen to a value; the largest where it has not."""
    falling = np.minimum.accumulate([room.success for room in places])
    alive = np.array([room.alive for room in places], np.float64)
    if success < falling[-1]:
        return float(alive[-1]) + 1.0
    return float(np.interp(-success, -falling, alive))


def _warnings(config: Config, species: str, levels: tuple[EnergyLevel, ...], fed: float) -> tuple[str, ...]:
    own = config.species[species]
    starving, best = levels[0], max(levels, key=lambda level: level.r0)
    capacity, founders = own.population.capacity, own.population.initial_count
    floor = own.energy.at_zero == "floor"
    found = [*_gene_warnings(own), *_rule_warnings(own)]
    if best.r0 < 1:
        found.append(f"It cannot live: R0 is {best.r0:.2f} at best, so every lineage dies out however well it eats.")
    fed_by_others = any(store.birth_weight > 0 for store in own.store.values())  # whom this forecast takes to be full
    if floor and starving.r0 >= 1 and math.isfinite(starving.lifetime) and not fed_by_others:
        found.append(
            f"It can live without eating: R0 is {starving.r0:.2f} at energy 0, so an agent that never eats replaces "
            f"itself. It lives {starving.lifetime:,.0f} steps and pays nothing. The world can go on starving, its size "
            "set by room for newborns, and drift is strong."
        )
    if floor and math.isinf(starving.lifetime):
        found.append("It cannot die: at energy 0 the chance of death is 0, and it rises with neither hunger nor age.")
    elif math.isinf(best.lifetime):
        found.append(f"It need not die: at energy {best.energy:g} the chance of death is 0 at any age.")
    growing = _supply(config, species, lambda food: float(factor_at(food.schedule, "growth_rate", 0)))
    begun = _fed(config, species, growing)
    if begun < founders:
        rest = "the others starve" if floor else "the others starve to death"
        found.append(f"Food is short from the start: it pays for {begun:,.0f} of {founders} founders; {rest}.")
    if fed > capacity and LONG_LIFE < best.lifetime < math.inf:
        many = "any number of" if math.isinf(fed) else f"{fed:,.0f}"
        found.append(
            f"It can fill up and stand still: food pays for {many} agents, the capacity is {capacity}, and those who "
            f"eat well live {best.lifetime:,.0f} steps. Then hardly anybody is born or dies, and selection fades."
        )
    return (*found, *_scheduled(config, species, best.energy), *_others(config, species), *_beyond(config, species))


def _scheduled(config: Config, species: str, energy: float) -> Iterator[str]:
    """What follows time: at which factor the numbers are, and what they are at the others."""
    own = config.species[species]
    low, high = factor_range(own.hazard.schedule, "scale")
    if low < high:
        ends = [scaled_hazard(hazard_of(own), factor) for factor in (low, high)]
        lives = [_steps(float(expected_lifetime(end, energy))) for end in ends]
        r0 = [float(reproduction_number(end, birth_of(own), energy)) if own.birth.kappa else 0.0 for end in ends]
        which = _which(own.hazard.schedule, "scale")
        yield (
            f"The chance of death follows a schedule, from {low:g} to {high:g} times what is set: lives and R0 are "
            f"those at {which}. Held at its lowest, it would give {lives[0]} and R0 {r0[0]:.2f} at energy {energy:g}; "
            f"at its highest {lives[1]} and R0 {r0[1]:.2f}. What a life meets depends on when it begins."
        )
    grown = {kind: config.food[kind] for kind in _feeding(config, species)}
    bounds = {kind: factor_range(food.schedule, "growth_rate") for kind, food in grown.items()}
    if any(low < high for low, high in bounds.values()):
        parts = [
            f"{kind} from {low:g} to {high:g} times what is set (here {_which(grown[kind].schedule, 'growth_rate')})"
            for kind, (low, high) in bounds.items()
            if low < high
        ]
        ends = (_supply(config, species, partial(_extreme, which=which)) for which in (0, 1))
        least, most = (_fed(config, species, supply) for supply in ends)
        yield f"Growth follows a schedule, {', '.join(parts)}: food pays for {least:,.0f} to {most:,.0f} agents."
    for kind, food in grown.items():
        low, high = factor_range(food.schedule, "capacity")
        if low < high:
            yield (
                f"The capacity of {kind} follows a schedule, from {low:g} to {high:g} times what is set: how much "
                "of what grows it cuts off depends on what is eaten, and is not forecast."
            )


def _extreme(food: FoodConfig, which: int) -> float:
    """The smallest (0) or the largest (1) factor of a kind's growth."""
    return factor_range(food.schedule, "growth_rate")[which]


def _which(schedules: Mapping[str, ScheduleConfig], name: str) -> str:
    """Which factor of a schedule the numbers are at."""
    mean = mean_factor(schedules, name)
    return f"the mean over a period, {mean:g}" if schedules[name].period else f"its end, {mean:g}, which stays"


def _steps(lifetime: float) -> str:
    return "an endless life" if math.isinf(lifetime) else f"a mean life of {lifetime:,.0f} steps"


def _others(config: Config, species: str) -> Iterator[str]:
    """What a species has to do with agents that it eats, that eat it, and that eat and live beside it."""
    eaten = diet(config, config.species[species])
    prey = [each for each in config.species if each in eaten]
    if prey:
        only = "" if _eats_food(config, species) else "no food, but "
        what = f"{only}{' and '.join(prey)}"
        yield f"It eats {what}: how many it catches depends on what agents learn, and is not forecast."
    elif not _eats_food(config, species):
        yield "It eats nothing: nobody gains energy."
    eaters = [other for other, each in config.species.items() if species in diet(config, each)]
    if eaters:
        yield f"It is eaten by {' and '.join(eaters)}: lives here are without such deaths."
    beside = [
        other
        for other, each in config.species.items()
        if other != species and set(_feeding(config, species)) & set(diet(config, each))
    ]
    if beside:
        yield f"Its food is also eaten by {' and '.join(beside)}: what it pays for is shared with them."
    if len(config.species) > 1:
        yield "Places that agents of other species take are not counted: there is less room than this."


def _beyond(config: Config, species: str) -> Iterator[str]:
    """What enters births and deaths, but not this forecast."""
    own = config.species[species]
    if config.obstacle.count and config.obstacle.damage:
        yield (
            f"Obstacles cost {config.obstacle.damage:g} energy per step of touch: how often they are touched depends "
            "on what agents learn, and is not forecast."
        )
    for name, store in own.store.items():
        weight = store.hazard_weight if own.hazard.form == "age_energy" else 0.0
        empty = weight * float(energy_hazard(own.hazard, 0.0)) * mean_factor(own.hazard.schedule, "scale")
        if empty:
            yield f"Without {name} the chance of death is {empty:.3g} per step higher; lives here are with enough."
        if store.birth_weight:
            held = f"full of {name}" if store.birth_weight > 0 else f"without {name}"
            yield f"Births follow {name} too: R0 here is that of agents {held}."
        if store.at_zero == "death":
            yield f"Without {name} agents die at once: how often that happens is not forecast."
    gated = [kind for kind in diet(config, own) if kind in config.food and config.food[kind].needs]
    if gated:
        yield f"Only agents that hold enough can eat {' and '.join(gated)}: the numbers here are as if all could."
    if own.birth.mating == "pairs":
        yield (
            "Children need two parents that wait near one another: R0 counts draws, of which two make one child, and "
            "the chance to meet is not forecast."
        )
    for name, store in own.stores.items():
        if store.motor_threshold:
            yield f"{name.capitalize()} weakens motors, so agents that hold it spend less; this is not forecast."


def _gene_warnings(own: SpeciesConfig) -> Iterator[str]:
    if own.genome.set:
        yield (
            f"Genes set {', '.join(own.genome.set)}: the numbers here are those of founders with mean genes; others "
            "differ, and evolution moves them."
        )


def _rule_warnings(own: SpeciesConfig) -> Iterator[str]:
    for what, rule in (("death", own.hazard.rule), ("birth", own.birth.rule)):
        if rule:
            yield (
                f"The chance of {what} comes from a rule, {rule}: what it answers is not known before a run. The "
                "numbers here are those of the formula that it replaces."
            )
