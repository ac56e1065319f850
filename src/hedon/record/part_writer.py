"""Gathers rows in memory and writes them as Parquet parts. It knows no thread: `writer` runs it in one."""

import hashlib
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import monotonic

import polars as pl

from hedon.record.atomic import write_atomically
from hedon.record.column import Table
from hedon.record.folder import LIVING, part_path

# A part costs some 10 kB for its footer and an open file for each reader. So parts come less often as a run
# grows older: at most every half percent of its time so far, some hundreds of parts for a run of many hours.
INTERVAL_GROWTH = 0.005


class PartWriter:
    """Buffers of all tables, and when and how they are written.

    Attributes:
        flush_seconds: the shortest time between two flushes, but for full parts [s].
        part_rows: rows of one table that are written as a part without waiting for the time.
        parts: SHA-256 of each part on disk, in order, by table.

    Args:
        parts: those that are there already, where a run goes on.
    """

    def __init__(
        self,
        folder: Path,
        tables: dict[str, Table],
        part_rows: int,
        flush_seconds: float,
        parts: Mapping[str, Sequence[str]] | None = None,
    ) -> None:
        self.folder = folder
        self.tables = tables
        self.part_rows = part_rows
        self.flush_seconds = flush_seconds
        self._waiting: dict[str, list[pl.DataFrame]] = {name: [] for name in tables}
        self._rows = dict.fromkeys(tables, 0)
        self.parts = {name: list((parts or {}).get(name, ())) for name in tables}
        self._living: pl.DataFrame | None = None
        self._started = self._flushed = monotonic()

    def append(self, table: str, rows: pl.DataFrame) -> None:
        """Keeps rows; writes a part if they are enough."""
        self._waiting[table].append(rows)
        self._rows[table] += rows.height
        if self._rows[table] >= self.part_rows:
            self._write_part(table)

    def replace_living(self, rows: pl.DataFrame) -> None:
        """Keeps the living agents for the next flush, instead of those kept before."""
        self._living = rows

    def seconds_to_flush(self) -> float:
        """How long the rows may still wait [s]; 0 or less when they are due."""
        interval = max(self.flush_seconds, INTERVAL_GROWTH * (self._flushed - self._started))
        return self._flushed + interval - monotonic()

    def flush(self) -> None:
        """Writes all that waits: first the dead, then the living, so that no agent is missing in between."""
        self._flushed = monotonic()
        for table in self.tables:
            self._write_part(table)
        if self._living is not None:
            living = self._living
            write_atomically(self.folder / LIVING, lambda file: living.write_parquet(file, compression="zstd"))
            self._living = None

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
