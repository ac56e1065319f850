"""Checks that the parts of the tables are complete, readable and unchanged, and have the right columns."""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import polars as pl

from hedon.check.finding import Finding
from hedon.record.column import Table
from hedon.record.error import RecordError
from hedon.record.folder import LIVING, part_path, part_paths
from hedon.record.manifest import Manifest
from hedon.record.part import load_part, value_faults


def check_digests(folder: Path, parts: Mapping[str, Sequence[str]]) -> Iterator[Finding]:
    """Compares the parts on disk with their SHA-256 in a checkpoint.

    Args:
        folder: Folder of the run.
        parts: SHA-256 of each part in the checkpoint, in order, by table.
    """
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
    """Lists the parts that are missing between the first and the last."""
    paths = part_paths(folder, table)
    expected = [part_path(folder, table, index) for index in range(len(paths))]
    if paths != expected:
        missing = next(path for path in expected if path not in paths)
        yield Finding(str(missing.relative_to(folder)), "is missing, though later parts are there")


def read_parts(
    folder: Path, table: Table, manifest: Manifest | None
) -> Iterator[tuple[str, pl.DataFrame | None, list[Finding]]]:
    """Reads and checks each part of a table, then the file of the living.

    Args:
        folder: Folder of the run.
        table: The table to read.
        manifest: Manifest of the run; None if it cannot be read.

    Yields:
        The name of a file, its rows (None if damaged), and its faults.
    """
    paths = part_paths(folder, table.name)
    if table.name == "agents" and (folder / LIVING).exists():
        paths.append(folder / LIVING)
    for path in paths:
        name = str(path.relative_to(folder))
        try:
            rows = load_part(path)
        except RecordError as error:
            yield name, None, [Finding(name, f"cannot be read: {str(error).removeprefix(f'damaged part {path} ')}")]
            continue
        faults = list(_check_columns(name, rows, table))
        if faults:
            yield name, None, faults
        else:
            faults = [Finding(name, fault) for fault in value_faults(rows, table, manifest)]
            yield name, rows, faults


def _check_columns(name: str, rows: pl.DataFrame, table: Table) -> Iterator[Finding]:
    schema = table.polars_schema
    missing = [column for column in schema if column not in rows.columns]
    unknown = [column for column in rows.columns if column not in schema]
    mistyped = [column for column in schema if column in rows.columns and rows.schema[column] != schema[column]]
    for columns, message in (
        (missing, "these columns are missing"),
        (unknown, "has unknown columns"),
        (mistyped, "these columns have a wrong type"),
    ):
        if columns:
            yield Finding(name, f"{message}: {', '.join(columns)}")
