"""What came out of a run, in one dictionary: the content of `summary.json`.

Numbers of agents are those of one species. Where a run has several, each has its own, under `species`, and what is
summed over all of them is called a total.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.agent.lifetime import dead_agents, mean_lifetime
from hedon.analysis.gene.weight import LAST_AGENTS, last_living, weight_spreads
from hedon.analysis.world.ledger import world_ledger
from hedon.analysis.world.population import alive_after_extinction, last_generation, mean_alive, mean_energy, run_tail
from hedon.analysis.world.record import born_since, gone_step
from hedon.analysis.world.species import Kind, by_species, kinds
from hedon.record.reader import Run
from hedon.statistic.interval import AMOUNT, mean_interval
from hedon.study.catalogue import reported_figures

_OVER_WORLDS = {
    "mean_lifetime": "mean_lifetime",
    "food_per_step": "food_per_step",
    "food_per_agent_step": "food_per_agent_step",
    "alive": "alive_mean",
    "mean_energy": "mean_energy",
    "generation": "generation",
}
_HUNTS = {"prey_per_step": "prey_per_step", "prey_per_agent_step": "prey_per_agent_step"}
"""The same, in runs where agents eat agents."""
_COUNTS = ("births", "deaths", "births_failed_full", "births_failed_space")
_CAUSES = ("deaths_starved", "deaths_eaten")
"""Columns of runs where agents die of more than age and energy."""

Fare = Mapping[str, Any]


@dataclass(frozen=True)
class _Species:
    """One species of a run: what it eats and inherits, and its rows of both tables."""

    kind: Kind
    agents: pl.DataFrame
    population: pl.DataFrame


def summarize(run: Run) -> dict[str, Any]:
    """Computes the summary of a run, also of one that goes on.

    Damaged parts are left out and named under "damaged_parts".

    Returns:
        Only plain values that JSON knows, None for what has no value. The keys are described in
        `summary_key`.

    Raises:
        ConfigError: the run has several species, and its config cannot be read.
    """
    run = run.load()
    agents, population = run.agents(skip_damaged=True), run.population(skip_damaged=True)
    parts = _by_species(run, agents, population)
    fares = {name: _fares(run, part) for name, part in parts.items()}
    worlds = [_world(run, index, population, fares) for index in range(len(run.manifest.seeds))]
    manifest = run.manifest
    means = {name: _means(run, parts[name], fares[name]) for name in parts}
    summary = {
        "name": manifest.name,
        "preset": manifest.preset,
        "fidelity": manifest.fidelity,
        "modified": manifest.modified,
        "hedon_version": manifest.hedon_version,
        "backend": manifest.backend,
        "status": manifest.status,
        "config_digest": manifest.config_digest,
        "food_kinds": manifest.food_kinds,
        "seeds": manifest.seeds,
        "steps_asked": manifest.steps_asked,
        "steps": sum(world["steps"] for world in worlds),
        **(_several(agents, worlds, means) if run.columns.several else next(iter(means.values()))),
        "reported": reported_figures(manifest.preset) if manifest.modified is False else {},
        "damaged_parts": [str(path.relative_to(run.path)) for path in run.damaged_parts()],
        "worlds": worlds,
    }
    return plain(summary)


def plain(value: Any) -> Any:
    """A value as JSON knows it: NumPy and tuples become plain, numbers that are not finite become None."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _by_species(run: Run, agents: pl.DataFrame, population: pl.DataFrame) -> dict[str, _Species]:
    config = run.config if run.columns.several else None
    lives, rows = by_species(agents, run.columns), by_species(population, run.columns)
    return {name: _Species(kind, lives[name], rows[name]) for name, kind in kinds(run.columns, config).items()}


def _several(agents: pl.DataFrame, worlds: Sequence[Fare], means: Mapping[str, Fare]) -> dict[str, Any]:
    """What the summary of several species has in place of the means of one."""
    alive = mean_interval((world["total"]["alive_mean"] for world in worlds), within=AMOUNT)
    return {
        "extinct_worlds": sum(world["extinct"] for world in worlds),
        "total": {"agents": agents.height, "alive": asdict(alive)},
        "species": means,
    }


def _means(run: Run, part: _Species, fares: Sequence[Fare]) -> dict[str, Any]:
    """The numbers of one species over all worlds."""
    surviving = [fare for fare in fares if not fare["extinct"]]
    return {
        "agents": part.agents.height,
        "extinct_worlds": len(fares) - len(surviving),
        **_over_worlds(run, part, fares),
        "pooled": {
            "agents": dead_agents(_born(run, part.agents)).height,
            "mean_lifetime": mean_lifetime(_born(run, part.agents)),
            "food_per_step": food_per_step(part.agents, part.kind.foods),
        },
        "surviving": _over_worlds(run, part, surviving),
    }


