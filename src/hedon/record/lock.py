"""Locks on folders. The operating system releases a lock when its process ends, however it ends."""

import errno
import hashlib
import json
import os
import socket
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType

from hedon.record.error import InUseError, RecordError
from hedon.record.folder import LOCK, require_plain, require_unicode

_NO_LINK = getattr(os, "O_NOFOLLOW", 0)
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)
"""Errors of file systems without locks, on which only the user can prevent two runs in one folder."""

if sys.platform == "win32":
    import msvcrt

    _BEYOND = 1 << 30
    """Position of the locked byte, far beyond the end of the file, since locked bytes cannot be read [byte]."""
    _LOOK_SECONDS = 0.05
    _TAKEN = (errno.EACCES, errno.EDEADLK, 0)
    """Errors for a byte that another process has locked; Wine gives 0."""

    def _take(descriptor: int, wait: bool) -> None:
        while True:
            os.lseek(descriptor, _BEYOND, os.SEEK_SET)
            try:
                msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
                return
            except OSError as error:
                if error.errno not in _TAKEN:
                    raise
                if not wait:
                    raise BlockingIOError from None
            time.sleep(_LOOK_SECONDS)

    def _open_writer(folder: Path) -> int:
        """Opens a file elsewhere that represents the folder, since Windows cannot open folders."""
        name = hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:32]
        return os.open(Path(tempfile.gettempdir()) / f"hedon-{name}.lock", os.O_RDWR | os.O_CREAT)

else:
    import fcntl

    def _take(descriptor: int, wait: bool) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))

    def _open_writer(folder: Path) -> int:
        return os.open(folder, os.O_RDONLY | os.O_DIRECTORY)


class FolderLock:
    """Locks a run's folder for this process. Use it as a context manager.

    The lock ends with its process and does not prevent reading. The lock file remains and names its last owner.

    Args:
        folder: The folder to lock, which is created if it does not exist.

    Raises:
        InUseError: Another process has the lock.
        RecordError: The folder cannot be written or contains a symbolic link, or its name is not UTF-8.
    """

    def __init__(self, folder: Path) -> None:
        require_unicode(folder)
        require_plain(folder)
        path = folder / LOCK
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._descriptor = os.open(path, os.O_RDWR | os.O_CREAT | _NO_LINK, 0o644)
        except OSError as error:
            raise RecordError(f"cannot write the run's folder {folder}: {error}") from error
        try:
            _take(self._descriptor, wait=False)
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
    """Creates a folder and lets one process at a time write to it; other processes wait.

    The lock leaves no file in the folder.

    Args:
        folder: The folder to write to.
        what: Name of the written content, for the error message.

    Raises:
        RecordError: The file system raised an error within the context.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        descriptor = _open_writer(folder)
        try:
            with suppress(OSError):  # a file system without locks
                _take(descriptor, wait=True)
            yield
        finally:
            os.close(descriptor)
    except OSError as error:
        raise RecordError(f"cannot write {what} into {folder}: {error}") from error


def _write_owner(descriptor: int) -> None:
    text = json.dumps({"host": socket.gethostname(), "process": os.getpid()})
    os.ftruncate(descriptor, 0)
    os.lseek(descriptor, 0, os.SEEK_SET)
    os.write(descriptor, text.encode())


def _read_owner(descriptor: int) -> str:
    try:
        os.lseek(descriptor, 0, os.SEEK_SET)
        owner = json.loads(os.read(descriptor, 1000))
        return f" (process {int(owner['process'])} on {owner['host']})"
    except (OSError, ValueError, KeyError, TypeError):  # the owner has not written its name yet
        return ""
