"""The rows of a sweep's table, one per world."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

KEYS = ("condition", "repetition", "seed")
SPECIES = "species"
"""Key of a summary under which several species have their numbers, by name."""
TIMED = "steps_per_second"
"""Key of a summary that depends on the machine, so the table omits it."""

Row = dict[str, Any]


def world_rows(summary: Mapping[str, Any], digests: Sequence[str]) -> list[Row]:
    """The columns of each world of a batch, without its settings: seed, digest of its last state, and its summary.

    Names of nested values are joined by "_": weights.w_action.mean becomes w_action_mean. With several species, the
    numbers of one start with its name and a dot, as in prey.alive_mean; sums over all start with "total", as in
    total_alive.
    """
    rows = []
    for world, digest in zip(summary["worlds"], digests, strict=True):
        other_values = {name: value for name, value in world.items() if name not in (TIMED, "seed", SPECIES)}
        row = {"seed": world["seed"], "digest": digest, **dict(_flat(other_values))}
        for species, part in world.get(SPECIES, {}).items():
            row |= {f"{species}.{name}": value for name, value in _flat(part)}
        rows.append(row)
    return rows


def _flat(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        # Names of genes already include their kind.
        column = name if not prefix or prefix == "weights" else f"{prefix}_{name}"
        if isinstance(value, Mapping):
            yield from _flat(value, column)
        else:
            yield column, value