def _over_worlds(run: Run, part: _Species, fares: Sequence[Fare]) -> dict[str, Any]:
    wanted = _OVER_WORLDS | (_HUNTS if run.columns.prey else {})
    intervals = {key: mean_interval((fare[source] for fare in fares), within=AMOUNT) for key, source in wanted.items()}
    weights = {name: mean_interval(fare["weights"][name]["mean"] for fare in fares) for name in part.kind.genes}
    return {
        **{key: asdict(interval) for key, interval in intervals.items()},
        "weights": {name: asdict(interval) for name, interval in weights.items()},
    }


def _world(run: Run, index: int, population: pl.DataFrame, fares: Mapping[str, Sequence[Fare]]) -> dict[str, Any]:
    rows, manifest = population.filter(pl.col("world") == index), run.manifest
    recorded = int(rows["step"].to_numpy().max()) if rows.height else 0
    steps = max(recorded, manifest.steps_done[index] if manifest.steps_done else 0)
    made = steps - (manifest.parent.step if manifest.parent else 0)
    begin = {
        "seed": manifest.seeds[index],
        "steps": steps,
        "steps_per_second": made / manifest.run_seconds if manifest.run_seconds else None,
    }
    mine = {name: every[index] for name, every in fares.items()}
    if not run.columns.several:
        return begin | dict(next(iter(mine.values())))
    extinct = all(fare["extinct"] for fare in mine.values())
    return begin | {
        "extinct": extinct,
        "extinct_step": max(fare["extinct_step"] for fare in mine.values()) if extinct else None,
        "total": {
            "alive": sum(fare["alive"] for fare in mine.values()),
            "alive_mean": _sum(fare["alive_mean"] for fare in mine.values()),
            **{name: sum(fare[name] for fare in mine.values()) for name in _COUNTS},
            "eaten": {meal: rows[f"eaten_{meal}"].sum() for meal in (*run.food_kinds, *run.columns.prey)},
        },
        "species": mine,
    }


def _fares(run: Run, part: _Species) -> list[Fare]:
    """How a species fares in each world of a run."""
    return [_fare(run, part, index) for index in range(len(run.manifest.seeds))]


def _born(run: Run, agents: pl.DataFrame) -> pl.DataFrame:
    """Those of a branch that were born in it; see `born_since`."""
    return born_since(agents, run.manifest.parent.step if run.manifest.parent else 0)


def _fare(run: Run, part: _Species, index: int) -> Fare:
    # In one piece: sums must not depend on the parts in which rows were written.
    agents, population = (table.filter(pl.col("world") == index).rechunk() for table in (part.agents, part.population))
    tail, foods, prey = run_tail(population), part.kind.foods, part.kind.prey
    extinct = gone_step(run, index, agents, population)
    alive = population["alive"][-1] if population.height else agents["death_step"].null_count()
    hunts = {"prey_per_step": food_per_step(agents, prey), "prey_per_agent_step": food_per_agent_step(population, prey)}
    return {
        "alive": alive,
        "alive_mean": mean_alive(tail) if extinct is None else alive_after_extinction(population, _end(run)),
        "extinct": extinct is not None,
        "extinct_step": extinct,
        **{name: population[name].sum() for name in (*_COUNTS, *_CAUSES) if name in population.columns},
        "mean_lifetime": mean_lifetime(_born(run, agents)),
        "mean_lifetime_born": mean_lifetime(_born(run, agents), born_in_run=True),
        "mean_lifetime_last": mean_lifetime(_born(run, agents), last=LAST_AGENTS),
        "food_per_step": food_per_step(agents, foods),
        "food_per_agent_step": food_per_agent_step(population, foods),
        **(hunts if run.columns.prey else {}),
        "eaten": {meal: population[f"eaten_{meal}"].sum() for meal in (*foods, *prey)},
        "mean_energy": mean_energy(tail) if extinct is None else None,
        "generation": last_generation(population),
        "weights": weight_spreads(last_living(agents, population), part.kind.genes),
        "ledger": world_ledger(population, agents),
    }


def _end(run: Run) -> int:
    """Up to which step all worlds of a run were to go, or have gone so far; at least 1."""
    manifest = run.manifest
    longest = max(manifest.steps_done, default=0)
    recorded = run.population(skip_damaged=True)["step"].to_numpy().max(initial=0)
    return max(manifest.steps_asked if manifest.status == "finished" else max(longest, int(recorded)), 1)


def _sum(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) if known else None
