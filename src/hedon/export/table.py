"""Exports whole tables of a run as one file."""

from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO, Literal

import polars as pl

from hedon.error import HedonError
from hedon.record.atomic import write_atomically
from hedon.record.reader import Run
from hedon.text import brief

TableName = Literal["agents", "population", "frames"]
TableFormat = Literal["csv", "parquet", "arrow"]


class ExportError(HedonError):
    """The data cannot be exported, or the file already exists."""


def table_of(run: Run, name: TableName) -> pl.LazyFrame:
    """A table of all worlds of a run.

    Args:
        run: The run.
        name: Name of the table.

    Raises:
        ExportError: The run has no frames.
        RecordError: A part of the table is damaged.
    """
    if name == "agents":
        return run.agents().lazy()
    if name == "population":
        return run.population().lazy()
    if not sum(rows.height for rows in run.frame_parts()):  # reads every part, so that errors name damaged ones
        raise ExportError(f"{run.path} has no frames: record them with `hedon run --frames 64`")
    return run.frames()


def write_table(table: pl.LazyFrame, file_format: TableFormat, out: Path) -> None:
    """Writes a table as one file, in pieces, so that it may be larger than memory.

    Args:
        table: The table.
        file_format: Format of the file.
        out: Path of the new file.

    Raises:
        ExportError: The file already exists, or cannot be written.
    """

    def write(file: BinaryIO) -> None:
        if file_format == "csv":
            table.sink_csv(file)
        elif file_format == "parquet":
            table.sink_parquet(file)
        else:
            table.sink_ipc(file)

    write_new(out, write)


def write_new(out: Path, write: Callable[[BinaryIO], object]) -> None:
    """Writes a new file atomically.

    Args:
        out: Path of the new file.
        write: Writes the content to an open file.

    Raises:
        ExportError: The file already exists, or cannot be written.
    """
    if out.exists() or out.is_symlink():
        raise ExportError(f"{brief(str(out))} is there already: choose another file with --out, or remove it")
    try:
        write_atomically(out, write)
    except (OSError, pl.exceptions.PolarsError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or brief(str(error))
        raise ExportError(f"cannot write {brief(str(out))}: {reason}") from error
