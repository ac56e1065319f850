"""Locks on folders. The operating system releases a lock when its process ends, in whatever way it ends."""

import errno
import fcntl
import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType

from hedon.record.error import InUseError, RecordError
from hedon.record.folder import LOCK, require_plain, require_unicode

_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)
"""Errors of file systems without locks: there, only the user can prevent two runs in one folder."""


class FolderLock:
    """Locks a run's folder for this process. Use it as a context manager.

    The lock is advisory (`flock`) and ends with its process. The lock file stays and says which process had it last.

    Args:
        folder: made if it does not exist.

    Raises:
        InUseError: another process has the lock.
        RecordError: the folder cannot be written or holds a symbolic link, or its name is not UTF-8.
    """

    def __init__(self, folder: Path) -> None:
        require_unicode(folder)
        require_plain(folder)
        path = folder / LOCK
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
        except OSError as error:
            raise RecordError(f"cannot write the run's folder {folder}: {error}") from error
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _write_owner(self._descriptor)
        except BlockingIOError:
            owner = _read_owner(self._descriptor)
            os.close(self._descriptor)
            raise InUseError(folder, owner) from None
        except OSError as error:
            if error.errno not in _NO_LOCKS:
                os.close(self._descriptor)
                raise RecordError(f"cannot write the run's folder {folder}: {error}") from error

    def __enter__(self) -> "FolderLock":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._descriptor)


@contextmanager
def one_writer(folder: Path, what: str) -> Iterator[None]:
    """Makes a folder and lets one process at a time write into it; the others wait.

    The lock is on the folder itself, so that no file is left in it.

    Args:
        folder: made if it is missing.
        what: is written, for the message.

    Raises:
        RecordError: what is written within cannot be, for whatever reason the file system gives.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            with suppress(OSError):  # a file system without locks
                fcntl.flock(descriptor, fcntl.LOCK_EX)
            yield
        finally:
            os.close(descriptor)
    except OSError as error:
        raise RecordError(f"cannot write {what} into {folder}: {error}") from error


def _write_owner(descriptor: int) -> None:
    text = json.dumps({"host": socket.gethostname(), "process": os.getpid()})
    os.ftruncate(descriptor, 0)
    os.pwrite(descriptor, text.encode(), 0)


def _read_owner(descriptor: int) -> str:
    try:
        owner = json.loads(os.pread(descriptor, 1000, 0))
        return f" (process {int(owner['process'])} on {owner['host']})"
    except (OSError, ValueError, KeyError, TypeError):  # its owner has not written it yet
        return ""
