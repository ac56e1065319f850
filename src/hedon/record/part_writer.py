"""Gathers rows in memory and writes them as Parquet parts. It knows no thread: `writer` runs it in one."""

import hashlib
import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import polars as pl

from hedon.record.atomic import write_atomically
from hedon.record.column import Table
from hedon.record.folder import LIVING, PARTS_BEFORE, part_path


class PartWriter:
    """Buffers of all tables, and when and how they are written.

    Attributes:
        part_rows: rows of one table that are written as a part at once.
        parts: SHA-256 of each part on disk, in order, by table.

    Args:
        parts: those that are there already, where a run goes on.
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
        """Keeps rows; writes a part if they are enough."""
        self._waiting[table].append(rows)
        self._rows[table] += rows.height
        if self._rows[table] >= self.part_rows:
            self._write_part(table)

    def replace_living(self, rows: pl.DataFrame) -> None:
        """Writes all that waits, then the living of this moment with the number of parts that hold the dead."""
        self.flush()
        metadata = {PARTS_BEFORE: str(len(self.parts["agents"]))}
        write_atomically(
            self.folder / LIVING, lambda file: rows.write_parquet(file, compression="zstd", metadata=metadata)
        )

    def flush(self) -> None:
        """Writes all that waits. Readers see these deaths once the living are written next."""
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
