"""Collects rows in memory and writes them as Parquet parts; `writer` runs it in a thread."""

import hashlib
import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import polars as pl

from hedon.record.atomic import write_atomically
from hedon.record.column import Table
from hedon.record.folder import LIVING, PARTS_BEFORE, part_path


class PartWriter:
    """Buffers the rows of all tables and writes them to parts.

    Attributes:
        part_rows: Number of rows of one table in a part.
        parts: SHA-256 of each part on disk, in order, by table.

    Args:
        folder: Folder of the run.
        tables: Tables to write, by name.
        part_rows: Number of rows of one table in a part.
        parts: SHA-256 of each existing part, in order, by table, if a run is resumed.
    """

    def __init__(
        self,
        folder: Path,
        tables: dict[str, Table],
        part_rows: int,
        parts: Mapping[str, Sequence[str]] | None = None,
    ) -> None:
        self.folder = folder
        self.tables = tables
        self.part_rows = part_rows
        self._waiting: dict[str, list[pl.DataFrame]] = {name: [] for name in tables}
        self._rows = dict.fromkeys(tables, 0)
        self.parts = {name: list((parts or {}).get(name, ())) for name in tables}

    def append(self, table: str, rows: pl.DataFrame) -> None:
        """Adds rows to the buffer of a table, and writes a part if there are enough rows."""
        self._waiting[table].append(rows)
        self._rows[table] += rows.height
        if self._rows[table] >= self.part_rows:
            self._write_part(table)

    def replace_living(self, rows: pl.DataFrame) -> None:
        """Writes all buffers, then the agents now alive with the number of parts that contain the dead."""
        self.flush()
        metadata = {PARTS_BEFORE: str(len(self.parts["agents"]))}
        write_atomically(
            self.folder / LIVING, lambda file: rows.write_parquet(file, compression="zstd", metadata=metadata)
        )

    def flush(self) -> None:
        """Writes all buffers. Readers do not see these deaths until the living are written again."""
        for table in self.tables:
            self._write_part(table)

    def _write_part(self, table: str) -> None:
        if self._rows[table] == 0:
            return
        data = io.BytesIO()
        pl.concat(self._waiting[table]).write_parquet(data, compression="zstd")
        path = part_path(self.folder, table, len(self.parts[table]))
        write_atomically(path, lambda file: file.write(data.getbuffer()))
        self.parts[table].append(hashlib.sha256(data.getbuffer()).hexdigest())
        self._waiting[table].clear()
        self._rows[table] = 0
