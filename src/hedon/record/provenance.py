"""How and where a run was made: versions, machine, source, command line."""

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

    Use: `Manifest(..., **collect_provenance())`.
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
    r"""An argument or a file's name as valid Unicode text; bytes that are not UTF-8 become escapes such as \udcff."""
    return text.encode("utf-8", "backslashreplace").decode()


def utc_now() -> str:
    """The time now, ISO 8601, UTC, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def usable_cpus() -> int:
    """The number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def git_revision(folder: Path) -> tuple[str | None, bool | None]:
    """Revision of hedon's own checkout around a folder, and whether its tracked files differ from it.

    Returns:
        (None, None) if the folder is not in a checkout, if the checkout does not track it (hedon is
        installed in an environment inside another project), or if there is no git.
    """
    if _git(folder, "ls-files", ".") in (None, ""):
        return None, None
    revision = _git(folder, "rev-parse", "HEAD")
    changes = _git(folder, "status", "--porcelain", "--untracked-files=no")
    return revision, None if changes is None else bool(changes)


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        answer = subprocess.run(("git", *arguments), cwd=folder, capture_output=True, text=True, timeout=10, check=True)
    except (OSError, subprocess.SubprocessError):
        return None
    return answer.stdout.strip()


def _hedon_version() -> str | None:
    try:
        return version("hedon")
    except PackageNotFoundError:
        return None
