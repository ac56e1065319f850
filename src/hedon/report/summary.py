"""What came out of a run, in one dictionary: the content of `summary.json`."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.agent.lifetime import dead_agents, mean_lifetime
from hedon.analysis.gene.weight import LAST_AGENTS, world_weights
from hedon.analysis.world.ledger import world_ledger
from hedon.analysis.world.population import extinct_step, last_generation, mean_alive, mean_energy, run_tail
from hedon.record.reader import Run
from hedon.replication.paper import paper_figures
from hedon.statistic.interval import mean_interval

_OVER_WORLDS = {
    "mean_lifetime": "mean_lifetime",
    "food_per_step": "food_per_step",
    "food_per_agent_step": "food_per_agent_step",
    "alive": "alive_mean",
    "mean_energy": "mean_energy",
    "generation": "generation",
}


def summarize(run: Run) -> dict[str, Any]:
    """Computes the summary of a run, also of one that goes on.

    Damaged parts are left out and named under "damaged_parts".

    Returns:
        Only plain values that JSON knows, None for what has no value. The keys are described in
        `summary_key`.
    """
    agents, population = run.agents(skip_damaged=True), run.population(skip_damaged=True)
    weights = world_weights(agents, run.weight_names)
    worlds = [
        _world(run, index, agents, population, weights.get(index, {})) for index in range(len(run.manifest.seeds))
    ]
    manifest = run.manifest
    paper = paper_figures(manifest.preset) if manifest.modified is False else None
    summary = {
        "name": manifest.name,
        "preset": manifest.preset,
        "fidelity": manifest.fidelity,
        "modified": manifest.modified,
        "hedon_version": manifest.hedon_version,
        "kernel": manifest.kernel,
        "status": manifest.status,
        "config_digest": manifest.config_digest,
        "food_kinds": manifest.food_kinds,
        "seeds": manifest.seeds,
        "steps_asked": manifest.steps_asked,
        "steps": sum(world["steps"] for world in worlds),
        "agents": agents.height,
        "extinct_worlds": sum(world["extinct"] for world in worlds),
        **_over_worlds(worlds, run.weight_names),
        "pooled": {
            "agents": dead_agents(agents).height,
            "mean_lifetime": mean_lifetime(agents),
            "food_per_step": food_per_step(agents, run.food_kinds),
        },
        "surviving": _over_worlds([world for world in worlds if not world["extinct"]], run.weight_names),
        "paper": None if paper is None else asdict(paper),
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


def _over_worlds(worlds: Sequence[Mapping[str, Any]], weight_names: Sequence[str]) -> dict[str, Any]:
    intervals = {key: mean_interval(w[source] for w in worlds) for key, source in _OVER_WORLDS.items()}
    weights = {name: mean_interval(w["weights"][name]["mean"] for w in worlds) for name in weight_names}
    return {
        **{key: asdict(interval) for key, interval in intervals.items()},
        "weights": {name: asdict(interval) for name, interval in weights.items()},
    }


def _world(
    run: Run, index: int, agents: pl.DataFrame, population: pl.DataFrame, weights: Mapping[str, Any]
) -> dict[str, Any]:
    # In one piece: sums must not depend on the parts in which rows were written.
    agents, population = (table.filter(pl.col("world") == index).rechunk() for table in (agents, population))
    manifest, tail = run.manifest, run_tail(population)
    recorded = int(population["step"][-1]) if population.height else 0
    steps = max(recorded, manifest.steps_done[index] if manifest.steps_done else 0)
    made = steps - (manifest.parent.step if manifest.parent else 0)
    extinct = manifest.extinct_steps[index] if manifest.extinct_steps else None
    extinct = extinct_step(population) if extinct is None else extinct
    alive = population["alive"][-1] if population.height else agents["death_step"].null_count()
    return {
        "seed": manifest.seeds[index],
        "steps": steps,
        "steps_per_second": made / manifest.run_seconds if manifest.run_seconds else None,
        "alive": alive,
        "alive_mean": mean_alive(tail),
        "extinct": extinct is not None,
        "extinct_step": extinct,
        **{name: population[name].sum() for name in ("births", "deaths")},
        **{name: population[name].sum() for name in ("births_failed_full", "births_failed_space")},
        "mean_lifetime": mean_lifetime(agents),
        "mean_lifetime_born": mean_lifetime(agents, born_in_run=True),
        "mean_lifetime_last": mean_lifetime(agents, last=LAST_AGENTS),
        "food_per_step": food_per_step(agents, run.food_kinds),
        "food_per_agent_step": food_per_agent_step(population, run.food_kinds),
        "eaten": {kind: population[f"eaten_{kind}"].sum() for kind in run.food_kinds},
        "mean_energy": mean_energy(tail),
        "generation": last_generation(population),
        "weights": {
            name: asdict(weights[name]) if name in weights else {"mean": None, "sd": None} for name in run.weight_names
        },
        "ledger": asdict(world_ledger(population, agents)),
    }
