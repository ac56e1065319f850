"""The provenance of a run: versions, machine, source and command line."""

import os
import platform
import subprocess
import sys
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any


def collect_provenance() -> dict[str, Any]:
    """The fields of a manifest that describe this process, machine and source, and `started`.

    Example: `Manifest(..., **collect_provenance())`.
    """
    revision, modified = git_revision(Path(__file__).resolve().parent)
    return {
        "hedon_version": _hedon_version(),
        "python": platform.python_version(),
        "platform": platform.platform(),
        "cpu_count": usable_cpus(),
        "git_revision": revision,
        "git_modified": modified,
        "command_line": tuple(map(to_unicode, (Path(sys.argv[0]).name, *sys.argv[1:]))),
        "started": utc_now(),
    }


def to_unicode(text: str) -> str:
    r"""Converts an argument or a file name to valid Unicode; bytes that are not UTF-8 become escapes such as \udcff."""
    return text.encode("utf-8", "backslashreplace").decode()


def utc_now() -> str:
    """The current time in UTC, to the second, in ISO 8601 format."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def usable_cpus() -> int:
    """The number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def git_revision(folder: Path) -> tuple[str | None, bool | None]:
    """The revision of hedon's own checkout around a folder, and whether tracked files differ from it.

    Returns:
        The two values, or (None, None) if the folder is not in a checkout, if the checkout does not track it (hedon is
        installed in an environment inside another project), or if git is missing.
    """
    if _git(folder, "ls-files", ".") in (None, ""):
        return None, None
    revision = _git(folder, "rev-parse", "HEAD")
    changes = _git(folder, "status", "--porcelain", "--untracked-files=no")
    return revision, None if changes is None else bool(changes)


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        process = subprocess.run(
            ("git", *arguments), cwd=folder, capture_output=True, text=True, timeout=10, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return process.stdout.strip()


def _hedon_version() -> str | None:
    try:
        return version("hedon")
    except PackageNotFoundError:
        return None
