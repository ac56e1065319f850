"""Checks, before a run begins, whether it fits into the memory of this machine, and onto its disk."""

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
"""Files with the memory limit of a container, in version 2 and 1 of control groups."""
COLD = "moments and observations"
"""What may lie in files instead, by HEDON_SCRATCH."""
LARGEST_VALUE = 8
"""Bytes of the largest value of a column."""


class MemoryNeedError(HedonError):
    """A run that needs more memory, or more room on the disk, than there is."""


def memory_needed(config: Config, worlds: int, threads: int = 0) -> dict[str, int]:
    """Most memory that a run needs, by purpose [byte]."""
    given = engine_input(config)
    need = _engine.memory_needed(given.settings, len(given.walls), worlds, threads)
    tables = run_tables(columns_of(config)).values()
    return {
        "networks": need["networks"],
        COLD: need["cold"],
        "the rest of rollouts": need["rollouts"],
        "physics": need["physics"],
        "rest of the worlds": need["rest"],
        # Rows wait in memory until their part is full; joining and writing it needs copies.
        "records": 3 * PART_ROWS * LARGEST_VALUE * sum(len(table.columns) for table in tables),
    }


def memory_present(limits: Sequence[str] = CONTROL_GROUP_LIMITS) -> int:
    """Memory that this process can use: of the machine, of its container, or by `ulimit -v` [byte]."""
    present = _engine.physical_memory()
    if (addresses := address_limit()) is not None:
        present = min(present, addresses)
    for path in limits:
        try:
            present = min(present, int(Path(path).read_text()))
        except (OSError, ValueError):  # not this version, or "max"
            continue
    return present


def require_memory(config: Config, worlds: int, threads: int = 0) -> None:
    """Refuses a run that does not fit.

    Raises:
        MemoryNeedError: It needs more than there is; the message says what for.
    """
    need, present = memory_needed(config, worlds, threads), memory_present()
    slots = sum(own.population.capacity for own in config.species.values())
    remedy = (
        f"lower population.capacity ({slots:,}), world.rollout_steps ({config.world.rollout_steps:,}) or the number of "
        f"seeds ({worlds:,})"
    )
    scratch = os.environ.get(SCRATCH_VARIABLE, "")
    if scratch:
        _require_room(scratch, need.pop(COLD), remedy)
    total = sum(need.values())
    if total > present:
        parts = ", ".join(f"{name} {size / 1e9:.1f}" for name, size in need.items())
        other = "" if scratch else f", or set {SCRATCH_VARIABLE} to a folder that can take the {COLD}"
        raise MemoryNeedError(
            f"the run may need {total / 1e9:.1f} GB of memory, and there are {present / 1e9:.1f} GB ({parts}): "
            f"{remedy}{other}"
        )


def _require_room(scratch: str, needed: int, remedy: str) -> None:
    """MemoryNeedError: the folder is not there, or its disk has too little room."""
    try:
        free = shutil.disk_usage(scratch).free
    except OSError as error:
        raise MemoryNeedError(f"{SCRATCH_VARIABLE} = {brief(repr(scratch))}: {error.strerror}") from None
    if needed > free:
        raise MemoryNeedError(
            f"{SCRATCH_VARIABLE} = {brief(repr(scratch))}: the run needs {needed / 1e9:.1f} GB there, and "
            f"{free / 1e9:.1f} GB are free: {remedy}, or choose another disk"
        )
