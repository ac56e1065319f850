"""The rows of a sweep's table: one per world."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

KEYS = ("condition", "repetition", "seed")
SPECIES = "species"
"""The part of a summary that has the numbers of several species, by name."""
TIMED = "steps_per_second"
"""The part of a summary that differs from one machine to another: it is not in the table."""

Row = dict[str, Any]


def world_rows(summary: Mapping[str, Any], digests: Sequence[str]) -> list[Row]:
    """What the table has of each world of a batch beside its settings: seed, digest of its end, and its summary.

    Nested values get names joined by "_": weights.w_action.mean is w_action_mean. Where there are several species, what
    is of one of them begins with its name and a dot, as in prey.alive_mean, and sums over all are totals: total_alive.
    """
    rows = []
    for world, digest in zip(summary["worlds"], digests, strict=True):
        rest = {name: value for name, value in world.items() if name not in (TIMED, "seed", SPECIES)}
        row = {"seed": world["seed"], "digest": digest, **dict(_flat(rest))}
        for species, part in world.get(SPECIES, {}).items():
            row |= {f"{species}.{name}": value for name, value in _flat(part)}
        rows.append(row)
    return rows


def _flat(values: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        # Genes have their kind in their names already.
        place = name if not before or before == "weights" else f"{before}_{name}"
        if isinstance(value, Mapping):
            yield from _flat(value, place)
        else:
            yield place, value
