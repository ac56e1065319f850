"""Combines the results of a sweep's batches into one table."""

import io
import json
from collections.abc import Iterable, Iterator
from typing import Any

import polars as pl

from hedon.config.problem import format_value
from hedon.ensemble.batch import RESULTS
from hedon.ensemble.error import EnsembleError
from hedon.ensemble.plan import TABLE, SweepPlan, read_name
from hedon.ensemble.row import KEYS
from hedon.ensemble.store import Store

_AT_ONCE = 1000
"""Number of results held in memory as JSON at a time."""


def read_results(plan: SweepPlan, store: Store) -> Iterator[tuple[str, dict[str, Any]]]:
    """The results of all batches that contain worlds of a plan, each with the prefix of its name.

    Raises:
        EnsembleError: A result cannot be read.
    """
    keys, seeds = set(map(plan.key, plan.conditions)), set(plan.seeds)
    names = []
    for name in store.names(RESULTS):
        key, batch_seeds = read_name(name)
        if key in keys and seeds.intersection(batch_seeds):
            names.append(f"{RESULTS}/{name}")
    for start in range(0, len(names), _AT_ONCE):
        chunk = names[start : start + _AT_ONCE]
        for name, content in zip(chunk, store.read_all(chunk), strict=True):
            try:
                yield read_name(name.rpartition("/")[2])[0], json.loads(content or b"")
            except ValueError as error:
                raise EnsembleError(f"{store.location}/{name} is damaged: remove it, and resume") from error


def _sweep_table(plan: SweepPlan, results: Iterable[tuple[str, dict[str, Any]]]) -> pl.DataFrame:
    """One row per world, sorted by condition and repetition, including extinct worlds.

    The columns are keys, varied settings, digest and summary; values that a condition lacks, such as a food of another
    preset, are null.
    """
    frames, rows = [], list[dict[str, Any]]()
    for key, result in results:
        rows += [{"key": key, **row} for row in result["worlds"]]
        if len(rows) > _AT_ONCE:
            frames.append(_frame(rows))
            rows = []
    frames += [_frame(rows)] if rows else []
    if not frames:
        return pl.DataFrame(schema=dict.fromkeys(KEYS, pl.Int64))
    outcomes = pl.concat(frames, how="diagonal_relaxed").unique(["key", "seed"], keep="first")
    values = {name: [table_value(condition.settings[name]) for condition in plan.conditions] for name in plan.factors}
    settings = pl.DataFrame(
        {
            "condition": range(len(plan.conditions)),
            "key": list(map(plan.key, plan.conditions)),
            **{name: pl.Series(_alike(column), strict=False) for name, column in values.items()},
        }
    )
    seeds = pl.DataFrame({"repetition": range(1, len(plan.seeds) + 1), "seed": plan.seeds})
    table = settings.join(outcomes, on="key").join(seeds, on="seed")
    order = dict.fromkeys([*KEYS, *plan.factors, *outcomes.columns])
    return table.select([name for name in order if name != "key"]).sort("condition", "repetition")


def collect(plan: SweepPlan, store: Store) -> pl.DataFrame:
    """Writes the table `table.parquet` of all finished worlds, and returns it.

    Raises:
        EnsembleError: A result cannot be read, or the table cannot be written.
    """
    table = _sweep_table(plan, read_results(plan, store))
    buffer = io.BytesIO()
    table.write_parquet(buffer)
    store.write(TABLE, buffer.getvalue())
    return table


def _frame(rows: list[dict[str, Any]]) -> pl.DataFrame:
    columns = dict.fromkeys(name for row in rows for name in row)
    return pl.DataFrame([pl.Series(name, _alike([row.get(name) for row in rows]), strict=False) for name in columns])


def _alike(values: list[Any]) -> list[Any]:
    """Converts values to one type: if a factor takes 1 and 0.5, the 1 becomes 1.0."""
    kinds = {type(value) for value in values if value is not None}
    if kinds == {int, float}:
        return [None if value is None else float(value) for value in values]
    if len(kinds) > 1:
        return [None if value is None else str(value) for value in values]
    return values


def table_value(value: Any) -> Any:
    """Converts the value of a setting for a table: lists become text."""
    return value if isinstance(value, str | int | float) else format_value(value)
