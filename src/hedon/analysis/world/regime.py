"""The regime of a world: selection has a different meaning in each.

Five rates from the table `population`, over intervals long enough for some hundred births, show what stops a
population from growing:

- *hunger*: share of the energy charged that could not be paid, since energy cannot fall below 0.
- *refusal*: share of attempted births that found no place or no slot.
- *uptake*: energy eaten over energy that grew, of the foods that the species eats, by all species that eat them. A
  species that eats no food has none.
- *turnover*: deaths and births per agent and step, over the probability of death of a starving newborn.
- *crowding*: agents alive over the capacity.

If there are several species, each has its own regime.

The rules are tried in this order:

1. `extinct`: no agent is alive at the end of the interval.
2. `full and idle`: turnover below 0.1, crowding or refusal of at least 0.9. Living agents hold nearly all places, and
   births and deaths are ten times rarer than among the starving. Selection has next to nothing to act on.
3. `starving, limited by room`: hunger of at least 0.25 and refusal of at least 0.1. A starving agent of the paper's
   setting replaces itself (R0 = 1.02 at energy 0), so hunger does not stop growth; lack of places does. Eating pays
   only by way of energies near 0, and who breeds is largely luck: drift is strong.
4. `limited by food`: uptake of at least 0.8 and refusal below 0.1. What grows is eaten and children find places, so
   only hunger limits numbers. Agents compete for food: selection on eating is strongest.
5. `between`: none of these; includes growing worlds.

The thresholds are conventions, between clear cases. In steady numbers, the births attempted are deaths / (1 − refusal):
without a refusal of 0.1 a generation would grow by a ninth, without the baseline's third by half. A hunger of 0.25 is
half of the baseline's. A tenth of the turnover of the starving is a mean life of some 50,000 steps.
"""

from itertools import pairwise
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.world.population import whole_window
from hedon.analysis.world.record import all_eaten
from hedon.analysis.world.species import require_one_species
from hedon.config import Config
from hedon.config.layout import choose_species
from hedon.config.type import diet
from hedon.demography.life import hazard
from hedon.demography.schedule import factor_at

EXTINCT, IDLE, ROOM, FOOD, BETWEEN = (
    "extinct",
    "full and idle",
    "starving, limited by room",
    "limited by food",
    "between",
)
REGIMES = (ROOM, FOOD, IDLE, BETWEEN, EXTINCT)
IDLE_TURNOVER = 0.1
IDLE_CROWDING = 0.9
ROOM_HUNGER = 0.25
ROOM_REFUSAL = 0.1
FOOD_UPTAKE = 0.8
INTERVALS = 40
"""Number of intervals that a run is divided into; each has its own regime."""


def regimes(
    population: pl.DataFrame, config: Config, intervals: int = INTERVALS, species: str | None = None
) -> list[dict[str, Any]]:
    """Regimes of a world over time.

    Returns:
        The result of `interval_regime` for each interval.
    """
    require_one_species(population)
    if population.is_empty():
        return []
    edges = np.linspace(0, population.height, min(intervals, population.height) + 1).astype(int).tolist()
    last_rows = population[edges[-2] :]
    if len(edges) > 2 and last_rows["steps"].sum() < whole_window(population) and last_rows["alive"][-1]:
        del edges[-2]
    species_name = choose_species(species, config)
    return [interval_regime(population[a:b], config, species_name) for a, b in pairwise(edges)]


def interval_regime(rows: pl.DataFrame, config: Config, species: str) -> dict[str, Any]:
    """Regime over consecutive rows of the table `population` of one species of a world.

    Returns:
        step, the end of the interval, and steps, its length [step]; regime, one of `REGIMES`; and the rates hunger,
        refusal, uptake, turnover and crowding, NaN if they are undefined.

    Raises:
        ArgumentError: The rows are of several species.
    """
    require_one_species(rows)
    sums = {name: float(rows[name].sum()) for name in _SUMMED}
    steps, agent_steps = int(rows["steps"].sum()), sums["agent_steps"]
    refusals = sums["births_failed_full"] + sums["births_failed_space"]
    ends, lengths = rows["step"].to_numpy(), rows["steps"].to_numpy()
    species_config = config.species[species]
    factors = diet(config, species_config)
    energies = {kind: factors.get(kind, 0.0) * food.gives.get("energy", 0.0) for kind, food in config.food.items()}
    feeding = {kind: config.food[kind] for kind, energy in energies.items() if energy > 0}
    growth = sum(
        energies[kind] * food.growth_rate * float(factor_at(food.schedule, "growth_rate", ends) @ lengths)
        for kind, food in feeding.items()
    )
    eaten = sum(energies[kind] * _eaten(rows, kind) for kind in feeding)
    scale = float(factor_at(species_config.hazard.schedule, "scale", ends) @ lengths) / steps
    starving = scale * float(hazard(species_config.hazard, 0.0, 0.0))
    damage = float(rows["energy_damage"].sum()) if "energy_damage" in rows.columns else 0.0
    rates = {
        "hunger": _ratio(sums["energy_forgiven"], sums["energy_basic"] + sums["energy_action"] + damage),
        "refusal": _ratio(refusals, refusals + sums["births"]),
        "uptake": _ratio(eaten, growth),
        "turnover": _ratio(0.5 * (sums["births"] + sums["deaths"]), agent_steps * starving),
        "crowding": agent_steps / steps / species_config.population.capacity,
    }
    return {"step": int(rows["step"][-1]), "steps": steps, "regime": _name(int(rows["alive"][-1]), **rates)} | rates


def _eaten(rows: pl.DataFrame, kind: str) -> float:
    """Amount of a kind of food that was eaten, by all species if that is known."""
    name = all_eaten(kind) if all_eaten(kind) in rows.columns else f"eaten_{kind}"
    return float(rows[name].sum())


_SUMMED = (
    "agent_steps",
    "births",
    "deaths",
    "births_failed_full",
    "births_failed_space",
    "energy_forgiven",
    "energy_basic",
    "energy_action",
)


def _name(alive: int, hunger: float, refusal: float, uptake: float, turnover: float, crowding: float) -> str:
    """Applies the rules; a comparison with an undefined rate is false."""
    if alive == 0:
        return EXTINCT
    if turnover < IDLE_TURNOVER and (crowding >= IDLE_CROWDING or refusal >= IDLE_CROWDING):
        return IDLE
    if hunger >= ROOM_HUNGER and refusal >= ROOM_REFUSAL:
        return ROOM
    if uptake >= FOOD_UPTAKE and refusal < ROOM_REFUSAL:
        return FOOD
    return BETWEEN


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole else np.nan
