"""Reads one file of a table, which may be damaged or from an untrusted source. All tables are read through here."""

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path

import polars as pl

from hedon.record.atomic import read_whole
from hedon.record.column import MOST_TURN, Table
from hedon.record.error import RecordError
from hedon.record.folder import PARTS_BEFORE
from hedon.record.manifest import Manifest
from hedon.text import brief

_UNREADABLE = (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError, ValueError, OverflowError, MemoryError)
"""Errors raised by reading a damaged file. A panic of Polars is not an `Exception`."""


def load_part(path: Path, table: Table | None = None) -> pl.DataFrame:
    """Reads the rows of a file without checking their values.

    Args:
        path: Path of the file.
        table: Table whose columns are read; None to read all columns of the file.

    Raises:
        RecordError: The file cannot be read; the message names it.
    """
    with _reading(path):
        names = None if table is None else [column.name for column in table.columns]
        return pl.read_parquet(path.read_bytes(), columns=names)


def read_part(path: Path, table: Table, manifest: Manifest) -> pl.DataFrame:
    """Reads and checks the rows of a file.

    Args:
        path: Path of the file.
        table: Table that it belongs to.
        manifest: Manifest of the run, which limits values.

    Raises:
        RecordError: The file cannot be read, or contains values that no run writes; the message names it.
    """
    return _sound(path, load_part(path, table), table, manifest)


def read_living(path: Path, table: Table, manifest: Manifest) -> tuple[pl.DataFrame, int | None]:
    """Reads the living, and the number of parts with the deaths before that moment; None for all existing parts.

    Args:
        path: Path of the file.
        table: Table that it belongs to.
        manifest: Manifest of the run, which limits values.

    Raises:
        RecordError: As for `read_part`.
    """
    with _reading(path):
        content = BytesIO(read_whole(path))
        rows = pl.read_parquet(content, columns=[column.name for column in table.columns])
        parts = pl.read_parquet_metadata(content).get(PARTS_BEFORE)
        part_count = None if parts is None else int(parts)
    return _sound(path, rows, table, manifest), part_count


def value_faults(rows: pl.DataFrame, table: Table, manifest: Manifest | None) -> Iterator[str]:
    """Faults in rows that no run writes: wrong types; missing, non-finite or out-of-range values; unknown names.

    Args:
        rows: The rows to check.
        table: Table that they belong to.
        manifest: Manifest of the run, which limits worlds and steps; None for no such limits.
    """
    limits = {} if manifest is None else {"world": len(manifest.seeds) - 1, "step": manifest.steps_asked}
    other = [column for column, dtype in table.polars_schema.items() if rows.schema[column] != dtype]
    if other:
        yield f"these columns have a wrong type: {', '.join(other)}"
        return
    for column in table.columns:
        values = rows[column.name]
        invalid = 0 if column.nullable else values.null_count()
        if values.dtype.is_float():
            invalid += int((~values.is_finite()).sum())
        if invalid:
            yield f"{invalid:,} values of {column.name} are missing or not finite"
        if column.missing_for is not None and "kind" in rows.columns:
            is_food = rows["kind"].is_in(column.missing_for)
            if (values.is_null() != is_food).any():
                yield f"{column.name} is missing for an agent, or known for a food"
        if values.dtype.is_integer():
            limit = limits.get("world" if column.name == "world" else column.unit)
            is_outside = (values < 0) if limit is None else ~values.is_between(0, limit)
            if is_outside.any():
                first = values.filter(is_outside)[0]
                yield f"{column.name} = {first}: must be from 0" + ("" if limit is None else f" to {limit}")
        elif column.unit == "rad" and (too_large := values.abs() > MOST_TURN).any():
            yield f"{column.name} = {values.filter(too_large)[0]:g}: must be from -{MOST_TURN:g} to {MOST_TURN:g}"
        elif column.choices and not (is_known := values.drop_nulls().is_in(column.choices)).all():
            yield f"{column.name} = {brief(repr(values.drop_nulls().filter(~is_known)[0]))}: the run has no such name"


def _sound(path: Path, rows: pl.DataFrame, table: Table, manifest: Manifest) -> pl.DataFrame:
    for fault in value_faults(rows, table, manifest):
        raise _damaged(path, fault)
    return rows


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    try:
        yield
    except _UNREADABLE as error:
        raise _damaged(path, str(error)) from error


def _damaged(path: Path, reason: str) -> RecordError:
    return RecordError(f"damaged part {path} ({' '.join(reason.split())})")
