"""Reads the worlds of a comparison from runs, a sweep, an assay, a study, or a table in a file."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import polars as pl

from hedon.analysis.world.future import shared_pasts
from hedon.analysis.world.record import WorldRecord, condition_names, read_worlds
from hedon.compare.error import CompareError
from hedon.compare.length import RunLength
from hedon.config import Config
from hedon.config.problem import nearest
from hedon.ensemble.collect import collect, table_value
from hedon.ensemble.plan import PLAN, load_bases, load_plan
from hedon.ensemble.store import Store
from hedon.measure.world_measure import titles_of, world_row
from hedon.record.folder import holds_run
from hedon.record.reader import Run, open_run
from hedon.report.answer import CAUTIONS, FACTORS, WORLDS

SOURCE, CONDITION = "source", "condition"
"""Names of the factors for worlds from two sources, and for runs with several configs."""
KINDS = "runs, a sweep, an assay, a study, or a table (.csv, .parquet)"


@dataclass(frozen=True, eq=False)
class WorldTable:
    """Worlds to compare.

    Attributes:
        name: The source, as the user named it.
        rows: A row per world: its seed, its value of each factor, and its measures.
        factors: Columns that distinguish conditions.
        steps: The length of each world, if all have the same [step].
        planned: The values of each factor in the order of a sweep's plan, including values without worlds so far.
        cautions: Sentences about worlds that are not independent.
        titles: Titles of measures that configs add, by name.
        lengths: Lengths of the runs that hold the worlds; none for other sources.
        configs: Settings of each value of the factor "source" or "condition", if runs hold the worlds.
        labels: Names of the conditions of two sources, by source, if they are runs.
    """

    name: str
    rows: pl.DataFrame
    factors: tuple[str, ...] = ()
    steps: int | None = None
    planned: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    cautions: tuple[str, ...] = ()
    titles: Mapping[str, str] = field(default_factory=dict)
    lengths: tuple[RunLength, ...] = ()
    configs: Mapping[str, Config] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)


def read_table(source: str) -> WorldTable:
    """Reads the worlds of one source.

    Raises:
        CompareError: The source is of no known kind, or contains no world.
        RecordError, ConfigError, EnsembleError: The source cannot be read.
    """
    runs = _open_runs(source)
    return _runs_table(source, runs, _records(runs)) if runs else _other_table(source)


def read_both(sources: tuple[str, str]) -> WorldTable:
    """Reads the worlds of two sources as one table with the factor "source"; runs are cut to a common length.

    Raises:
        CompareError: The sources are the same, one contains runs of several conditions, or their worlds differ in
            length.
        RecordError, ConfigError, EnsembleError: One of the sources cannot be read.
    """
    if sources[0] == sources[1]:
        raise CompareError(f"{sources[0]} is named twice: name two sources, or --by FACTOR within one")
    runs = [_open_runs(source) for source in sources]
    records = [_records(each) for each in runs]
    end = min(world.end_step for each in records for world in each) if all(records) else None
    tables = [
        _runs_table(source, own, worlds, end) if own else _other_table(source)
        for source, own, worlds in zip(sources, runs, records, strict=True)
    ]
    for table, own in zip(tables, runs, strict=True):
        if CONDITION in table.factors and own:
            raise CompareError(
                f"{table.name} holds runs of several configs: name a folder of one, or compare these with one another "
                f"by `hedon compare {table.name} --by {CONDITION}`"
            )
    lengths = [table.steps for table in tables]
    if None not in lengths and lengths[0] != lengths[1]:
        said = " and of ".join(f"{table.name} have {table.steps:,} steps" for table in tables)
        raise CompareError(f"worlds of {said}: compare worlds of equal length")
    factors = tuple(dict.fromkeys([*tables[0].factors, *tables[1].factors]))
    shared = [name for name in tables[0].rows.columns if name in tables[1].rows.columns]
    if not set(shared) - {"seed", *factors}:
        raise CompareError(f"{sources[0]} and {sources[1]} have no measure in common")
    parts = [
        table.rows.select(
            pl.lit(table.name).alias(SOURCE), *(c for c in table.rows.columns if c in (*shared, *factors))
        )
        for table in tables
    ]
    rows = pl.concat(parts, how="diagonal_relaxed")
    steps = lengths[0] if len(set(lengths)) == 1 else None
    names = condition_names([own[0] for own in runs]) if all(runs) else ()
    return WorldTable(
        " and ".join(sources),
        rows,
        (SOURCE, *factors),
        steps,
        cautions=(*tables[0].cautions, *tables[1].cautions),
        titles={**tables[0].titles, **tables[1].titles},
        lengths=(*tables[0].lengths, *tables[1].lengths),
        configs={source: own[0].config for source, own in zip(sources, runs, strict=True) if own},
        labels=dict(zip(sources, names, strict=False)),
    )


def _run_folders(source: str) -> list[Path]:
    """The folder itself if it is a run, or the runs in it; none for a sweep, an assay, a study, or no folder."""
    folder = Path(source)
    if "://" in source or not folder.is_dir():
        return []
    if holds_run(folder):
        return [folder]
    if (folder / PLAN).is_file() or _answer(folder) is not None:
        return []
    return sorted(each for each in folder.iterdir() if each.is_dir() and holds_run(each))


def _open_runs(source: str) -> list[Run]:
    """The runs of a source; none if it is of another kind."""
    return [open_run(each).load() for each in _run_folders(source)]


def _records(runs: Sequence[Run]) -> list[WorldRecord]:
    """The worlds of some runs; if a run is unfinished, up to the last step that all of its records cover."""
    for damaged in (path for run in runs for path in run.damaged_parts()):
        raise CompareError(f"{damaged} is damaged, so its worlds lack rows: `hedon check` says more")
    whole = {run.path.name for run in runs if run.manifest.status in ("finished", "interrupted")}
    return [world if world.run in whole else world.until(world.recorded_step()) for world in read_worlds(runs)]


def _lengths(runs: Sequence[Run], records: Sequence[WorldRecord]) -> Iterator[RunLength]:
    """The length of each run of which there are records."""
    for run in runs:
        ends = [world.end_step for world in records if world.run == run.path.name]
        if ends:
            yield RunLength(str(run.path), min(ends), run.manifest.status)


def _runs_table(source: str, runs: Sequence[Run], records: Sequence[WorldRecord], end: int | None = None) -> WorldTable:
    """The worlds of some runs, cut at a step; by default the one that all of them were planned to reach [step]."""
    end = min(world.end_step for world in records) if end is None else end
    if end < 1:
        raise CompareError(f"{source}: has no step yet at which the records know all agents of every world")
    worlds: dict[tuple[str, int], list[WorldRecord]] = {}
    configs: dict[str, Config] = {}
    for world in records:
        condition = world.condition.removesuffix(f": {world.species}")
        worlds.setdefault((condition, world.seed), []).append(world.until(end))
        configs.setdefault(condition, world.config)
    several = len(configs) > 1
    rows = [({CONDITION: condition} if several else {}) | world_row(each) for (condition, _), each in worlds.items()]
    return WorldTable(
        source,
        _frame(rows),
        (CONDITION,) if several else (),
        end,
        cautions=tuple(shared_pasts(runs)),
        titles=titles_of(world.config for world in records),
        lengths=tuple(_lengths(runs, records)),
        configs=configs,
    )


def _other_table(source: str) -> WorldTable:
    """The worlds of a file, a sweep, an assay or a study."""
    path = Path(source)
    if path.suffix in (".csv", ".parquet") and path.is_file():
        rows = pl.read_csv(path) if path.suffix == ".csv" else pl.read_parquet(path)
        return _checked(WorldTable(source, rows))
    if "://" not in source and not path.exists():
        raise CompareError(_missing(path))
    store = Store(source)
    if store.read(PLAN) is not None:
        return _sweep_table(source, store)
    content = _answer(path)
    if content is None:
        raise CompareError(f"{source}: holds no worlds to compare: give {KINDS}")
    steps = content.get("steps")
    rows = _frame(content["tables"][WORLDS]["rows"])
    cautions = tuple(content.get(CAUTIONS, ()))
    return _checked(WorldTable(source, rows, tuple(content.get(FACTORS, ())), steps, cautions=cautions))


def _missing(path: Path) -> str:
    """A message that a path does not exist, and the most similar name in the same folder."""
    near = nearest(path.name, [each.name for each in path.parent.iterdir()]) if path.parent.is_dir() else None
    return f"{path} does not exist" + (f"; did you mean {path.parent / near}?" if near else "")


def _sweep_table(source: str, store: Store) -> WorldTable:
    plan = load_plan(store)
    rows = collect(plan, store)
    if rows.is_empty():
        raise CompareError(f"{source}: no batch of the sweep is done yet: there is nothing to compare")
    planned = {}
    for name in plan.factors:
        values = [table_value(each.settings[name]) for each in plan.conditions]
        planned[name] = list(dict.fromkeys(map(str, values) if rows.schema[name] == pl.String else values))
    return WorldTable(source, rows, plan.factors, plan.steps, planned, titles=titles_of(load_bases(plan, store)))


def _answer(folder: Path) -> Mapping[str, Any] | None:
    """The summary of an assay or a study: a JSON file with a table of worlds; None if there is none."""
    for path in sorted(folder.glob("*.json")):
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            rows = content["tables"][WORLDS]["rows"]
        except (OSError, ValueError, KeyError, TypeError):
            continue
        if isinstance(rows, list):
            return content
    return None


def _checked(table: WorldTable) -> WorldTable:
    if "seed" not in table.rows.columns or table.rows.is_empty():
        raise CompareError(f"{table.name}: has no worlds yet: there must be a column seed, and a row for each world")
    return table


def _frame(rows: Sequence[Mapping[str, Any]]) -> pl.DataFrame:
    return pl.DataFrame(rows, infer_schema_length=None)
