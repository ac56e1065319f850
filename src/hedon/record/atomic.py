"""Files that are either whole or not there."""

import errno
import os
import secrets
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

_NO_UNNAMED = (errno.EOPNOTSUPP, errno.EISDIR, errno.EINVAL)
"""What file systems answer that have no files without a name."""
_OWN = "/proc/self/fd"


def write_atomically(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Writes a file so that a reader, or a crash, finds the old content or the new, never a mix.

    While it is written the file has no name, where the file system allows for that: a process that is killed leaves
    nothing behind. Several processes may write the same file; the last one's content stays.

    Args:
        path: the file; its folder must exist. Replaced where it exists.
        write: is given the open binary file to fill.

    Raises:
        OSError: as the file system raises it; `path` is then as before, and nothing is left beside it.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}-{secrets.token_hex(4)}.tmp")
    try:
        with os.fdopen(_create(temporary), "w+b") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
            if not temporary.exists():
                _give_name(file.fileno(), temporary)
        temporary.replace(path)
    except BaseException:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise
    _sync_folder(path.parent)


def _create(temporary: Path) -> int:
    """Opens a new file: without a name, or else under this one."""
    if hasattr(os, "O_TMPFILE") and os.path.isdir(_OWN):
        try:
            return os.open(temporary.parent, os.O_TMPFILE | os.O_RDWR, 0o666)
        except OSError as error:
            if error.errno not in _NO_UNNAMED:
                raise
    return os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_RDWR, 0o666)


def _give_name(descriptor: int, path: Path) -> None:
    folder = os.open(path.parent, os.O_RDONLY)
    try:  # only with a folder's descriptor does Python ask the system to follow the link in /proc
        os.link(f"{_OWN}/{descriptor}", path.name, src_dir_fd=folder, dst_dir_fd=folder, follow_symlinks=True)
    finally:
        os.close(folder)


def _sync_folder(folder: Path) -> None:
    if os.name != "posix":  # elsewhere a folder cannot be opened to be synced
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
