"""Mean numbers of what a population eats in the first steps of a world, while its agents have learned little."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.demography.balance import gains, need
from hedon.demography.encounter import BINS, encounter_rates, gaps
from hedon.demography.food_place import FoodPlaces, food_places
from hedon.demography.life import birth_rate, hazard
from hedon.demography.schedule import birth_of, factor_at, hazard_of, scaled_hazard

FORECAST_STEPS = 2048
"""Steps of a new world covered by the forecast of intake: two windows of the presets."""
FACTOR = 3.0
"""Factor within which the mean intake of worlds agrees with its forecast, in 19 of 20 settings."""
_STRIDE = 8  # steps computed at once
_STUCK = 1.0  # gaps per food above which too many bodies get stuck for a forecast

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class KindIntake:
    """What a species eats of a kind of food in the first `FORECAST_STEPS` of a world, as means over these steps.

    Attributes:
        kind: Name of the kind.
        places: Number of foods that can be present at once where the kind grows; around one center, if centers take
            turns.
        growth: Foods that grow [food/step].
        low: Lower bound of foods eaten, 1/`FACTOR` of the forecast, or 0 if foods are `dense` [food/step].
        eaten: Foods eaten [food/step].
        high: Upper bound of foods eaten, `FACTOR` times the forecast, or all there are [food/step].
        present: Number of foods present.
        dense: Whether bodies get stuck between foods out of their mouths' reach, so that intake cannot be predicted.
    """

    kind: str
    places: float
    growth: float
    low: float
    eaten: float
    high: float
    present: float
    dense: bool


@dataclass(frozen=True)
class Ground:
    """Places of food, and how often an agent that has learned nothing visits them.

    Attributes:
        places: Places of each kind of food.
        visits: By species, the visits per agent, place and step, (kinds, BINS) over equal parts of the time since
            birth; 0 for a kind that it does not eat.
        gaps: By species, the gaps between foods in which it gets stuck, per food if all places are taken, (kinds,).
    """

    places: tuple[FoodPlaces, ...]
    visits: dict[str, Floats]
    gaps: dict[str, Floats]

    def mean_visits(self, species: str, age: float) -> Floats:
        """Visits per agent, place and step of a population whose mean age is `age` [step], (kinds,).

        Ages are assumed to be exponentially distributed; agents beyond the last part of the time count as in it.

        Args:
            species: Name of the species.
            age: Mean age [step].
        """
        ends = np.append(np.arange(BINS) * (FORECAST_STEPS / BINS), np.inf)
        return self.visits[species] @ -np.diff(np.exp(-ends / max(age, 1.0)))


class _Foods(NamedTuple):
    """Numbers of foods of each kind, (kinds,) each."""

    stock: Floats
    present: Floats
    eaten: Floats


def survey(config: Config, rng: np.random.Generator) -> Ground:
    """Samples the possible places of each kind of food, and how often agents of each species visit them."""
    places = tuple(food_places(config, food, FORECAST_STEPS, rng) for food in config.food.values())
    visits = {}
    for name, species in config.species.items():
        eaten = gains(config, species)
        sites = [
            kind_places.sample if kind in eaten else kind_places.sample[:0]
            for kind, kind_places in zip(config.food, places, strict=True)
        ]
        visits[name] = encounter_rates(config, species, sites, FORECAST_STEPS, rng)
    gaps_by_species = {
        name: np.array([gaps(config, species, kind_places.scene) for kind_places in places])
        for name, species in config.species.items()
    }
    return Ground(places, visits, gaps_by_species)


def first_intake(config: Config, species: str, ground: Ground, success: Floats) -> tuple[KindIntake, ...]:
    """Follows mean numbers of agents, of their energy and of foods through the first steps of a world.

    Foods grow where there is room, and agents eat those that they encounter. A newborn starts a new walk, and a birth
    fails as often as it finds no place. Other species keep their founders.

    Returns:
        One result for each kind of food that the species eats.
    """
    species_config, kinds, value = (
        config.species[species],
        list(config.food.values()),
        gains(config, config.species[species]),
    )
    energy_of = np.array([value.get(kind, 0.0) for kind in config.food])
    repeats = FORECAST_STEPS // _STRIDE // BINS
    rates = np.repeat(ground.visits[species], repeats, axis=1)
    other_rates = np.zeros_like(rates)
    for name, other in config.species.items():
        if name != species:
            other_rates += np.repeat(ground.visits[name], repeats, axis=1) * other.population.initial_count
    cohorts = np.zeros(FORECAST_STEPS // _STRIDE + 1)  # living agents by time of birth
    cohorts[0] = species_config.population.initial_count
    total_energy = species_config.energy.initial * cohorts[0]
    foods = _Foods(np.array([float(food.initial_count) for food in kinds]), *np.zeros((2, len(kinds))))
    foods = foods._replace(present=np.minimum(foods.stock, _limits(kinds, ground, foods.eaten)))
    total, present_sum = np.zeros(len(kinds)), np.zeros(len(kinds))
    for i in range(len(cohorts) - 1):
        own_rate, alive = rates[:, : i + 1] @ cohorts[i::-1], cohorts.sum()
        rate = own_rate + other_rates[:, i]
        eaten_before = foods.eaten
        foods = _feed(config, ground, foods, rate, _covered(config, species_config, alive), i * _STRIDE)
        meals = (foods.eaten - eaten_before) * np.divide(own_rate, rate, out=np.zeros(len(kinds)), where=rate > 0)
        total += meals
        present_sum += foods.present
        total_energy = _live(species_config, cohorts, i, total_energy, float(energy_of @ meals), success)
    return tuple(
        _mean_intake(kind, food, ground.places[k].limit, total[k], present_sum[k] * _STRIDE, ground.gaps[species][k])
        for k, (kind, food) in enumerate(config.food.items())
        if kind in value
    )


def _mean_intake(
    kind: str, food: FoodConfig, limit: float, total: float, present_sum: float, gaps: float
) -> KindIntake:
    """Intake of a kind, from sums over the time of a forecast."""
    factor = factor_at(food.schedule, "growth_rate", np.arange(FORECAST_STEPS))
    growth, eaten, present = (
        food.growth_rate * float(factor.mean()),
        total / FORECAST_STEPS,
        present_sum / FORECAST_STEPS,
    )
    upper_bound = food.initial_count / FORECAST_STEPS + growth
    dense = gaps * present > _STUCK * limit
    return KindIntake(
        kind=kind,
        places=limit,
        growth=growth,
        low=0.0 if dense else float(eaten) / FACTOR,
        eaten=float(eaten),
        high=upper_bound if dense else min(float(eaten) * FACTOR, upper_bound),
        present=float(present),
        dense=bool(dense),
    )


def _limits(kinds: list[FoodConfig], ground: Ground, eaten: Floats) -> Floats:
    """Number of foods of each kind that fit after some were eaten, since centers take turns."""
    limit = np.array([places.limit for places in ground.places])
    for k, food in enumerate(kinds):
        if food.placement.form == "switching":
            turns = min(1 + int(eaten[k] / food.placement.switch_after), len(food.placement.centers))
            limit[k] = min(turns * limit[k], food.capacity)
    return limit


def _covered(config: Config, species: SpeciesConfig, alive: float) -> float:
    """Share of the arena in which agents leave no room for food."""
    reach = species.body.radius + config.world.food_radius
    return -math.expm1(-alive * math.pi * reach**2 / (config.arena.width * config.arena.height))


def _feed(config: Config, ground: Ground, foods: _Foods, rate: Floats, covered: float, step: int) -> _Foods:
    """Lets foods grow and be eaten for `_STRIDE` steps, each kind at its rate [1/step]."""
    kinds = list(config.food.values())
    growth = np.array([food.growth_rate * float(factor_at(food.schedule, "growth_rate", step)) for food in kinds])
    capacity = np.array([food.capacity * float(factor_at(food.schedule, "capacity", step)) for food in kinds])
    stock = np.maximum(np.minimum(foods.stock + _STRIDE * growth, capacity), np.minimum(foods.stock, foods.present))
    limit = _limits(kinds, ground, foods.eaten)
    fullness = np.divide(foods.present, limit, out=np.ones(len(limit)), where=limit > 0)
    roomy = limit >= [food.capacity for food in kinds]
    free = (1.0 - covered) * np.where(roomy, 1.0, np.clip(1.0 - fullness, 0.0, 1.0) ** 2)
    tries = _STRIDE * np.array([food.candidates for food in kinds]) * [places.share for places in ground.places]
    added = np.minimum(np.maximum(np.minimum(np.floor(stock + 1e-9), limit) - foods.present, 0.0), tries * free)
    eaten = (foods.present + 0.5 * added) * -np.expm1(-_STRIDE * rate)
    return _Foods(stock - eaten, foods.present + added - eaten, foods.eaten + eaten)


def _live(
    species: SpeciesConfig, cohorts: Floats, i: int, total_energy: float, energy_gained: float, success: Floats
) -> float:
    """Lets agents pay, die and breed for `_STRIDE` steps; changes the cohorts and returns the total energy held."""
    alive = float(cohorts.sum())
    if alive < 1e-6:
        return 0.0
    energy = total_energy / alive
    total_energy = max(
        total_energy + energy_gained - _STRIDE * alive * (need(species) + species.energy.decay * energy), 0.0
    )
    if species.energy.at_zero == "death" and total_energy == 0.0:
        cohorts *= min(energy_gained / (_STRIDE * alive * need(species)), 1.0) if need(species) > 0 else 1.0
    death = scaled_hazard(hazard_of(species), float(factor_at(species.hazard.schedule, "scale", i * _STRIDE)))
    survivors = math.exp(-_STRIDE * min(max(float(hazard(death, 0.0, energy)), 0.0), 1.0))
    pairs = 0.5 if species.birth.mating == "pairs" else 1.0
    success_share = float(np.interp(alive, np.arange(len(success)), success))
    children = pairs * _STRIDE * alive * float(birth_rate(birth_of(species), energy)) * success_share
    cohorts *= survivors
    cohorts[i + 1] = min(children, max(species.population.capacity - float(cohorts.sum()), 0.0))
    return min(total_energy * survivors, float(cohorts.sum()) * species.energy.capacity)
