"""Lists, describes and joins the worlds from which an item is made."""

from collections.abc import Iterable, Mapping, Sequence

import polars as pl

from hedon.analysis.world.record import WorldRecord
from hedon.study.item import Condition, ItemInputs
from hedon.text import count

_NAMED = 3  # largest number of extinct seeds that are listed


def present(conditions: Iterable[Condition], inputs: ItemInputs) -> dict[str, Sequence[WorldRecord]]:
    """The worlds of each condition that has any, by label and in the order of the conditions.

    Args:
        conditions: Conditions of an item.
        inputs: Data with the available worlds.
    """
    worlds_by_label = {condition.label: inputs.worlds.get(condition.label, ()) for condition in conditions}
    return {label: worlds for label, worlds in worlds_by_label.items() if worlds}


def missing(conditions: Iterable[Condition], inputs: ItemInputs) -> str:
    """A sentence that names the conditions without worlds; empty if all have worlds.

    Args:
        conditions: Conditions of an item.
        inputs: Data with the available worlds.
    """
    missing_labels = [condition.label for condition in conditions if not inputs.worlds.get(condition.label)]
    return f"Not run yet: {'; '.join(missing_labels)}." if missing_labels else ""


def sentences(*parts: str) -> str:
    """Joins sentences, skipping empty ones."""
    return " ".join(filter(None, parts))


def count_extinct(worlds: Iterable[WorldRecord]) -> int:
    """The number of worlds that died out."""
    return sum(world.extinct_step is not None for world in worlds)


def steps_reached(worlds: Iterable[WorldRecord]) -> int:
    """The last step of the longest record [step]."""
    return max((world.last_step for world in worlds), default=0)


def describe(worlds: Sequence[WorldRecord]) -> tuple[str, str]:
    """The description of one condition's worlds in a title: number and length, and which of them died out."""
    living = [world.last_step for world in worlds if world.extinct_step is None]
    description = count(len(worlds), "world")
    if not living:
        step = _steps(steps_reached(worlds))
        return description, f"died out at step {step}" if len(worlds) == 1 else f"all died out by step {step}"
    length = _steps(max(living)) if min(living) == max(living) else f"{_steps(min(living))} to {_steps(max(living))}"
    return f"{description}, {length} steps", _died_out(
        [world.seed for world in worlds if world.extinct_step is not None]
    )


def world_indices(groups: Iterable[Sequence[WorldRecord]]) -> dict[int, int]:
    """An index for each seed, from 0, so that a seed has the same color in each condition."""
    seeds = sorted({world.seed for worlds in groups for world in worlds})
    return {seed: index for index, seed in enumerate(seeds)}


def stack(worlds: Iterable[WorldRecord], table: str, indices: Mapping[int, int]) -> pl.DataFrame:
    """The rows of one table ("agents" or "population") of all worlds, with `world` as its seed's index.

    Args:
        worlds: One or more worlds, with equal columns.
        table: Name of the table.
        indices: Index of each seed, from `world_indices`.
    """
    return pl.concat(
        getattr(world, table).with_columns(world=pl.lit(indices[world.seed], pl.Int32)) for world in worlds
    )


def _died_out(seeds: Sequence[int]) -> str:
    if not seeds:
        return "none died out"
    if len(seeds) > _NAMED:
        return f"{len(seeds)} died out"
    return f"seed{'s' if len(seeds) > 1 else ''} {', '.join(map(str, sorted(seeds)))} died out"


def _steps(count: int) -> str:
    return f"{count / 1e6:.4g} million" if count >= 10**6 else f"{count:,}"
