"""One table of a sweep, from the results of its batches."""

import io
import json
from collections.abc import Sequence
from typing import Any

import polars as pl

from hedon.jobs.store import Store
from hedon.sweep.error import SweepError
from hedon.sweep.plan import SweepPlan
from hedon.sweep.row import KEYS
from hedon.sweep.work import RESULTS

TABLE = "table.parquet"


def read_results(plan: SweepPlan, store: Store) -> list[dict[str, Any]]:
    """The results of all batches that are done, in the plan's order.

    Args:
        plan: Of the sweep.
        store: Where the sweep lives.

    Raises:
        SweepError: one cannot be read.
    """
    done, results = set(store.names(RESULTS)), []
    for name in (f"{batch.name}.json" for batch in plan.batches()):
        if name in done:
            try:
                results.append(json.loads(store.read(f"{RESULTS}/{name}") or b""))
            except ValueError as error:
                raise SweepError(f"{store.location}/{RESULTS}/{name} is damaged: remove it, and resume") from error
    return results


def _sweep_table(plan: SweepPlan, results: Sequence[dict[str, Any]]) -> pl.DataFrame:
    """One row per world, by condition and repetition: keys, settings that vary, digest, summary; the extinct too.

    What a condition does not have, such as a food of another preset, is null.
    """
    rows = [row for result in results for row in result["worlds"]]
    if not rows:
        return pl.DataFrame(schema=dict.fromkeys(KEYS, pl.Int64))
    columns = dict.fromkeys(name for row in rows for name in row)
    series = [pl.Series(name, _alike([row.get(name) for row in rows]), strict=False) for name in columns]
    return pl.DataFrame(series).sort("condition", "repetition")


def collect(plan: SweepPlan, store: Store) -> pl.DataFrame:
    """Writes the table `table.parquet` of all worlds so far, and returns it.

    Args:
        plan: Of the sweep.
        store: Where the sweep lives.

    Raises:
        SweepError: A result cannot be read, or the table cannot be written.
    """
    table = _sweep_table(plan, read_results(plan, store))
    buffer = io.BytesIO()
    table.write_parquet(buffer)
    store.write(TABLE, buffer.getvalue())
    return table


def _alike(values: list[Any]) -> list[Any]:
    """Values of one kind: a factor that takes 1 and 0.5 takes 1.0."""
    kinds = {type(value) for value in values if value is not None}
    if kinds == {int, float}:
        return [None if value is None else float(value) for value in values]
    if len(kinds) > 1:
        return [None if value is None else str(value) for value in values]
    return values
