"""Common parts of topics that analyze each birth cohort of each world."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import polars as pl

from hedon.analysis.agent.cohort import COMPLETE, window_bounds, with_cohorts
from hedon.analysis.world.record import Conditions, WorldRecord, labels
from hedon.text import count

_PER_WINDOW = 200  # minimum agents per window of births
_WINDOWS = 10  # maximum windows per run


def window_count(worlds: Sequence[WorldRecord]) -> int:
    """Number of windows by birth for the runs of one condition: ten, or fewer for small records.

    Extinct worlds are ignored while others are alive: one early death would leave a few long windows, none of which is
    complete in a living world.
    """
    living = [world for world in worlds if world.extinct_step is None]
    smallest = min((world.born.height for world in living or worlds), default=0)
    return max(1, min(_WINDOWS, smallest // _PER_WINDOW))


def cohort_rows(
    conditions: Conditions,
    measure: Callable[[WorldRecord, pl.DataFrame], Iterable[dict[str, Any]]],
) -> list[dict[str, Any]]:
    """Rows of every birth cohort of every world, each with its world, window and steps."""
    rows = []
    for worlds in conditions.values():
        windows = window_count(worlds)
        for world in worlds:
            bounds = window_bounds(world.last_step, windows)
            cohorts = with_cohorts(world.born, world.last_step, windows)
            for window in range(windows):
                span = {"window": window, "from_step": int(bounds[window]), "to_step": int(bounds[window + 1])}
                cohort = cohorts.filter(pl.col("window") == window)
                rows += [labels(world) | span | row for row in measure(world, cohort)]
    return rows


def complete_cohorts(rows: pl.DataFrame) -> pl.DataFrame:
    """Rows of cohorts in which nearly all agents have died, so that their lives are known."""
    return rows if rows.is_empty() else rows.filter(pl.col("complete") >= COMPLETE)


def incomplete_note(rows: pl.DataFrame) -> str:
    """A sentence on the number of worlds without a complete cohort, for a note; empty if all have one."""
    if rows.is_empty():
        return ""
    is_complete = rows.group_by("condition", "seed").agg(pl.col("complete").max())["complete"] >= COMPLETE
    missing = len(is_complete) - int(is_complete.sum())
    return f" {count(missing, 'world')} of {len(is_complete)} had no such cohort and are left out." if missing else ""


def world_means(rows: pl.DataFrame, by: Sequence[str], quantities: Sequence[str]) -> pl.DataFrame:
    """Means over the cohorts of each world, for each group of rows."""
    if rows.is_empty():
        return rows
    groups = rows.group_by("condition", "seed", *by, maintain_order=True)
    return groups.agg(pl.col(*quantities).drop_nulls().mean())
