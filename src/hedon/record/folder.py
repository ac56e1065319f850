"""Where the files of a run lie."""

import os
import shlex
from pathlib import Path

from hedon.record.error import RecordError

CONFIG = "config.toml"
MANIFEST = "manifest.json"
SNAPSHOT = "final.npz"
SUMMARY = "summary.json"
FIGURES = "figures"
LIVING = "agents/living.parquet"
PARTS_BEFORE = "parts"
"""What the file of the living says of itself: how many parts hold those who died before it was written."""
CHECKPOINTS = "checkpoints"
FAULT = "fault"
LOCK = ".lock"
CHECKPOINT_SECONDS = 180.0
"""Time after which a run keeps a checkpoint, unless told otherwise [s]."""
TABLE_FOLDERS = ("agents", "population", "frames")


def require_unicode(folder: Path) -> None:
    """Refuses a folder whose name has bytes that are no UTF-8: tables could be written there, and never read.

    Raises:
        RecordError: it has.
    """
    try:
        str(folder).encode()
    except UnicodeEncodeError:
        name = str(folder).encode("utf-8", "backslashreplace").decode()
        raise RecordError(f"{name}: the name of a run's folder must be UTF-8: choose or give it another") from None


def require_plain(folder: Path) -> None:
    """Refuses a run's folder in which anything is neither a file nor a folder: a symbolic link leads out of it.

    The folder itself may be a link, and need not be there.

    Raises:
        RecordError: something is; the message names the first.
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
                            f"{entry.path} is {kind}: hedon follows no link inside a run's folder; put what it points "
                            "to in its place, or remove it"
                        )
        except OSError:  # not there, or not to be read: said by whoever reads or writes it
            continue


def holds_run(folder: Path) -> bool:
    """Whether a folder holds a run.

    The manifest comes last when a run begins: without one, empty tables are what a run left that was killed before it
    began, and hold nothing.
    """
    if (folder / MANIFEST).exists():
        return True
    tables = [folder / name for name in (*TABLE_FOLDERS, CHECKPOINTS) if (folder / name).exists()]
    begun = all((folder / name).is_dir() for name in TABLE_FOLDERS)
    kept = any(not path.is_dir() or any(path.iterdir()) for path in tables)
    return kept or ((folder / CONFIG).exists() and not begun)


def require_no_run(folder: Path) -> None:
    """Refuses a folder for a new run that holds one.

    Raises:
        RecordError: it does.
    """
    if holds_run(folder):
        raise RecordError(
            f"{folder} holds a run already: go on with it by `hedon resume {shlex.quote(str(folder))}`, "
            "choose another folder, or remove it first"
        )


def part_path(folder: Path, table: str, index: int) -> Path:
    """The path of one part of a table."""
    return folder / table / f"part-{index:06d}.parquet"


def part_paths(folder: Path, table: str) -> list[Path]:
    """The finished parts of a table, in the order in which they were written."""
    return sorted((folder / table).glob("part-*.parquet"))


def checkpoint_path(folder: Path, step: int) -> Path:
    """The path of the checkpoint that was taken after so many steps."""
    return folder / CHECKPOINTS / f"step-{step:010d}.npz"


def fault_path(folder: Path, step: int) -> Path:
    """The path of the checkpoint of a run that stopped at a fault after so many steps."""
    return folder / FAULT / f"step-{step:010d}.npz"


def fault_paths(folder: Path) -> list[Path]:
    """The checkpoint of a run that stopped at a fault, or nothing."""
    return sorted((folder / FAULT).glob("step-??????????.npz"))


def misplaced_checkpoints(folder: Path) -> list[Path]:
    """Folders where a checkpoint would stand: hedon makes none, and leaves them alone."""
    return sorted(path for path in (folder / CHECKPOINTS).glob("step-??????????.npz") if path.is_dir())


def checkpoint_paths(folder: Path) -> list[Path]:
    """The checkpoints of a run, by step."""
    return sorted(path for path in (folder / CHECKPOINTS).glob("step-??????????.npz") if path.is_file())
