"""Where results live: a folder, or a place that fsspec reaches, such as `s3://bucket/sweep`.

Whatever is written is whole or not there: it is written under a passing name and then named.
"""

import secrets
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from hedon.ensemble.error import EnsembleError
from hedon.record.atomic import write_atomically

READERS = 32
"""Contents that are read at a time."""
TRIES = 4
"""To read a content of which a part arrives: connections break, and some stores cut off what is replaced meanwhile."""
PAUSE = 0.1
"""Between two tries [s]."""
PASSING = ".tmp-"
"""Part of the names of objects that are being written; no reader sees them."""
_TORN = (("aiohttp", "ClientPayloadError"), ("botocore.exceptions", "FlexibleChecksumError"))
"""Libraries, and what each raises where not one whole content arrives."""


class Store:
    """Named contents; names are relative paths with "/".

    An object store shows an object only when all of it has arrived, other file systems show a file as it grows. So
    contents get a passing name first; what a writer that was killed leaves there, nobody reads. In a folder of this
    machine they reach the disk before they are named.

    Args:
        location: Path of a folder, or a URL; nothing is made there yet.

    Attributes:
        location: As it was given.
        folder: On this machine, or shared by all that take part; None for a URL.

    Raises:
        EnsembleError: A URL whose kind needs a package that is not installed, or that is unknown.
    """

    def __init__(self, location: str) -> None:
        fsspec: Any = import_module("fsspec")
        self.location = location
        self.folder = None if "://" in location else Path(location)
        try:
            # A path may hold what means something in a URL.
            self._system, self._root = (
                fsspec.url_to_fs(location)
                if self.folder is None
                else (
                    fsspec.filesystem("file"),
                    str(self.folder.absolute()),
                )
            )
        except ImportError as error:
            raise EnsembleError(f'{location}: {error}: pip install "hedon[remote]"') from error
        except ValueError as error:
            raise EnsembleError(f"{location}: {error}") from error
        # Listings must not come from a cache: other machines write here too.
        self._system.use_listings_cache = False
        self._made: set[str] = set()

    def write(self, name: str, content: bytes) -> None:
        """Writes a content, whole or not at all; the last one of several counts.

        Raises:
            EnsembleError: It cannot be written.
        """
        path = self._path(name)
        parent, _, last = path.rpartition("/")
        with self._asked(f"cannot write {name} to"):
            if parent not in self._made:
                self._system.makedirs(parent, exist_ok=True)
                self._made.add(parent)
            if self.folder is not None:
                write_atomically(Path(path), lambda file: file.write(content))
                return
            passing = f"{parent}/{PASSING}{secrets.token_hex(8)}-{last}"
            try:
                self._system.pipe_file(passing, content)
                self._system.mv(passing, path)
            except Exception:
                with suppress(Exception):
                    self._system.rm_file(passing)
                raise

    def read(self, name: str) -> bytes | None:
        """A content, or None where there is none of this name. EnsembleError: it cannot be read."""
        with self._asked(f"cannot read {name} of"), suppress(FileNotFoundError, NotADirectoryError):
            for left in reversed(range(TRIES)):
                try:
                    return self._system.cat_file(self._path(name))
                except Exception as error:
                    if left == 0 or not _is_torn(error):
                        raise
                    time.sleep(PAUSE)
        return None

    def read_all(self, names: Sequence[str]) -> list[bytes | None]:
        """Several contents, in their order, `READERS` at a time: each answer of a store takes a while.

        Raises:
            EnsembleError: One cannot be read.
        """
        with ThreadPoolExecutor(READERS) as pool:
            return list(pool.map(self.read, names))

    def names(self, folder: str) -> list[str]:
        """The plain names directly within a folder, sorted. EnsembleError: they cannot be read."""
        self._system.invalidate_cache()
        found: list[str] = []
        with self._asked(f"cannot list {folder} of"), suppress(FileNotFoundError, NotADirectoryError):
            found = self._system.ls(self._path(folder), detail=False)
        names = (path.rstrip("/").rpartition("/")[2] for path in found)
        return sorted({name for name in names if name and not name.startswith(".")})

    def remove(self, name: str) -> None:
        """Removes a content, if it is there. EnsembleError: it cannot be removed."""
        with self._asked(f"cannot remove {name} of"), suppress(FileNotFoundError, NotADirectoryError):
            self._system.rm_file(self._path(name))

    @contextmanager
    def _asked(self, what: str) -> Iterator[None]:
        """Gives the errors of the system's own library, which may be of any kind, in one line."""
        try:
            yield
        except Exception as error:
            why = error.strerror if self.folder is not None and isinstance(error, OSError) else None
            raise EnsembleError(f"{what} {self.location}: {why or f'{type(error).__name__}: {error}'}") from error

    def _path(self, name: str) -> str:
        return f"{self._root.rstrip('/')}/{name}"


def _is_torn(error: Exception) -> bool:
    """Whether only a part of a content arrived, or parts of two, as the libraries say by which fsspec asks servers."""
    return any(isinstance(error, getattr(sys.modules.get(name), kind, ())) for name, kind in _TORN)
