"""Where a sweep lives: a folder, or a place that fsspec reaches, such as `s3://bucket/sweep`.

Whatever is written is whole or not there: it is written under a passing name and then named.
"""

import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from hedon.record.atomic import write_atomically
from hedon.sweep.error import SweepError

PASSING = ".tmp-"
"""Part of the names of objects that are being written; no reader sees them."""


class Store(Protocol):
    """Named contents; names are relative paths with "/"."""

    @property
    def location(self) -> str:
        """Where it is, as the user gave it."""
        ...

    @property
    def folder(self) -> Path | None:
        """A folder of this machine, or shared by all that take part; None for an object store."""
        ...

    def write(self, name: str, content: bytes) -> None:
        """Writes a content, whole or not at all; the last one of several counts.

        Args:
            name: Parts of a path, with "/" between them.
            content: All of it.

        Raises:
            SweepError: It cannot be written.
        """
        ...

    def read(self, name: str) -> bytes | None:
        """A content, or None where there is none of this name."""
        ...

    def names(self, folder: str) -> list[str]:
        """The plain names directly within a folder, sorted."""
        ...

    def remove(self, name: str) -> None:
        """Removes a content, if it is there."""
        ...


class FolderStore:
    """A store in a folder; see `Store`."""

    def __init__(self, folder: Path) -> None:
        self.location = str(folder)
        self.folder = folder
        self._root = folder

    def write(self, name: str, content: bytes) -> None:
        """Writes a content; see `Store`.

        Args:
            name: Parts of a path below the folder.
            content: All of it.

        Raises:
            SweepError: It cannot be written.
        """
        path = self._root / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(path, lambda file: file.write(content))
        except OSError as error:
            raise SweepError(f"cannot write {path}: {error.strerror}") from error

    def read(self, name: str) -> bytes | None:
        """A content, or None; see `Store`.

        Raises:
            SweepError: It is there and cannot be read.
        """
        try:
            return (self._root / name).read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise SweepError(f"cannot read {self._root / name}: {error.strerror}") from error

    def names(self, folder: str) -> list[str]:
        """Plain names within a folder; see `Store`."""
        place = self._root / folder
        return sorted(path.name for path in place.glob("*") if not path.name.startswith(".")) if place.is_dir() else []

    def remove(self, name: str) -> None:
        """Removes a content; see `Store`."""
        (self._root / name).unlink(missing_ok=True)


class UrlStore:
    """A store behind a URL; see `Store`.

    An object store shows an object only when all of it has arrived, other file systems show a file as it grows. So
    contents get a passing name first; what a writer that was killed leaves there, nobody reads.

    Raises:
        SweepError: A package is missing, or the URL names no such file system.
    """

    def __init__(self, url: str) -> None:
        try:
            fsspec: Any = import_module("fsspec")
        except ImportError:
            raise SweepError(f'{url}: a URL needs the optional packages: pip install "hedon[remote]"') from None
        self.location, self.folder = url, None
        try:
            system, self._root = fsspec.url_to_fs(url)
        except (ImportError, ValueError) as error:
            raise SweepError(f"{url}: {error}") from error
        # Listings must not come from a cache: other machines write here too.
        system.use_listings_cache = False
        self._system: Any = system
        self._made: set[str] = set()

    def write(self, name: str, content: bytes) -> None:
        """Writes a content; see `Store`.

        Args:
            name: Parts of a path below the URL.
            content: All of it.

        Raises:
            SweepError: It cannot be written.
        """
        path = self._path(name)
        parent, _, last = path.rpartition("/")
        passing = f"{parent}/{PASSING}{secrets.token_hex(8)}-{last}"
        with self._asked(f"cannot write {name} to"):
            try:
                if parent not in self._made:
                    self._system.makedirs(parent, exist_ok=True)
                    self._made.add(parent)
                self._system.pipe_file(passing, content)
                self._system.mv(passing, path)
            except Exception:
                with suppress(Exception):
                    self._system.rm_file(passing)
                raise

    def read(self, name: str) -> bytes | None:
        """A content, or None; see `Store`."""
        with self._asked(f"cannot read {name} of"), suppress(FileNotFoundError):
            return self._system.cat_file(self._path(name))
        return None

    def names(self, folder: str) -> list[str]:
        """Plain names within a folder; see `Store`."""
        self._system.invalidate_cache()
        found: list[str] = []
        with self._asked(f"cannot list {folder} of"), suppress(FileNotFoundError):
            found = self._system.ls(self._path(folder), detail=False)
        names = (path.rstrip("/").rpartition("/")[2] for path in found)
        return sorted({name for name in names if name and not name.startswith(".")})

    def remove(self, name: str) -> None:
        """Removes a content; see `Store`."""
        with self._asked(f"cannot remove {name} of"), suppress(FileNotFoundError):
            self._system.rm_file(self._path(name))

    @contextmanager
    def _asked(self, what: str) -> Iterator[None]:
        """Gives the errors of the system's own library, which may be of any kind, in one line."""
        try:
            yield
        except Exception as error:
            raise SweepError(f"{what} {self.location}: {type(error).__name__}: {error}") from error

    def _path(self, name: str) -> str:
        return f"{self._root.rstrip('/')}/{name}"


def open_store(location: str) -> Store:
    """The store at a folder's path or a URL; nothing is made there yet.

    Raises:
        SweepError: a URL whose kind needs a package that is not installed, or that is unknown.
    """
    return UrlStore(location) if "://" in location else FolderStore(Path(location))
