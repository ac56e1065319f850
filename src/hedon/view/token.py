"""The token in the link of the local server: random each time, or one per user that is kept for a port they chose."""

import os
import re
import secrets
import stat
from contextlib import suppress
from pathlib import Path

LENGTH = 24  # bytes
PATTERN = re.compile(rb"[A-Za-z0-9_-]{32}")


def fresh_token() -> str:
    """A random token, too long to guess."""
    return secrets.token_urlsafe(LENGTH)


def token_path() -> Path:
    """The file in the user's cache folder that keeps the token."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "hedon" / "view-token"


def kept_token() -> str:
    """The token of this user, so that links to a chosen port survive a restart.

    Only its owner can read the file. A file that others could have read or written is replaced, which ends old links;
    without a cache folder the token is a fresh one. Windows has no mode bits: there, the user's folder is private.
    """
    with suppress(OSError, RuntimeError):  # no home, or no place to write
        path = token_path()
        return _read(path) or _write(path)
    return fresh_token()


def _read(path: Path) -> str | None:
    """The token in a file, if the file is private to this user."""
    try:
        file = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0))
    except OSError:
        return None
    with os.fdopen(file, "rb") as stream:
        status = os.fstat(stream.fileno())
        private = os.name == "nt" or (status.st_uid == os.getuid() and not status.st_mode & 0o077)
        if not stat.S_ISREG(status.st_mode) or not private:
            return None
        content = stream.read(LENGTH * 2)
    return content.decode() if PATTERN.fullmatch(content) else None


def _write(path: Path) -> str:
    """Puts a fresh token into a file that only this user can read, in place of one that is there."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    token = fresh_token()
    temporary = path.with_name(f"{path.name}.{secrets.token_hex(8)}")
    file = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(file, "wb") as stream:
        stream.write(token.encode())
    temporary.replace(path)
    return token
