"""Checkpoints of a run: plain NumPy arrays without pickle, with a digest of their content. Loading executes no code."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from hedon.record.array_file import ArrayWriter, digest, read_arrays
from hedon.record.atomic import write_atomically
from hedon.record.error import RecordError
from hedon.record.folder import checkpoint_path, checkpoint_paths

if TYPE_CHECKING:
    from pydantic import TypeAdapter

KEPT = 2
"""Number of checkpoints that a run keeps: the newest, and one more in case the newest is damaged."""
# Members of the file that are not arrays of a world: JSON, and the SHA-256 of all other members.
_HEAD, _DIGEST = "head", "sha256"

Fill = Callable[[ArrayWriter], object]
"""Writes the arrays of all worlds, in the engine's shapes: "0/params" is the array `params` of world 0."""


@dataclass(frozen=True)
class Sampled:
    """The counters of a world at the last row of the table `population`, from which the next row counts."""

    step: int
    counters: dict[str, int | float]
    eaten: tuple[int, ...]


@dataclass(frozen=True)
class CheckpointHead:
    """The data of a checkpoint without the arrays of its worlds.

    Attributes:
        step: Steps completed [step].
        config: The complete config, as TOML.
        seeds: Seed of each world.
        backend: Instruction set or device that computed the worlds.
        hedon_version: Version of hedon that wrote the checkpoint.
        frames: Steps between two frames; 0 for none [step].
        run_seconds: Time spent on steps so far [s].
        sampled: Counters of each world and species.
        digests: `World.digest()` of each world.
        parts: SHA-256 of each part on disk, in order, by table. The parts contain all rows up to this step, and no
            later ones.
    """

    step: int
    config: str
    seeds: tuple[int, ...]
    backend: str
    hedon_version: str | None
    frames: int
    run_seconds: float
    sampled: tuple[Sampled, ...]
    digests: tuple[str, ...]
    parts: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """A moment of a run, from which it can continue.

    Attributes:
        head: Data of the checkpoint without arrays.
        arrays: Arrays of all worlds as views of the file, in the engine's shapes: "0/params" is the array `params` of
            world 0.
    """

    head: CheckpointHead
    arrays: dict[str, NDArray[Any]]

    def world(self, index: int) -> dict[str, NDArray[Any]]:
        """The arrays of one world, with the engine's names and shapes."""
        prefix = f"{index}/"
        return {name.removeprefix(prefix): array for name, array in self.arrays.items() if name.startswith(prefix)}


def save_checkpoint(folder: Path, head: CheckpointHead, fill: Fill) -> None:
    """Writes a checkpoint of a run atomically, then removes all but the newest checkpoints.

    Args:
        folder: Folder of the run.
        head: Data of the checkpoint without arrays.
        fill: Writes the arrays.

    Raises:
        OSError: The file system raised it; the earlier checkpoints are then unchanged.
    """
    write_checkpoint(checkpoint_path(folder, head.step), head, fill)
    for old in checkpoint_paths(folder)[:-KEPT]:
        old.unlink(missing_ok=True)


def write_checkpoint(path: Path, head: CheckpointHead, fill: Fill) -> None:
    """Writes one checkpoint atomically, and creates its folder if necessary.

    Args:
        path: Path of the checkpoint.
        head: Data of the checkpoint without arrays.
        fill: Writes the arrays.

    Raises:
        OSError: The checkpoint cannot be written.
    """
    path.parent.mkdir(exist_ok=True)

    def write(file: BinaryIO) -> None:
        with ArrayWriter(file) as archive:
            archive.add(_HEAD, np.frombuffer(json.dumps(asdict(head)).encode(), np.uint8))
            fill(archive)
            archive.add(_DIGEST, np.frombuffer(archive.digest().encode(), np.uint8))

    write_atomically(path, write)


def load_checkpoint(path: Path) -> Checkpoint:
    """Reads a checkpoint, which may be from an untrusted source.

    Checks that the content was not changed since it was written. The engine checks whether the arrays are valid.

    Raises:
        RecordError: The file cannot be read, is damaged, or is not a checkpoint.
    """
    try:
        members = read_arrays(path)
        if members.pop(_DIGEST).tobytes().decode() != digest(members):
            raise ValueError("its content does not match its digest")
        head = _heads().validate_json(members.pop(_HEAD).tobytes())
        if path.name != checkpoint_path(path.parent, head.step).name:
            raise ValueError(f"it is of step {head.step}, but its name gives another step")
        return Checkpoint(head, members)
    except Exception as error:  # a file that is not from hedon can raise any exception
        raise RecordError(f"damaged checkpoint {path}: {error}") from error


@cache
def _heads() -> "TypeAdapter[CheckpointHead]":
    from pydantic import TypeAdapter

    return TypeAdapter(CheckpointHead)
