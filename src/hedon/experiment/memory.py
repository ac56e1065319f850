"""Checks, before a run begins, whether it fits into the memory of this machine."""

from collections.abc import Sequence
from pathlib import Path

from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_input
from hedon.error import HedonError
from hedon.limit import address_limit
from hedon.record.schema import columns_of, run_tables
from hedon.record.writer import PART_ROWS

CONTROL_GROUP_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Files with the memory limit of a container, in version 2 and 1 of control groups."""
LARGEST_VALUE = 8
"""Bytes of the largest value of a column."""


class MemoryNeedError(HedonError):
    """A run that needs more memory than there is."""


def memory_needed(config: Config, worlds: int, threads: int = 0) -> dict[str, int]:
    """Most memory that a run needs, by purpose [byte].

    Args:
        config: What the worlds are.
        worlds: Number of worlds.
        threads: Threads to use; 0 for all processors.
    """
    given = engine_input(config)
    need = _engine.memory_needed(given.settings, len(given.walls), worlds, threads)
    tables = run_tables(columns_of(config)).values()
    # A checkpoint is a copy of all worlds until it is on disk; one world may be copied at the same time for its digest.
    learned = need["networks"] + need["rollouts"]
    return {
        "networks and moments": need["networks"],
        "rollouts": need["rollouts"],
        "physics": need["physics"],
        "rest of the worlds": need["rest"],
        "a checkpoint": learned + learned // worlds,
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

    Args:
        config: Of all worlds.
        worlds: How many there are.
        threads: That run them; 0 for all processors.

    Raises:
        MemoryNeedError: It needs more than there is; the message says what for.
    """
    need, present = memory_needed(config, worlds, threads), memory_present()
    total = sum(need.values())
    if total > present:
        parts = ", ".join(f"{name} {size / 1e9:.1f}" for name, size in need.items())
        slots = sum(own.population.capacity for own in config.species.values())
        raise MemoryNeedError(
            f"the run may need {total / 1e9:.1f} GB of memory, and there are {present / 1e9:.1f} GB ({parts}): lower "
            f"population.capacity ({slots:,}), world.rollout_steps "
            f"({config.world.rollout_steps:,}) or the number of seeds ({worlds:,})"
        )
