"""Why two runs differ: their settings, their provenance, and the point at which their worlds diverge."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import polars as pl

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config.dump import diff
from hedon.config.problem import format_value
from hedon.record.manifest import Manifest
from hedon.record.reader import open_run

MADE_BY = ("hedon_version", "git_revision", "git_modified", "backend", "schema", "python", "platform")
"""Fields of a manifest that may explain different results for equal settings."""
_NAMES = ("world", "seed", "species")


@dataclass(frozen=True)
class Parting:
    """The point at which the records of two worlds with the same seed diverge.

    Attributes:
        seed: Seed of both worlds.
        species: Species whose records diverge first; empty if there is only one.
        step: End of the first window that differs, or birth of the first agent that differs [step]; None if the
            records are equal.
        agent: ID of that agent; None if a window differs.
        values: The differing values by column, in the first and in the second run.
        since: First step for which both have records: 0, or the start of a branch [step].
        until: Last step for which both have records [step].
    """

    seed: int
    species: str
    step: int | None
    agent: int | None
    values: dict[str, tuple[Any, Any]]
    since: int
    until: int


@dataclass(frozen=True)
class Difference:
    """The differences between two runs.

    Attributes:
        settings: Paths of differing settings, with the values in both runs.
        made_by: Differing fields of the manifests, with the values in both runs.
        partings: Comparison of each seed that both runs have.
        ends: Seeds whose records are equal, but whose last states at the same step have different digests.
        lonely: Seeds that only one of the runs has.
    """

    settings: list[tuple[str, Any, Any]]
    made_by: list[tuple[str, Any, Any]]
    partings: list[Parting]
    ends: list[int]
    lonely: list[int]

    @property
    def same(self) -> bool:
        """Whether settings and records are equal, even if different versions of hedon made them."""
        return not (self.settings or self.ends or self.lonely or any(parting.values for parting in self.partings))


def compare_runs(a: Path, b: Path) -> Difference:
    """Compares two runs, finished or not.

    Args:
        a: Folder of the first run.
        b: Folder of the second run.

    Raises:
        RecordError: One of them is not a run, or cannot be read.
        ConfigError: The config of one of them cannot be read.
    """
    runs = [open_run(path).load() for path in (a, b)]
    first_manifest, second_manifest = (run.manifest for run in runs)
    settings = diff(*(run.config for run in runs))
    made_by = [(name, getattr(first_manifest, name), getattr(second_manifest, name)) for name in MADE_BY]
    first_worlds, second_worlds = (_by_seed(read_worlds([run])) for run in runs)
    partings = [
        _parting(seed, first_worlds[seed], second_worlds[seed])
        for seed in first_manifest.seeds
        if seed in first_worlds.keys() & second_worlds.keys()
    ]
    equal_seeds = [parting.seed for parting in partings if not parting.values]
    return Difference(
        settings=settings,
        made_by=[row for row in made_by if row[1] != row[2]],
        partings=partings,
        ends=[seed for seed in equal_seeds if _ends_differ(first_manifest, second_manifest, seed)],
        lonely=sorted(set(first_manifest.seeds) ^ set(second_manifest.seeds)),
    )


def changed_line(name: str, before: Any, after: Any) -> str:
    """How messages show a setting or another value that differs: "energy.basic_cost: 0.001 -> 0.002"."""
    return f"{name}: {changed_value(before)} -> {changed_value(after)}"


def changed_value(value: Any) -> str:
    """A value that differs, as messages show it; "(none)" for None."""
    return "(none)" if value is None else format_value(value)


def _by_seed(worlds: Sequence[WorldRecord]) -> dict[int, dict[str, WorldRecord]]:
    worlds_by_seed: dict[int, dict[str, WorldRecord]] = {}
    for world in worlds:
        worlds_by_seed.setdefault(world.seed, {})[world.species] = world
    return worlds_by_seed


def _parting(seed: int, first: dict[str, WorldRecord], second: dict[str, WorldRecord]) -> Parting:
    """Compares windows first, then the lives of agents; with several species, the first to diverge is reported."""
    shared_species = [name for name in first if name in second]
    worlds = [each for pair in (first, second) for each in pair.values()]
    until = min([each.recorded_step() for each in worlds], default=0)
    since = max([each.first_step for each in worlds], default=0)
    partings: list[Parting] = []
    for name in shared_species:
        pair = _since(first[name].until(until), since), _since(second[name].until(until), since)
        is_cut = max(first[name].last_step, second[name].last_step) > until
        species = name if len(first) > 1 else ""
        windows = _first_row(pair[0].population, pair[1].population, "step", "step", how="inner")
        if windows is not None:
            partings.append(Parting(seed, species, windows[0], None, windows[2], since, until))
            continue
        lives = _first_row(*_lives(*pair, is_cut=is_cut), "agent_id", "birth_step", how="full")
        if lives is not None:
            partings.append(Parting(seed, species, *lives, since, until))
    return min(partings, key=lambda each: each.step or 0, default=Parting(seed, "", None, None, {}, since, until))


def _since(world: WorldRecord, step: int) -> WorldRecord:
    """The world without agents that died before the records of a branch start [step]."""
    death_step = pl.col("death_step")
    return replace(world, agents=world.agents.filter(death_step.is_null() | (death_step > step))) if step else world


def _lives(one: WorldRecord, two: WorldRecord, *, is_cut: bool) -> tuple[pl.DataFrame, pl.DataFrame]:
    """Their agents; if one record was cut, values that it lacks for the living are set to null in both."""
    if not is_cut:
        return one.agents, two.agents
    birth_columns = {"world", "seed", "species", "agent_id", "parent_id", "generation", "birth_step", "birth_energy"}
    later_columns = [name for name in one.agents.columns if name not in birth_columns | set(one.weight_names)]
    dead = pl.col("death_step").is_not_null()
    first, second = (world.agents.with_columns(pl.when(dead).then(pl.col(later_columns))) for world in (one, two))
    return first, second


def _first_row(
    one: pl.DataFrame, two: pl.DataFrame, key: str, order: str, how: Literal["inner", "full"]
) -> tuple[int, int, dict[str, tuple[Any, Any]]] | None:
    """The first row in which two tables differ: its order, its key, and the differing values; None if they are equal.

    Only windows in both tables are compared, since a run that ends within a window has a row that a longer run lacks.
    """
    columns = [name for name in one.columns if name in two.columns and name not in (*_NAMES, key)]
    joined = one.select(key, *columns).join(two.select(key, *columns), on=key, how=how, coalesce=True, suffix=" 2")
    differences = [(pl.col(name).ne_missing(pl.col(f"{name} 2"))).alias(name) for name in columns]
    rows = joined.filter(pl.any_horizontal(differences)) if columns else joined.clear()
    if rows.is_empty():
        return None
    place = pl.col(order) if order == key else pl.coalesce(order, f"{order} 2")
    row = rows.with_columns(place.alias("place")).sort("place", key).row(0, named=True)
    return row["place"], row[key], dict(_changed(row, columns))


def _changed(row: dict[str, Any], columns: Sequence[str]) -> Iterator[tuple[str, tuple[Any, Any]]]:
    for name in columns:
        before, after = row[name], row[f"{name} 2"]
        if before != after and not (before != before and after != after):  # NaN equals NaN here
            yield name, (before, after)


def _ends_differ(one: Manifest, two: Manifest, seed: int) -> bool:
    """Whether the worlds of a seed ended at the same step in different states."""
    ends = []
    for manifest in (one, two):
        index = manifest.seeds.index(seed)
        if not manifest.world_digests:
            return False
        ends.append((manifest.steps_done[index], manifest.world_digests[index]))
    return ends[0][0] == ends[1][0] and ends[0][1] != ends[1][1]
