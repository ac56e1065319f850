"""The sentence of a report on how to watch a run, and from which step."""

from dataclasses import dataclass

import polars as pl

from hedon.record.reader import Run

PARTS = 20
"""Number of equal parts into which the records are divided; the largest change is sought over the length of one."""


@dataclass(frozen=True)
class WeightChange:
    """The start of the largest change in a world.

    Attributes:
        seed: Seed of the world.
        step: Step at which the change begins [step].
        end: Step at which it ends [step].
        weight: Reward weight whose mean changes, as a column of the table `agents`.
    """

    seed: int
    step: int
    end: int
    weight: str


def how_to_watch(run: Run, seed: int) -> str:
    """How to open a run in the browser, at the largest change of a world if its records show one."""
    change = largest_change(run, seed)
    if change is None:
        return "To watch how it got there, run hedon view with this folder."
    options = f"--step {change.step}" + (f" --seed {seed}" if len(run.manifest.seeds) > 1 else "")
    return (
        f"To watch how it got there, run hedon view with this folder. With {options}, it opens at the start of the "
        f"largest change in the mean of {change.weight}, which ends at step {change.end}."
    )


def largest_change(run: Run, seed: int) -> WeightChange | None:
    """The largest change in the mean of a reward weight within a twentieth of a world's records.

    Args:
        run: The run; its damaged parts are left out.
        seed: Seed of the world.

    Returns:
        The largest change, of all weights and species; None if the records have fewer than two rows.
    """
    rows = run.population(skip_damaged=True).filter(pl.col("seed") == seed).sort("step")
    groups = rows.partition_by("species") if "species" in rows.columns else [rows]
    changes = [change for group in groups for change in _changes(group, run.reward_names)]
    if not changes:
        return None
    _, step, end, weight = max(changes)
    return WeightChange(seed, step, end, weight)


def _changes(rows: pl.DataFrame, weights: tuple[str, ...]) -> list[tuple[float, int, int, str]]:
    """The largest change of each weight, with its first and last step; none for a weight without means."""
    distance = max(rows.height // PARTS, 1)
    changes = []
    for weight in weights:
        column = pl.col(f"{weight}_mean")
        moved = rows.select(
            size=(column - column.shift(distance)).abs(), start=pl.col("step").shift(distance), end=pl.col("step")
        )
        moved = moved.filter(pl.col("size").is_finite()).sort("size")
        if moved.height:
            size, start, end = moved.row(-1)
            changes.append((size, start, end, weight))
    return changes
