"""Checks the table `population`: intervals without gaps, counts that match the agents, and the energy ledger."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.world.ledger import flow_names, interval_residuals
from hedon.check.finding import Finding, break_rules
from hedon.check.genealogy import first_step, species_rules, world_rules
from hedon.record.manifest import Manifest

_BY_CAUSE = {"deaths_starved": "starved", "deaths_eaten": "eaten"}
"""Columns that count deaths, each with its cause in the table `agents`, in worlds with several causes."""
_ROUNDING = 8 * 2.0**-53
"""Largest relative rounding error per step of an agent: at most eight sums, each rounded by at most 2^-53."""


def check_population(
    population: pl.DataFrame, agents: pl.DataFrame | None, manifest: Manifest, *, ended: bool
) -> Iterator[Finding]:
    """Checks the intervals of a run.

    Args:
        population: Rows of the table `population`.
        agents: Rows of the table `agents`; None if they are incomplete or faulty.
        manifest: Manifest of the run.
        ended: Whether the run has ended.
    """
    yield from break_rules(population, "population", _keys(population), world_rules(manifest) | species_rules(manifest))
    for world, species in product(range(len(manifest.seeds)), manifest.species):
        selection = pl.col("world") == world
        if manifest.columns.several:
            selection &= pl.col("species") == species
        rows = population.filter(selection)
        species_agents = agents.filter(selection) if agents is not None else None
        findings = list(_check_order(rows, world, manifest, ended))
        yield from findings
        if rows.height and not findings:
            yield from _check_world(rows, species_agents, manifest)


def _keys(rows: pl.DataFrame) -> tuple[str, ...]:
    """The columns that identify a row of the table."""
    return ("world", *(("species",) if "species" in rows.columns else ()), "step")


def _check_order(rows: pl.DataFrame, world: int, manifest: Manifest, ended: bool) -> Iterator[Finding]:
    start_step, previous = first_step(manifest), pl.col("step").shift(1)
    start = pl.col("step") - pl.col("steps")
    rules = {
        "the row is repeated or out of order": pl.col("step") <= previous,
        "the interval has no length": pl.col("steps") <= 0,
    }
    findings = list(break_rules(rows, "population", _keys(rows), rules))
    # The first interval of a branch starts at its parent's last row.
    is_bad_start = start > start_step if manifest.parent else start != start_step
    gap = {
        "there is a gap before the interval": pl.when(previous.is_null())
        .then(is_bad_start)
        .otherwise(start != previous)
    }
    yield from findings or break_rules(rows, "population", _keys(rows), gap)
    last_step = rows["step"][-1] if rows.height else start_step
    if ended and last_step != manifest.steps_done[world]:
        end = f"ends at step {last_step:,}, but the manifest has {manifest.steps_done[world]:,} steps"
        yield Finding("population", f"world {world}: {end}")


def _check_world(rows: pl.DataFrame, agents: pl.DataFrame | None, manifest: Manifest) -> Iterator[Finding]:
    expected_alive = pl.col("alive").shift(1) + pl.col("births") - pl.col("deaths")
    rules = {
        "alive, births or deaths is negative": pl.min_horizontal("alive", "births", "deaths") < 0,
        "alive does not agree with births and deaths": pl.col("alive") != expected_alive,
    }
    if agents is not None:
        rows = rows.with_columns(**_count_agents(rows, agents))
        is_recorded = pl.col("step") - pl.col("steps") >= first_step(manifest)
        for name in _compared(rows):
            differs = pl.col(name) != pl.col(f"{name}_of_agents")
            rules[f"{name} does not agree with the table agents"] = is_recorded & differs
    yield from break_rules(rows, "population", _keys(rows), rules)
    if agents is not None and manifest.parent is None:
        yield from _check_meals(rows, agents, manifest)
        gap = interval_residuals(rows, agents)
    else:
        gap = interval_residuals(rows, None)
    rows = rows.with_columns(gap=pl.Series(gap), rounding=pl.Series(_ledger_rounding(rows)))
    open_ledger = {"the energy ledger does not close": ~(pl.col("gap") <= pl.col("rounding")) & ~pl.col("gap").is_nan()}
    yield from break_rules(rows, "population", _keys(rows), open_ledger)


def _count_agents(rows: pl.DataFrame, agents: pl.DataFrame) -> dict[str, pl.Series]:
    """Counts for each interval, from the table `agents`."""
    births = np.sort(agents["birth_step"].to_numpy())
    deaths = np.sort(agents["death_step"].drop_nulls().to_numpy())
    end = rows["step"].to_numpy()
    start = end - rows["steps"].to_numpy()

    def between(events: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.searchsorted(events, end, "right") - np.searchsorted(events, start, "right")

    def lived(until: NDArray[np.int64]) -> NDArray[np.int64]:
        """Steps lived by all agents up to a step, summed."""
        return _time_since(births, until) - _time_since(deaths, until)

    def dead(cause: str) -> NDArray[np.int64]:
        return between(np.sort(agents.filter(pl.col("cause") == cause)["death_step"].drop_nulls().to_numpy()))

    alive = np.searchsorted(births, end, "right") - np.searchsorted(deaths, end, "right")
    counts = {name: dead(cause) for name, cause in _BY_CAUSE.items() if name in rows.columns}
    counts |= {
        "births": between(births),
        "deaths": between(deaths),
        "alive": alive,
        "agent_steps": lived(end) - lived(start),
    }
    return {f"{name}_of_agents": pl.Series(count) for name, count in counts.items()}


def _compared(rows: pl.DataFrame) -> list[str]:
    """The counts of an interval that can be computed from the table of agents."""
    return ["births", "deaths", "alive", "agent_steps", *(name for name in _BY_CAUSE if name in rows.columns)]


def _time_since(events: NDArray[np.int64], until: NDArray[np.int64]) -> NDArray[np.int64]:
    """The time from each event before a step until that step, summed."""
    sums = np.concatenate([[0], np.cumsum(events, dtype=np.int64)])
    count = np.searchsorted(events, until, "right")
    return count * until - sums[count]


def _check_meals(rows: pl.DataFrame, agents: pl.DataFrame, manifest: Manifest) -> Iterator[Finding]:
    for kind in (*manifest.food_kinds, *manifest.prey):
        eaten, recorded = int(agents[f"eaten_{kind}"].sum()), int(rows[f"eaten_{kind}"].sum())
        if rows["step"][-1] == manifest.steps_done[rows["world"][0]] and eaten != recorded:
            yield Finding(
                "population",
                f"world {rows['world'][0]}: the agents ate {eaten:,} of {kind}, but the intervals have {recorded:,}",
            )


def _ledger_rounding(rows: pl.DataFrame) -> NDArray[np.float64]:
    """Largest ledger error of each interval from rounding; the counters are sums since the start."""
    moving = [*flow_names(rows), "energy_shared"]
    flows = sum(np.cumsum(np.abs(rows[name].to_numpy())) for name in moving) + rows["energy_total"].to_numpy()
    start = rows["step"][0] - rows["steps"][0]
    recorded = rows["step"].to_numpy() - start
    # Energy flows before the first row of a branch are not recorded, so the same flow per step is assumed.
    energy_moved = (flows + rows["energy_total"][0]) * (rows["step"].to_numpy() / recorded)
    return _ROUNDING * (rows["agent_steps"].to_numpy() + rows["alive"].to_numpy() + 1) * energy_moved
