"""A digest of the records of a run: equal for equal rows, however they are divided into parts and sessions."""

import hashlib
from pathlib import Path

import numpy as np
import polars as pl

from hedon.record.column import Table
from hedon.record.folder import LIVING, part_paths
from hedon.record.part import load_part
from hedon.record.schema import Columns, run_tables

PARTS_AT_ONCE = 64
"""Number of parts in memory at a time, which take about 100 MB at most."""


def records_digest(folder: Path, columns: Columns) -> str:
    """The digest of all tables of a run: SHA-256, 64 hexadecimal digits.

    The digest depends on the order in which the rows of each world were written, which is the same in every repetition
    of a run. It does not depend on the order of rows of different worlds or on the boundaries of parts, which can
    differ between repetitions.

    Args:
        folder: Folder of the run.
        columns: Columns of its tables.

    Raises:
        RecordError: A part cannot be read.
    """
    digest = hashlib.sha256()
    for name, table in run_tables(columns).items():
        paths = part_paths(folder, name)
        if name == "agents" and (folder / LIVING).exists():
            paths.append(folder / LIVING)
        for world, rows in sorted(_digest_worlds(paths, table).items()):
            digest.update(f"{name} {world} {rows}\n".encode())
    return digest.hexdigest()


def _digest_worlds(paths: list[Path], table: Table) -> dict[int, str]:
    digests = {}
    for start in range(0, len(paths), PARTS_AT_ONCE):
        rows = pl.concat([load_part(path, table) for path in paths[start : start + PARTS_AT_ONCE]])
        data, worlds = _row_bytes(rows, table), rows["world"].to_numpy()
        for world in np.unique(worlds).tolist():
            digests.setdefault(world, hashlib.sha256()).update(np.ascontiguousarray(data[worlds == world]))
    return {world: digest.hexdigest() for world, digest in digests.items()}


def _row_bytes(rows: pl.DataFrame, table: Table) -> np.ndarray:
    """Each row as bytes, (rows, bytes): the column values, nullable ones after a byte that is 1 if missing."""
    columns = []
    for column in table.columns:
        series = rows[column.name]
        if column.nullable:
            columns.append(series.is_null().to_numpy().astype(np.uint8)[:, None])
            series = series.fill_null(0)
        if column.dtype == "string":
            codes = {text: int.from_bytes(hashlib.sha256(text.encode()).digest()[:8]) for text in series.unique()}
            series = series.replace_strict(codes, return_dtype=pl.UInt64)
        values = np.ascontiguousarray(series.to_numpy())
        columns.append(values.view(np.uint8).reshape(len(values), values.itemsize))
    return np.concatenate(columns, axis=1)
