"""The results of a run in one dictionary: the numbers of `summary.json`.

Numbers about agents refer to one species. If a run has several, each has its own numbers, under `species`; sums over
all species are called totals.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.agent.food import food_per_step
from hedon.analysis.agent.lifetime import dead_agents, mean_lifetime
from hedon.analysis.gene.weight import last_living, weight_spreads
from hedon.analysis.world.ledger import world_ledger
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.measure.summary_key import MANIFEST_KEYS
from hedon.measure.world_measure import measures_of, titles_of
from hedon.record.reader import Run
from hedon.statistic.interval import AMOUNT, mean_interval

_COUNTS = ("births", "deaths", "births_failed_full", "births_failed_space")

Fare = Mapping[str, Any]
"""The numbers of one species in a world."""


def summarize(run: Run) -> dict[str, Any]:
    """Computes the summary of a run, which may still be in progress.

    Damaged parts are left out and listed under "damaged_parts".

    Returns:
        A dictionary of plain JSON values, with None for missing values. The keys are described in
        `summary_key`.

    Raises:
        ConfigError: The run's config cannot be read.
    """
    run = run.load()
    records = read_worlds([run])
    species = {name: [record for record in records if record.species == name] for name in (r.species for r in records)}
    fares = {name: [_fare(world) for world in species_records] for name, species_records in species.items()}
    worlds = [
        _world(run, index, {name: species_records[index] for name, species_records in species.items()}, fares)
        for index in range(len(run.manifest.seeds))
    ]
    means = {name: _means(species[name], fares[name]) for name in species}
    summary = {
        **{key: getattr(run.manifest, key) for key in MANIFEST_KEYS},
        "steps": sum(world["steps"] for world in worlds),
        **(_several(records, worlds, means) if run.columns.several else next(iter(means.values()))),
        "measures": titles_of([run.config]),
        "damaged_parts": [str(path.relative_to(run.path)) for path in run.damaged_parts()],
        "worlds": worlds,
    }
    return plain(summary)


def plain(value: Any) -> Any:
    """Converts a value for JSON: NumPy values and tuples become plain ones, and non-finite numbers become None."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _several(records: Sequence[WorldRecord], worlds: Sequence[Fare], means: Mapping[str, Fare]) -> dict[str, Any]:
    """The part of a summary that replaces the means if there are several species."""
    alive = mean_interval((world["total"]["alive_mean"] for world in worlds), within=AMOUNT)
    return {
        "extinct_worlds": sum(world["extinct"] for world in worlds),
        "total": {"agents": sum(record.agents.height for record in records), "alive_mean": asdict(alive)},
        "species": means,
    }


def _means(worlds: Sequence[WorldRecord], fares: Sequence[Fare]) -> dict[str, Any]:
    """The numbers of one species over all worlds."""
    surviving = [not fare["extinct"] for fare in fares]
    agents = pl.concat([world.agents for world in worlds])
    born = pl.concat([world.born for world in worlds])
    return {
        "agents": agents.height,
        "extinct_worlds": len(fares) - sum(surviving),
        **_over_worlds(worlds[0], fares),
        "pooled": {
            "agents": dead_agents(born).height,
            "mean_lifetime": mean_lifetime(born),
            "food_per_step": food_per_step(agents, worlds[0].food_kinds),
        },
        "surviving": _over_worlds(
            worlds[0], [fare for fare, survives in zip(fares, surviving, strict=True) if survives]
        ),
    }


def _over_worlds(world: WorldRecord, fares: Sequence[Fare]) -> dict[str, Any]:
    averaged = [each for each in measures_of(world.config).values() if each.averaged and each.applies(world)]
    weights = {name: mean_interval(fare["weights"][name]["mean"] for fare in fares) for name in world.weight_names}
    return {
        **{
            each.name: asdict(mean_interval((fare[each.name] for fare in fares), within=each.within))
            for each in averaged
        },
        "weights": {name: asdict(interval) for name, interval in weights.items()},
    }


def _world(
    run: Run, index: int, species: Mapping[str, WorldRecord], fares: Mapping[str, Sequence[Fare]]
) -> dict[str, Any]:
    manifest, rows = run.manifest, [world.population for world in species.values()]
    recorded = max(int(table["step"].to_numpy().max(initial=0)) for table in rows)
    steps = max(recorded, manifest.steps_done[index] if manifest.steps_done else 0)
    new_steps = steps - (manifest.parent.step if manifest.parent else 0)
    header = {
        "seed": manifest.seeds[index],
        "steps": steps,
        "steps_per_second": new_steps / manifest.run_seconds if manifest.run_seconds else None,
    }
    world_fares = {name: species_fares[index] for name, species_fares in fares.items()}
    if not run.columns.several:
        return header | dict(next(iter(world_fares.values())))
    extinct = all(fare["extinct"] for fare in world_fares.values())
    meals = (*run.food_kinds, *run.columns.prey)
    return header | {
        "extinct": extinct,
        "extinct_step": max(fare["extinct_step"] for fare in world_fares.values()) if extinct else None,
        "total": {
            "alive": sum(fare["alive"] for fare in world_fares.values()),
            "alive_mean": _sum(fare["alive_mean"] for fare in world_fares.values()),
            **{name: sum(fare[name] for fare in world_fares.values()) for name in _COUNTS},
            "eaten": {meal: sum(int(table[f"eaten_{meal}"].sum()) for table in rows) for meal in meals},
        },
        "species": world_fares,
    }


def _fare(world: WorldRecord) -> Fare:
    living, measures = last_living(world.agents, world.population), measures_of(world.config).values()
    return {
        **{measure.name: measure.of(world) for measure in measures if measure.applies(world)},
        "eaten": {meal: world.population[f"eaten_{meal}"].sum() for meal in (*world.food_kinds, *world.prey)},
        "weights": weight_spreads(living, world.weight_names),
        "ledger": world_ledger(world.population, world.agents),
    }


def _sum(values: Iterable[float | None]) -> float | None:
    recorded = [value for value in values if value is not None]
    return sum(recorded) if recorded else None
