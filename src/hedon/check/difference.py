"""Why two runs differ: their settings, what made them, and where their worlds part."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import polars as pl

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config.dump import diff
from hedon.record.manifest import Manifest
from hedon.record.reader import open_run

MADE_BY = ("hedon_version", "git_revision", "git_modified", "backend", "schema", "python", "platform")
"""Parts of a manifest that may explain different results of equal settings."""
_NAMES = ("world", "seed", "species")


@dataclass(frozen=True)
class Parting:
    """Where the records of two worlds of one seed part.

    Attributes:
        seed: of both.
        species: whose records part first; empty where there is only one.
        step: end of the first window in which they differ, or birth of the first agent that does [step]; None if they
            are equal.
        agent: id of that agent; None where a window differs.
        values: what differs there, by column: in the first and in the second run.
        since: from which step on both have records: 0, or where a branch begins [step].
        until: up to which step both have records [step].
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
    """What tells two runs apart.

    Attributes:
        settings: paths with the value in each.
        made_by: parts of the manifests with the value in each.
        partings: one for each seed that both have.
        ends: seeds whose records are equal, but not the digests of their ends at the same step.
        lonely: seeds that only one of them has.
    """

    settings: list[tuple[str, Any, Any]]
    made_by: list[tuple[str, Any, Any]]
    partings: list[Parting]
    ends: list[int]
    lonely: list[int]

    @property
    def same(self) -> bool:
        """Whether settings and records agree; other versions of the program may have made them."""
        return not (self.settings or self.ends or self.lonely or any(each.values for each in self.partings))


def compare_runs(a: Path, b: Path) -> Difference:
    """Compares two runs, finished or not.

    Raises:
        RecordError: one is not a run, or cannot be read.
        ConfigError: the config of one cannot be read.
    """
    runs = [open_run(path).load() for path in (a, b)]
    one, two = (run.manifest for run in runs)
    settings = diff(*(run.config for run in runs))
    made_by = [(name, getattr(one, name), getattr(two, name)) for name in MADE_BY]
    first, second = (_by_seed(read_worlds([run])) for run in runs)
    partings = [_parting(seed, first[seed], second[seed]) for seed in one.seeds if seed in first.keys() & second.keys()]
    equal = [each.seed for each in partings if not each.values]
    return Difference(
        settings=settings,
        made_by=[row for row in made_by if row[1] != row[2]],
        partings=partings,
        ends=[seed for seed in equal if _ends_differ(one, two, seed)],
        lonely=sorted(set(one.seeds) ^ set(two.seeds)),
    )


def _by_seed(worlds: Sequence[WorldRecord]) -> dict[int, dict[str, WorldRecord]]:
    found: dict[int, dict[str, WorldRecord]] = {}
    for world in worlds:
        found.setdefault(world.seed, {})[world.species] = world
    return found


def _parting(seed: int, first: dict[str, WorldRecord], second: dict[str, WorldRecord]) -> Parting:
    """Compares windows first, then the lives of agents; of several species the one that parts first counts."""
    shared = [name for name in first if name in second]
    every = [each for pair in (first, second) for each in pair.values()]
    until = min([each.recorded_step() for each in every], default=0)
    since = max([each.first_step for each in every], default=0)
    found: list[Parting] = []
    for name in shared:
        pair = _since(first[name].until(until), since), _since(second[name].until(until), since)
        cut = max(first[name].last_step, second[name].last_step) > until
        species = name if len(first) > 1 else ""
        windows = _first_row(pair[0].population, pair[1].population, "step", "step", how="inner")
        if windows is not None:
            found.append(Parting(seed, species, windows[0], None, windows[2], since, until))
            continue
        lives = _first_row(*_lives(*pair, cut=cut), "agent_id", "birth_step", how="full")
        if lives is not None:
            found.append(Parting(seed, species, *lives, since, until))
    return min(found, key=lambda each: each.step or 0, default=Parting(seed, "", None, None, {}, since, until))


def _since(world: WorldRecord, step: int) -> WorldRecord:
    """The world without the agents that had died when the records of a branch begin [step]."""
    died = pl.col("death_step")
    return replace(world, agents=world.agents.filter(died.is_null() | (died > step))) if step else world


def _lives(one: WorldRecord, two: WorldRecord, *, cut: bool) -> tuple[pl.DataFrame, pl.DataFrame]:
    """Their agents; where a record was cut, what it does not say of the living is left out of the other too."""
    if not cut:
        return one.agents, two.agents
    known = {"world", "seed", "species", "agent_id", "parent_id", "generation", "birth_step", "birth_energy"}
    later = [name for name in one.agents.columns if name not in known | set(one.weight_names)]
    dead = pl.col("death_step").is_not_null()
    first, second = (each.agents.with_columns(pl.when(dead).then(pl.col(later))) for each in (one, two))
    return first, second


def _first_row(
    one: pl.DataFrame, two: pl.DataFrame, key: str, order: str, how: Literal["inner", "full"]
) -> tuple[int, int, dict[str, tuple[Any, Any]]] | None:
    """The first row in which two tables differ: its order, its key, and the values that differ; None if none does.

    Of windows only those count that both have: a run that ends within one has a row there that a longer one lacks.
    """
    columns = [name for name in one.columns if name in two.columns and name not in (*_NAMES, key)]
    both = one.select(key, *columns).join(two.select(key, *columns), on=key, how=how, coalesce=True, suffix=" 2")
    differs = [(pl.col(name).ne_missing(pl.col(f"{name} 2"))).alias(name) for name in columns]
    rows = both.filter(pl.any_horizontal(differs)) if columns else both.clear()
    if rows.is_empty():
        return None
    place = pl.col(order) if order == key else pl.coalesce(order, f"{order} 2")
    row = rows.with_columns(place.alias("place")).sort("place", key).row(0, named=True)
    return row["place"], row[key], dict(_changed(row, columns))


def _changed(row: dict[str, Any], columns: Sequence[str]) -> Iterator[tuple[str, tuple[Any, Any]]]:
    for name in columns:
        before, after = row[name], row[f"{name} 2"]
        if before != after and not (before != before and after != after):  # NaN is NaN
            yield name, (before, after)


def _ends_differ(one: Manifest, two: Manifest, seed: int) -> bool:
    """Whether the worlds of a seed ended at the same step in other states."""
    ends = []
    for manifest in (one, two):
        index = manifest.seeds.index(seed)
        if not manifest.world_digests:
            return False
        ends.append((manifest.steps_done[index], manifest.world_digests[index]))
    return ends[0][0] == ends[1][0] and ends[0][1] != ends[1][1]
