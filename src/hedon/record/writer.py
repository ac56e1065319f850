"""Writes a run's folder while the engine computes; rows pass through a bounded queue to a thread."""

import queue
import threading
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import TracebackType

import polars as pl
from numpy.typing import ArrayLike

from hedon.record.atomic import write_atomically
from hedon.record.checkpoint import CheckpointHead, Fill, save_checkpoint, write_checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import CONFIG, FAULT, checkpoint_path, require_no_run
from hedon.record.manifest import Manifest, save_manifest
from hedon.record.part_writer import PartWriter
from hedon.record.rows import rows_to_frame
from hedon.record.schema import run_tables
from hedon.text import command_word

Rows = Mapping[str, ArrayLike]

PART_ROWS = 20_000
"""Default number of rows after which a part is written."""

_CLOSE = object()


class Writer:
    """Writes all files of a run's folder. Use it as a context manager.

    Rows are written by a thread. Checkpoints are written by the calling thread, directly from the worlds.

    The caller may reuse the arrays of rows as soon as a call returns. An error of
    the writing thread, such as a full disk, is raised as `RecordError` by the next call, at the latest by
    `close`; earlier records remain readable. If the caller computes faster than the disk writes, it
    waits, so no row is dropped.

    Args:
        folder: Folder of the run, created if necessary; must not contain a run, unless `parts` is given.
        config_text: The complete config, as TOML; not written for a resumed run, which has it already.
        manifest: Manifest of the run, which determines the columns of its tables.
        part_rows: Number of rows after which a part is written.
        queue_size: Number of calls that may wait for the thread.
        parts: For a resumed run, the SHA-256 of each existing part, in order, by table.
        beginning: Contents of the files with which a new run starts, except the config, by name.

    Raises:
        RecordError: The folder already contains a run, or cannot be written.
    """

    def __init__(
        self,
        folder: Path,
        config_text: str,
        manifest: Manifest,
        *,
        part_rows: int = PART_ROWS,
        queue_size: int = 64,
        parts: Mapping[str, Sequence[str]] | None = None,
        beginning: Mapping[str, bytes] | None = None,
    ) -> None:
        self.folder = Path(folder)
        self.tables = run_tables(manifest.columns)
        if parts is None:
            self._prepare(config_text, manifest, beginning or {})
        else:
            save_manifest(self.folder, manifest)
        self._parts = PartWriter(self.folder, self.tables, part_rows, parts)
        self._folders = {path: _identity(path) for path in (self.folder, *(self.folder / name for name in self.tables))}
        self._queue: queue.Queue = queue.Queue(queue_size)
        self._fault: Exception | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="hedon-record", daemon=True)
        self._thread.start()

    def append(self, table: str, *rows: Rows) -> None:
        """Appends rows to a table. A part never ends within one call, so pass all rows of a step in one call.

        Args:
            table: "agents", "population" or "frames".
            rows: Mappings, each with one array of shape (n,) per column of the schema; a scalar stands for n equal
                values. Missing values of nullable columns are −1 (integers) or NaN (floats).

        Raises:
            RecordError: The rows do not fit the schema, an earlier write failed, or the writer is closed.
        """
        if table not in self.tables:
            raise RecordError(f"no table {table!r}: there are {', '.join(self.tables)}")
        self._put((table, self._frame(table, rows)))

    def replace_living(self, *rows: Rows) -> None:
        """Writes all rows so far, then replaces the rows of the living agents of all worlds.

        Readers see the run as of the last such call, so call it regularly.

        Raises:
            RecordError: As for `append`.
        """
        self._put(("living", self._frame("agents", rows)))

    def save_checkpoint(self, head: CheckpointHead, fill: Fill) -> None:
        """Saves a checkpoint once all rows so far are on disk.

        Args:
            head: Data of the checkpoint; the digests of the parts are added here.
            fill: Writes the arrays.

        Raises:
            RecordError: As for `append`.
        """
        self.flush()
        self.require_folder()
        parts = {table: tuple(digests) for table, digests in self._parts.parts.items()}
        try:
            save_checkpoint(self.folder, replace(head, parts=parts), fill)
        except OSError as error:
            self._fault = self._cause(error)
            self._raise_fault()

    def save_fault(self, head: CheckpointHead, fill: Fill) -> None:
        """Saves the state of a run that stopped at a fault, in a separate folder, once all rows are on disk.

        Args:
            head: Data of the checkpoint; the digests of the parts are added here.
            fill: Writes the arrays.

        Raises:
            RecordError: As for `append`.
        """
        self.flush()
        path = checkpoint_path(self.folder, head.step, FAULT)
        try:
            write_checkpoint(path, head, fill)
        except OSError as error:
            raise RecordError(f"cannot write {path}: {error}") from error

    def save_manifest(self, manifest: Manifest) -> None:
        """Replaces the manifest immediately.

        Raises:
            RecordError: It cannot be written.
        """
        self.require_folder()
        try:
            save_manifest(self.folder, manifest)
        except RecordError as error:
            raise self._cause(error) from error

    def flush(self) -> None:
        """Waits until all rows so far are on disk.

        Raises:
            RecordError: As for `append`.
        """
        done = threading.Event()
        self._put(done)
        done.wait()
        self._raise_fault()

    def close(self) -> None:
        """Writes all remaining rows and ends the thread. A second call does nothing.

        Raises:
            RecordError: A write failed.
        """
        if self._closed:
            return
        self._closed = True
        self._queue.put(_CLOSE)
        self._thread.join()
        self._raise_fault()

    def __enter__(self) -> "Writer":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            self.close()
        except RecordError:
            if not isinstance(error, RecordError):  # otherwise the same error is already being raised
                raise

    def _prepare(self, config_text: str, manifest: Manifest, initial_files: Mapping[str, bytes]) -> None:
        require_no_run(self.folder)
        try:
            for table in self.tables:
                (self.folder / table).mkdir(parents=True, exist_ok=True)
            for name, content in initial_files.items():
                write_atomically(self.folder / name, lambda file, content=content: file.write(content))
            write_atomically(self.folder / CONFIG, lambda file: file.write(config_text.encode()))
        except OSError as error:
            raise RecordError(f"cannot write the run's folder {self.folder}: {error}") from error
        save_manifest(self.folder, manifest)

    def _frame(self, table: str, rows: Sequence[Rows]) -> pl.DataFrame:
        schema = self.tables[table]
        empty = pl.DataFrame(schema=schema.polars_schema)
        return pl.concat([empty, *(rows_to_frame(schema, block) for block in rows)])

    def _put(self, item: object) -> None:
        self._raise_fault()
        if self._closed:
            raise RecordError(f"the writer of {self.folder} is closed")
        self._queue.put(item)

    def require_folder(self) -> None:
        """Checks immediately that the folder still exists, instead of failing at the next write.

        Raises:
            RecordError: The folder, or that of a table, was removed or replaced.
        """
        for path, identity in self._folders.items():
            if _identity(path) != identity:
                raise RecordError(f"{path} was removed or replaced during the run: the run ends here")

    def _raise_fault(self) -> None:
        if isinstance(self._fault, RecordError):
            raise self._fault
        if self._fault is not None:
            raise RecordError(
                f"cannot write records to {self.folder}: {self._fault}; what was written before is readable. "
                f"After the cause is removed, continue with: hedon resume {command_word(str(self.folder))}"
            ) from self._fault

    def _work(self) -> None:
        """Runs in the thread: takes items until closed, even after an error, so that no caller waits forever."""
        item = None
        while item is not _CLOSE:
            item = self._queue.get()
            if self._fault is None:
                try:
                    self._handle(item)
                except Exception as error:  # _raise_fault raises it in the caller
                    self._fault = self._cause(error)
            if isinstance(item, threading.Event):
                item.set()

    def _cause(self, error: Exception) -> Exception:
        """The error itself, or that the folder is gone, if it vanished between the check and the write."""
        try:
            self.require_folder()
        except RecordError as gone:
            return gone
        return error

    def _handle(self, item: object) -> None:
        self.require_folder()
        if isinstance(item, tuple):
            table, rows = item
            if table == "living":
                self._parts.replace_living(rows)
            else:
                self._parts.append(table, rows)
        if item is _CLOSE or isinstance(item, threading.Event):
            self._parts.flush()


def _identity(path: Path) -> tuple[int, int] | None:
    """The file system's identity of a folder; None if the folder does not exist."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino
