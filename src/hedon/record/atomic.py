"""Writes files atomically."""

import errno
import os
import secrets
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

_NO_UNNAMED = (errno.EOPNOTSUPP, errno.EISDIR, errno.EINVAL)
"""Errors of file systems that do not support files without a name."""
_OWN = "/proc/self/fd"
_BUSY_SECONDS = 2.0 if os.name == "nt" else 0.0
"""Longest wait to replace a file that others are reading, or to read one that is being replaced; Windows refuses both
in the meantime [s]."""


def write_atomically(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Writes a file so that a reader sees the old content or the new, never a mix, even after a crash.

    If the file system allows it, the file has no name while it is written, so a process that is killed leaves nothing
    behind. Several processes may write the same file; the last content remains.

    Args:
        path: Path of the file.
        write: Writes the content to an open file.

    Raises:
        OSError: The file system raised it; `path` is then unchanged, and no other file is left.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}-{secrets.token_hex(4)}.tmp")
    try:
        with os.fdopen(_create(temporary), "w+b") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
            if not temporary.exists():
                _give_name(file.fileno(), temporary)
        _patiently(lambda: temporary.replace(path))
    except BaseException:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise
    _sync_folder(path.parent)


def _create(temporary: Path) -> int:
    """Opens a new file: without a name if possible, otherwise with this name."""
    if hasattr(os, "O_TMPFILE") and os.path.isdir(_OWN):
        try:
            return os.open(temporary.parent, os.O_TMPFILE | os.O_RDWR, 0o666)
        except OSError as error:
            if error.errno not in _NO_UNNAMED:
                raise
    return os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o666)


def _give_name(descriptor: int, path: Path) -> None:
    folder = os.open(path.parent, os.O_RDONLY)
    try:  # Python asks the system to follow the link in /proc only if given a folder's descriptor
        os.link(f"{_OWN}/{descriptor}", path.name, src_dir_fd=folder, dst_dir_fd=folder, follow_symlinks=True)
    finally:
        os.close(folder)


def read_whole(path: Path) -> bytes:
    """Reads the whole content of a file that `write_atomically` may replace at any time.

    Raises:
        OSError: The file cannot be read.
    """
    return _patiently(path.read_bytes)


def _patiently(call: Callable[[], Any]) -> Any:
    deadline = time.monotonic() + _BUSY_SECONDS
    while True:
        try:
            return call()
        except PermissionError:
            if time.monotonic() >= deadline:
                raise
            time.sleep(0.02)


def _sync_folder(folder: Path) -> None:
    if os.name != "posix":  # other systems cannot open folders
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
