"""Rolls a run's records back to a checkpoint, so that the run continues without missing or repeated rows."""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from hedon.record.checkpoint import Checkpoint, load_checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import (
    CHECKPOINTS,
    FAULT,
    TABLE_FOLDERS,
    checkpoint_path,
    checkpoint_paths,
    misplaced_checkpoints,
    part_path,
    part_paths,
)
from hedon.text import command_word


def find_checkpoint(folder: Path, step: int | None = None) -> tuple[Checkpoint | None, list[str]]:
    """The newest undamaged checkpoint of a run, or the one at a given step.

    Args:
        folder: Folder of the run.
        step: Step of the checkpoint [step]; None for the newest.

    Returns:
        The checkpoint, or None for a run that was killed before its first; and messages about damaged checkpoints.

    Raises:
        RecordError: There is no checkpoint at that step, all are damaged, or they were removed.
    """
    paths = checkpoint_paths(folder)
    if step is not None:
        path = checkpoint_path(folder, step)
        if path not in paths:
            saved_steps = ", ".join(str(int(path.stem.removeprefix("step-"))) for path in paths)
            raise RecordError(
                f"{folder} has no checkpoint of step {step}; it has those of steps {saved_steps or 'none'}"
            )
        return load_checkpoint(path), []
    faults = [f"{path} is a folder, but should be a checkpoint" for path in misplaced_checkpoints(folder)]
    for path in reversed(paths):
        try:
            return load_checkpoint(path), faults
        except RecordError as error:
            faults.append(str(error))
    if faults:
        raise RecordError(f"{folder} has no undamaged checkpoint: {'; '.join(faults)}")
    if any(part_paths(folder, table) for table in TABLE_FOLDERS):
        raise RecordError(f"{folder} has records but no checkpoint to continue from: {folder / CHECKPOINTS} is empty")
    return None, []


def verify_parts(folder: Path, parts: Mapping[str, Sequence[str]]) -> None:
    """Compares the parts on disk with the list in a checkpoint.

    Args:
        folder: Folder of the run.
        parts: SHA-256 of each part in the checkpoint, in order, by table.

    Raises:
        RecordError: A part is missing, or its content was changed.
    """
    for table, digests in parts.items():
        for index, digest in enumerate(digests):
            path = part_path(folder, table, index)
            try:
                matches = hashlib.sha256(path.read_bytes()).hexdigest() == digest
            except OSError as error:
                raise RecordError(f"damaged records: cannot read {path}: {error}{_remedy(folder)}") from error
            if not matches:
                raise RecordError(f"damaged records: {path} was changed after it was written{_remedy(folder)}")


def _remedy(folder: Path) -> str:
    return (
        "; restore the file from a copy, or continue in a new folder, whose records begin at the checkpoint: "
        f"hedon branch {command_word(str(folder))}"
    )


def roll_back(folder: Path, parts: Mapping[str, Sequence[str]], step: int) -> None:
    """Removes everything later than a checkpoint: parts, checkpoints, the state at a fault, and incomplete files.

    Args:
        folder: Folder of the run.
        parts: SHA-256 of each part in the checkpoint, in order, by table.
        step: Step of the checkpoint [step].

    Raises:
        RecordError: A file cannot be removed.
    """
    obsolete = [path for path in checkpoint_paths(folder) if path > checkpoint_path(folder, step)]
    obsolete += checkpoint_paths(folder, FAULT)
    for table in TABLE_FOLDERS:
        boundary = part_path(folder, table, len(parts.get(table, ())))
        obsolete += [path for path in part_paths(folder, table) if path >= boundary]
    for subfolder in (folder, *(folder / name for name in (*TABLE_FOLDERS, CHECKPOINTS, FAULT))):
        obsolete += subfolder.glob(".*.tmp")  # left by a killed run on a file system without unnamed files
    try:
        for path in reversed(obsolete):
            path.unlink(missing_ok=True)
    except OSError as error:
        raise RecordError(f"cannot return the records of {folder} to step {step}: {error}") from error
