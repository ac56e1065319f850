"""The paths of a run's files."""

import os
from pathlib import Path

from hedon.record.error import RecordError
from hedon.text import command_word

CONFIG = "config.toml"
MANIFEST = "manifest.json"
SNAPSHOT = "final.npz"
SUMMARY = "summary.json"
FIGURES = "figures"
LIVING = "agents/living.parquet"
PARTS_BEFORE = "parts"
"""Metadata key in the file of the living: the number of parts with agents that died before it was written."""
CHECKPOINTS = "checkpoints"
FAULT = "fault"
LOCK = ".lock"
CHECKPOINT_SECONDS = 180.0
"""Default time between two checkpoints of a run [s]."""
TABLE_FOLDERS = ("agents", "population", "frames")


def require_unicode(folder: Path) -> None:
    """Refuses a folder whose name is not UTF-8, since tables could be written there but not read.

    Raises:
        RecordError: The name is not UTF-8.
    """
    try:
        str(folder).encode()
    except UnicodeEncodeError:
        name = str(folder).encode("utf-8", "backslashreplace").decode()
        raise RecordError(f"{name}: the name of a run's folder must be UTF-8: use another name") from None


def require_plain(folder: Path) -> None:
    """Refuses a run's folder that contains anything but files and folders, since a symbolic link could lead out of it.

    The folder itself may be a link, and need not exist.

    Raises:
        RecordError: There is such an entry; the message names the first one.
    """
    places = [folder]
    while places:
        try:
            with os.scandir(places.pop()) as entries:
                for entry in sorted(entries, key=lambda entry: entry.name):
                    if entry.is_dir(follow_symlinks=False):
                        places.append(Path(entry.path))
                    elif not entry.is_file(follow_symlinks=False):
                        kind = "a symbolic link" if entry.is_symlink() else "neither a file nor a folder"
                        raise RecordError(
                            f"{entry.path} is {kind}: hedon follows no links inside a run's folder; replace it by a "
                            "copy of what it points to, or remove it"
                        )
        except OSError:  # missing or unreadable; reported by the code that reads or writes it
            continue


def holds_run(folder: Path) -> bool:
    """Whether a folder contains a run.

    When a run starts, its manifest is written last. Empty tables without a manifest come from a run that was killed
    before it started.
    """
    if (folder / MANIFEST).exists():
        return True
    tables = [folder / name for name in (*TABLE_FOLDERS, CHECKPOINTS) if (folder / name).exists()]
    has_folders = all((folder / name).is_dir() for name in TABLE_FOLDERS)
    has_parts = any(not path.is_dir() or any(path.iterdir()) for path in tables)
    return has_parts or ((folder / CONFIG).exists() and not has_folders)


def require_no_run(folder: Path) -> None:
    """Refuses a folder for a new run if it already contains one.

    Raises:
        RecordError: The folder contains a run.
    """
    if holds_run(folder):
        raise RecordError(
            f"{folder} already holds a run: choose another folder, remove it first, or continue what `hedon run` made "
            f"with `hedon resume {command_word(str(folder))}`"
        )


def part_path(folder: Path, table: str, index: int) -> Path:
    """The path of one part of a table."""
    return folder / table / f"part-{index:06d}.parquet"


def part_paths(folder: Path, table: str) -> list[Path]:
    """The finished parts of a table, in the order in which they were written."""
    return sorted((folder / table).glob("part-*.parquet"))


def checkpoint_path(folder: Path, step: int, place: str = CHECKPOINTS) -> Path:
    """The path of the checkpoint after this number of steps.

    Args:
        folder: Folder of the run.
        step: Steps completed [step].
        place: `CHECKPOINTS`, or `FAULT` for the state of a run that stopped at a fault.
    """
    return folder / place / f"step-{step:010d}.npz"


def misplaced_checkpoints(folder: Path) -> list[Path]:
    """Folders that have the name of a checkpoint. hedon neither creates nor changes such folders."""
    return sorted(path for path in (folder / CHECKPOINTS).glob("step-??????????.npz") if path.is_dir())


def checkpoint_paths(folder: Path, place: str = CHECKPOINTS) -> list[Path]:
    """The paths of a run's checkpoints, sorted by step."""
    return sorted(path for path in (folder / place).glob("step-??????????.npz") if path.is_file())
