"""The rows of a sweep's table: one per world."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hedon.config.problem import format_value
from hedon.sweep.plan import Batch

KEYS = ("condition", "repetition", "seed")
SPECIES = "species"
"""The part of a summary that has the numbers of several species, by name."""
TIMED = "steps_per_second"
"""The part of a summary that differs from one machine to another: it is not in the table."""

Row = dict[str, Any]


def world_rows(
    batch: Batch, settings: Mapping[str, Any], summary: Mapping[str, Any], digests: Sequence[str]
) -> list[Row]:
    """One row per world of a batch: its keys, its settings, the digest of its end, and its part of the summary.

    Nested values get names joined by "_": weights.w_action.mean is w_action_mean. Where there are several species, what
    is of one of them begins with its name and a dot, as in prey.alive_mean, and sums over all are totals: total_alive.

    Args:
        batch: Whose worlds they are.
        settings: What the sweep varies, by path.
        summary: Of the run, as `summarize` gives it.
        digests: Of the worlds' ends, in the order of the seeds.
    """
    varied = {name: _plain(value) for name, value in settings.items()}
    rows = []
    for i, (world, digest) in enumerate(zip(summary["worlds"], digests, strict=True)):
        keys = dict(zip(KEYS, (batch.condition, batch.first + i, world["seed"]), strict=True))
        rest = {name: value for name, value in world.items() if name not in (TIMED, "seed", SPECIES)}
        row = {**keys, **varied, "digest": digest, **dict(_flat(rest))}
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


def _plain(value: Any) -> Any:
    """A value of a setting as a table holds it: a list as text."""
    return value if isinstance(value, str | int | float) else format_value(value)
