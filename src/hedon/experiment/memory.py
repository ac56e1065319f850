"""Checks, before a run starts, that it fits into memory and onto the disk."""

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_input
from hedon.error import HedonError
from hedon.experiment.simulation import SCRATCH_VARIABLE
from hedon.limit import address_limit
from hedon.record.schema import columns_of, run_tables
from hedon.record.writer import PART_ROWS
from hedon.text import brief

CONTROL_GROUP_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Files with the memory limit of a container, in versions 2 and 1 of control groups."""
COLD = "moments and observations"
"""Purpose of the memory that HEDON_SCRATCH can move into files."""
LARGEST_VALUE = 8
"""Size of the largest value of a column [byte]."""


class MemoryNeedError(HedonError):
    """A run needs more memory or disk space than is available."""


def memory_needed(config: Config, worlds: int, threads: int = 0) -> dict[str, int]:
    """Peak memory of a run, by purpose [byte]."""
    inputs = engine_input(config)
    sizes = _engine.memory_needed(inputs.settings, len(inputs.walls), worlds, threads)
    tables = run_tables(columns_of(config)).values()
    return {
        "networks": sizes["networks"],
        COLD: sizes["cold"],
        "the rest of rollouts": sizes["rollouts"],
        "physics": sizes["physics"],
        "rest of the worlds": sizes["rest"],
        # Rows stay in memory until their part is full; joining and writing the part needs copies.
        "records": 3 * PART_ROWS * LARGEST_VALUE * sum(len(table.columns) for table in tables),
    }


def memory_present(limits: Sequence[str] = CONTROL_GROUP_LIMITS) -> int:
    """Memory available to this process, limited by the machine, its container or `ulimit -v` [byte]."""
    available = _engine.physical_memory()
    if (addresses := address_limit()) is not None:
        available = min(available, addresses)
    for path in limits:
        try:
            available = min(available, int(Path(path).read_text()))
        except (OSError, ValueError):  # not this version, or "max"
            continue
    return available


def require_memory(config: Config, worlds: int, threads: int = 0) -> None:
    """Refuses a run that does not fit.

    Raises:
        MemoryNeedError: The run needs more than is available; the message lists the purposes.
    """
    sizes, available = memory_needed(config, worlds, threads), memory_present()
    slots = sum(species.population.capacity for species in config.species.values())
    remedy = (
        f"lower population.capacity ({slots:,}), world.rollout_steps ({config.world.rollout_steps:,}) or the number of "
        f"seeds ({worlds:,})"
    )
    scratch = os.environ.get(SCRATCH_VARIABLE, "")
    if scratch:
        _require_room(scratch, sizes.pop(COLD), remedy)
    total = sum(sizes.values())
    if total > available:
        parts = ", ".join(f"{name} {size / 1e9:.1f}" for name, size in sizes.items())
        other = "" if scratch else f", or set {SCRATCH_VARIABLE} to a folder that can take the {COLD}"
        raise MemoryNeedError(
            f"the run may need {total / 1e9:.1f} GB of memory, and there are {available / 1e9:.1f} GB ({parts}): "
            f"{remedy}{other}"
        )


def _require_room(scratch: str, needed: int, remedy: str) -> None:
    """Raises MemoryNeedError if the folder does not exist or its disk has too little space."""
    try:
        free = shutil.disk_usage(scratch).free
    except OSError as error:
        raise MemoryNeedError(f"{SCRATCH_VARIABLE} = {brief(repr(scratch))}: {error.strerror}") from None
    if needed > free:
        raise MemoryNeedError(
            f"{SCRATCH_VARIABLE} = {brief(repr(scratch))}: the run needs {needed / 1e9:.1f} GB there, and "
            f"{free / 1e9:.1f} GB are free: {remedy}, or choose another disk"
        )
