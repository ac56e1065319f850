"""Collects rows in memory and writes them as Parquet parts. It uses no threads itself; `writer` runs it in one."""

import hashlib
import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import polars as pl

from hedon.record.atomic import write_atomically
from hedon.record.column import Table
from hedon.record.folder import LIVING, PARTS_BEFORE, part_path


class PartWriter:
    """The buffers of all tables; writes them to parts.

    Attributes:
        part_rows: number of rows of one table that make up a part.
        parts: SHA-256 of each part on disk, in order, by table.

    Args:
        parts: existing parts, if a run is resumed.
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
        """Adds rows to the buffer; writes a part if there are enough."""
        self._waiting[table].append(rows)
        self._rows[table] += rows.height
        if self._rows[table] >= self.part_rows:
            self._write_part(table)

    def replace_living(self, rows: pl.DataFrame) -> None:
        """Writes all buffers, then the living of this moment with the number of parts that hold the dead."""
        self.flush()
        metadata = {PARTS_BEFORE: str(len(self.parts["agents"]))}
        write_atomically(
            self.folder / LIVING, lambda file: rows.write_parquet(file, compression="zstd", metadata=metadata)
        )

    def flush(self) -> None:
        """Writes all buffers. Readers see these deaths after the living are written the next time."""
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
