"""Checks the parts of the tables: all there, readable, with the right columns, and not changed."""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import polars as pl

from hedon.check.finding import Finding
from hedon.record.column import Table
from hedon.record.folder import LIVING, part_path, part_paths


def check_digests(folder: Path, parts: Mapping[str, Sequence[str]]) -> Iterator[Finding]:
    """Compares the parts on disk with their SHA-256 in a checkpoint."""
    for table, digests in parts.items():
        for index, digest in enumerate(digests):
            path = part_path(folder, table, index)
            name = str(path.relative_to(folder))
            if not path.is_file():
                yield Finding(name, "is missing, but a checkpoint lists it")
            elif hashlib.sha256(path.read_bytes()).hexdigest() != digest:
                yield Finding(
                    name, "was changed after it was written: its SHA-256 differs from the one in the checkpoint"
                )


def check_numbering(folder: Path, table: str) -> Iterator[Finding]:
    """Names the parts that are missing between the first and the last."""
    paths = part_paths(folder, table)
    expected = [part_path(folder, table, index) for index in range(len(paths))]
    if paths != expected:
        missing = next(path for path in expected if path not in paths)
        yield Finding(str(missing.relative_to(folder)), "is missing, though later parts are there")


def read_parts(folder: Path, table: Table) -> Iterator[tuple[str, pl.DataFrame | None, list[Finding]]]:
    """Each part of a table, then the file of the living: its name, its rows (None if damaged), what is wrong."""
    paths = part_paths(folder, table.name)
    if table.name == "agents" and (folder / LIVING).exists():
        paths.append(folder / LIVING)
    for path in paths:
        name = str(path.relative_to(folder))
        try:
            rows = pl.read_parquet(path, glob=False)
        except (pl.exceptions.PolarsError, OSError) as error:
            yield name, None, [Finding(name, f"cannot be read: {str(error).splitlines()[0]}")]
            continue
        faults = list(_check_columns(name, rows, table))
        if not faults:
            faults = list(_check_numbers(name, rows, table))
            yield name, rows, faults
        else:
            yield name, None, faults


def _check_columns(name: str, rows: pl.DataFrame, table: Table) -> Iterator[Finding]:
    schema = table.polars_schema
    missing = [column for column in schema if column not in rows.columns]
    unknown = [column for column in rows.columns if column not in schema]
    other = [column for column in schema if column in rows.columns and rows.schema[column] != schema[column]]
    for columns, what in (
        (missing, "these columns are missing"),
        (unknown, "has unknown columns"),
        (other, "these columns have a wrong type"),
    ):
        if columns:
            yield Finding(name, f"{what}: {', '.join(columns)}")


def _check_numbers(name: str, rows: pl.DataFrame, table: Table) -> Iterator[Finding]:
    """Values that are missing but must not be, or that are not finite."""
    for column in table.columns:
        values = rows[column.name]
        wrong = 0 if column.nullable else values.null_count()
        if column.dtype in ("f32", "f64"):
            wrong += int((~values.is_finite()).sum())
        if wrong:
            yield Finding(name, f"{wrong:,} values of {column.name} are missing or not finite")
