"""What can be said of a setting before it is run: can it live, can it die, and what will limit it?"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hedon.config import Config
from hedon.config.layout import diet, inner_states
from hedon.demography.life import energy_hazard, expected_lifetime, reproduction_number
from hedon.demography.placement import placement_success
from hedon.demography.schedule import mean_factor

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
        refusal: share of them that may fail before a lineage shrinks, 1 − 1/r0; 0 where it shrinks anyhow.
        population: agents in the arena at which that share of births fails: the number that room allows at this
            energy; the capacity where more would find places, NaN where the lineage shrinks anyhow.
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
        levels: lives at some energies.
        room: chances of finding a place.
        need: energy that an agent with a fresh policy is charged [energy/step].
        supply: energy that grows as food [energy/step]; poison does not count.
        fed: agents that the supply pays for, supply / need; infinite where living costs nothing.
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


def forecast(config: Config) -> Forecast:
    """Computes the forecast of a setting."""
    capacity = config.population.capacity
    sizes = np.unique(np.linspace(1, max(capacity - 1, 1), _SIZES).astype(int)).tolist()
    found = placement_success(config, sizes, np.random.default_rng(_SEED))
    places = tuple(Room(n, float(success)) for n, success in zip(sizes, found, strict=True))
    levels = tuple(_level(config, energy, places) for energy in _energies(config))
    force, (need, supply, fed) = fresh_force(config), _balance(config)
    return Forecast(levels, (*places, Room(capacity, 0.0)), need, supply, fed, force, setting_warnings(config))


def setting_warnings(config: Config) -> tuple[str, ...]:
    """What to know of a setting before running, in sentences: those of its forecast, without sampling places."""
    levels = tuple(_level(config, energy, ()) for energy in _energies(config))
    return _warnings(config, levels, _balance(config)[2])


def fresh_force(config: Config) -> float:
    """Mean norm of both forces under a fresh policy, whose raw actions are standard normal, by quadrature."""
    low, high = config.motor.min_force, config.motor.max_force
    force = low + (high - low) / (1.0 + np.exp(-_NODES))
    return float(_WEIGHTS @ np.hypot(force[:, None], force[None, :]) @ _WEIGHTS)


def _energies(config: Config) -> list[float]:
    """Energies at which lives are computed, up to the capacity."""
    return [e for e in (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if e < config.energy.capacity] + [config.energy.capacity]


def _balance(config: Config) -> tuple[float, float, float]:
    """Energy that an agent with a fresh policy is charged, energy that grows [energy/step], agents that it pays for."""
    need = config.energy.basic_cost + config.energy.action_cost * fresh_force(config)
    eaten = diet(config, next(iter(config.agents.values())))
    energies = {kind: eaten.get(kind, 0.0) * food.energy for kind, food in config.food.items()}
    supply = sum(
        food.growth_rate * mean_factor(food.schedule, "growth_rate") * energies[kind]
        for kind, food in config.food.items()
        if energies[kind] > 0
    )
    return need, supply, supply / need if need else math.inf


def _level(config: Config, energy: float, places: tuple[Room, ...]) -> EnergyLevel:
    lifetime = float(expected_lifetime(config.hazard, energy))
    r0 = float(reproduction_number(config.hazard, config.birth, energy)) if config.birth.kappa else 0.0
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


def _warnings(config: Config, levels: tuple[EnergyLevel, ...], fed: float) -> tuple[str, ...]:
    starving, best = levels[0], max(levels, key=lambda level: level.r0)
    capacity, founders = config.population.capacity, config.population.initial_count
    floor = config.energy.starvation == "floor"
    found = list(_rule_warnings(config))
    if best.r0 < 1:
        found.append(f"It cannot live: R0 is {best.r0:.2f} at best, so every lineage dies out however well it eats.")
    if floor and starving.r0 >= 1 and math.isfinite(starving.lifetime):
        found.append(
            f"It can live without eating: R0 is {starving.r0:.2f} at energy 0, so an agent that never eats replaces "
            f"itself. It lives {starving.lifetime:,.0f} steps and pays nothing. The world can go on starving, its size "
            "set by room for newborns, and drift is strong."
        )
    if floor and math.isinf(starving.lifetime):
        found.append("It cannot die: at energy 0 the chance of death is 0, and it rises with neither hunger nor age.")
    elif math.isinf(best.lifetime):
        found.append(f"It need not die: at energy {best.energy:g} the chance of death is 0 at any age.")
    if fed < founders:
        rest = "the others starve" if floor else "the others starve to death"
        found.append(f"Food is short from the start: it pays for {fed:,.0f} of {founders} founders; {rest}.")
    if fed > capacity and LONG_LIFE < best.lifetime < math.inf:
        many = "any number of" if math.isinf(fed) else f"{fed:,.0f}"
        found.append(
            f"It can fill up and stand still: food pays for {many} agents, the capacity is {capacity}, and those who "
            f"eat well live {best.lifetime:,.0f} steps. Then hardly anybody is born or dies, and selection fades."
        )
    return (*found, *_beyond(config))


def _beyond(config: Config) -> Iterator[str]:
    """What enters births and deaths, but not this forecast."""
    species = next(iter(config.agents.values()))
    inner = inner_states(config, species)
    if config.obstacle.count and config.obstacle.damage:
        yield (
            f"Obstacles cost {config.obstacle.damage:g} energy per step of touch: how often they are touched depends "
            "on what agents learn, and is not forecast."
        )
    if "nutrient" in inner:
        empty = species.nutrient.hazard_share * float(energy_hazard(config.hazard, 0.0))
        yield f"Without nutrient the chance of death is {empty:.3g} per step higher; lives here are with enough."
    if species.birth.mating == "pairs":
        yield (
            "Children need two parents that wait near one another: R0 counts draws, of which two make one child, and "
            "the chance to meet is not forecast."
        )
    if "toxin" in inner:
        yield "Toxin weakens motors, so agents that eat it move and spend less; this is not forecast."


def _rule_warnings(config: Config) -> Iterator[str]:
    for what, rule in (("death", config.hazard.rule), ("birth", config.birth.rule)):
        if rule:
            yield (
                f"The chance of {what} comes from a rule, {rule}: what it answers is not known before a run. The "
                "numbers here are those of the formula that it replaces."
            )
