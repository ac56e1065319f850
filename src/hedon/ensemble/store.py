"""Storage for results: a folder, or a place that fsspec can reach, such as `s3://bucket/sweep`.

Writes are atomic: content is written under a temporary name and then renamed.
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
"""Number of contents read at a time."""
TRIES = 4
"""Attempts to read a content that arrives incomplete: connections break, and some stores cut off replaced objects."""
PAUSE = 0.1
"""Time between two attempts [s]."""
PASSING = ".tmp-"
"""Prefix of the names of objects that are being written, which readers ignore."""
_TORN = (("aiohttp", "ClientPayloadError"), ("botocore.exceptions", "FlexibleChecksumError"))
"""Libraries, and the error that each raises if a content does not arrive in one piece."""


class Store:
    """Named contents; names are relative paths with "/".

    An object store shows an object only once it is complete, but other file systems show a file as it grows. Contents
    therefore get a temporary name first, and readers ignore what a killed writer leaves under such a name. In a folder
    on this machine, contents reach the disk before they are renamed.

    Args:
        location: Path of a folder, or a URL. Nothing is created there yet.

    Attributes:
        location: The path or URL, as given.
        folder: The folder, on this machine or shared by all machines that take part; None for a URL.

    Raises:
        EnsembleError: The URL's scheme is unknown, or needs a package that is not installed.
    """

    def __init__(self, location: str) -> None:
        fsspec: Any = import_module("fsspec")
        self.location = location
        self.folder = None if "://" in location else Path(location)
        try:
            # A path may contain characters with a meaning in URLs.
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
        # Listings must not come from a cache, since other machines write here too.
        self._system.use_listings_cache = False
        self._created: set[str] = set()

    def write(self, name: str, content: bytes) -> None:
        """Writes a content atomically, replacing an earlier one.

        Args:
            name: Relative path, with "/".
            content: The bytes to write.

        Raises:
            EnsembleError: It cannot be written.
        """
        path = self._path(name)
        parent, _, file_name = path.rpartition("/")
        with self._requesting(f"cannot write {name} to"):
            if parent not in self._created:
                self._system.makedirs(parent, exist_ok=True)
                self._created.add(parent)
            if self.folder is not None:
                write_atomically(Path(path), lambda file: file.write(content))
                return
            temporary = f"{parent}/{PASSING}{secrets.token_hex(8)}-{file_name}"
            try:
                self._system.pipe_file(temporary, content)
                self._system.mv(temporary, path)
            except Exception:
                with suppress(Exception):
                    self._system.rm_file(temporary)
                raise

    def read(self, name: str) -> bytes | None:
        """Reads a content; None if there is none with this name. Raises EnsembleError if it cannot be read."""
        with self._requesting(f"cannot read {name} of"), suppress(FileNotFoundError, NotADirectoryError):
            for tries_left in reversed(range(TRIES)):
                try:
                    return self._system.cat_file(self._path(name))
                except Exception as error:
                    if tries_left == 0 or not _is_torn(error):
                        raise
                    time.sleep(PAUSE)
        return None

    def read_all(self, names: Sequence[str]) -> list[bytes | None]:
        """Reads several contents, in this order, `READERS` at a time, since each request takes a while.

        Raises:
            EnsembleError: One of them cannot be read.
        """
        with ThreadPoolExecutor(READERS) as pool:
            return list(pool.map(self.read, names))

    def names(self, folder: str) -> list[str]:
        """The sorted names of the entries of a folder. Raises EnsembleError if they cannot be listed."""
        self._system.invalidate_cache()
        entries: list[str] = []
        with self._requesting(f"cannot list {folder} of"), suppress(FileNotFoundError, NotADirectoryError):
            entries = self._system.ls(self._path(folder), detail=False)
        names = (path.rstrip("/").rpartition("/")[2] for path in entries)
        return sorted({name for name in names if name and not name.startswith(".")})

    def remove(self, name: str) -> None:
        """Removes a content, if it exists. Raises EnsembleError if it cannot be removed."""
        with self._requesting(f"cannot remove {name} of"), suppress(FileNotFoundError, NotADirectoryError):
            self._system.rm_file(self._path(name))

    @contextmanager
    def _requesting(self, action: str) -> Iterator[None]:
        """Converts any error of the file system's library to an EnsembleError with a one-line message."""
        try:
            yield
        except Exception as error:
            reason = error.strerror if self.folder is not None and isinstance(error, OSError) else None
            raise EnsembleError(f"{action} {self.location}: {reason or f'{type(error).__name__}: {error}'}") from error

    def _path(self, name: str) -> str:
        return f"{self._root.rstrip('/')}/{name}"


def _is_torn(error: Exception) -> bool:
    """Whether the error means that a content arrived incomplete or mixed with another one."""
    return any(isinstance(error, getattr(sys.modules.get(name), kind, ())) for name, kind in _TORN)
