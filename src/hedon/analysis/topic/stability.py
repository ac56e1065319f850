"""Topics about weights that are held: mean reversion along a run, and the curvature of fitness."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import polars as pl

from hedon.analysis.cohort import COMPLETE, window_bounds, with_cohorts
from hedon.analysis.course import WorldCourse, world_course
from hedon.analysis.selection import curvature
from hedon.analysis.topic.life import Conditions, window_count
from hedon.analysis.topic.result import ResultTable, generator, labels, over_worlds, table
from hedon.statistic.correction import holm
from hedon.statistic.reversion import Reversion, reversion

_INTERVALS = 100  # into which the longest world of a condition is cut


def reversion_topic(conditions: Conditions) -> list[ResultTable]:
    """Mean reversion of each weight, over the worlds of a condition and in each of them."""
    rows, world_rows = [], []
    for condition, worlds in conditions.items():
        interval = max(max(world.last_step for world in worlds) / _INTERVALS, 1.0)
        known = {world: world_course(world, interval, generator(world)) for world in worlds}
        courses = {world: course for world, course in known.items() if course is not None}
        for world, course in courses.items():
            world_rows += [labels(world) | row for row in _rows([course], world.weight_names)]
        found = _rows(list(courses.values()), worlds[0].weight_names)
        neutral = worlds[0].neutral_names
        corrected = holm([float("nan") if row["weight"] in neutral else row["p"] for row in found])
        rows += [{"condition": condition} | row | {"p_holm": p} for row, p in zip(found, corrected, strict=True)]
    note = (
        "An Ornstein-Uhlenbeck process with one optimum and one strength for all worlds, fitted to the mean weight of "
        "the living at equal intervals. strength: share of the distance to the optimum that is gone after a "
        "generation, for small numbers; 0 is Brownian motion. p: chance of so strong a pull among neutral genes "
        "walked down the same pedigrees; p_holm is corrected for all reward weights. The optimum is told where p is at "
        "most 0.05. Neutral markers are there as a check."
    )
    return [
        table("reversion", "Is a weight held near a value?", rows, note),
        table("reversion_world", "Mean reversion, world by world", world_rows, shown=False),
    ]


def curvature_topic(conditions: Conditions) -> list[ResultTable]:
    """Curvature of fitness along each weight, over birth cohorts and worlds."""
    rows = []
    for worlds in conditions.values():
        windows = window_count(worlds)
        for world in worlds:
            bounds = window_bounds(world.last_step, windows)
            cohorts = with_cohorts(world.agents, world.last_step, windows)
            rng = generator(world)
            for window in range(windows):
                span = {"window": window, "from_step": int(bounds[window]), "to_step": int(bounds[window + 1])}
                cohort = cohorts.filter(pl.col("window") == window)
                found = curvature(cohort, world.weight_names, world.last_step, rng)
                rows += [labels(world) | span | asdict(row) for row in found]
    worlds_table = table(
        "curvature_world",
        "Curvature of fitness by world and birth cohort",
        rows,
        "Bounds are percentiles of a bootstrap over sibships within a world.",
        shown=False,
    )
    by_world = worlds_table.rows
    if rows:
        whole = by_world.filter(pl.col("complete") >= COMPLETE)
        groups = whole.group_by("condition", "seed", "fitness", "weight", maintain_order=True)
        by_world = _with_excess(groups.agg(pl.col("curvature").drop_nulls().mean()), conditions)
    note = (
        "Quadratic selection gradient, per variance of the weight, with the linear parts of all weights held fixed: "
        "below 0 selection is stabilizing, above 0 disruptive. Means over cohorts of which at least "
        f"{100 * COMPLETE:.0f} % have died, then over worlds. Neutral markers are curved too where agents far out have "
        "few children for another reason, such as being born later: read what is left without their mean."
    )
    quantities = {
        "curvature": "standardized quadratic gradient",
        "excess": "the same, less the mean of the other neutral markers",
    }
    summary = over_worlds(by_world, ("fitness", "weight"), quantities)
    return [table("curvature", "Curvature of fitness along each weight", summary, note), worlds_table]


def _with_excess(by_world: pl.DataFrame, conditions: Conditions) -> pl.DataFrame:
    """Adds what a weight's curvature exceeds the mean of the neutral markers of its world by, itself not among them."""
    neutral = {name for worlds in conditions.values() for world in worlds for name in world.neutral_names}
    of_marker = pl.col("curvature").filter(pl.col("weight").is_in(sorted(neutral)))
    group = ("condition", "seed", "fitness")
    own = pl.when(pl.col("weight").is_in(sorted(neutral))).then(pl.col("curvature")).otherwise(0.0)
    others = of_marker.count().over(group) - pl.col("weight").is_in(sorted(neutral)).cast(pl.Int64)
    mean = (of_marker.sum().over(group) - own) / others
    return by_world.with_columns(excess=pl.when(others > 0).then(pl.col("curvature") - mean))


def _rows(courses: Sequence[WorldCourse], weights: Sequence[str]) -> list[dict[str, Any]]:
    """One row per weight, with strengths per generation."""
    generations = sum(course.generations for course in courses)
    rows = []
    for weight in weights:
        found = reversion([c.mean[weight] for c in courses], [c.neutral[weight] for c in courses])
        if found is not None and generations > 0:
            rows.append({"weight": weight} | _per_generation(found, generations))
    return rows


def _per_generation(found: Reversion, generations: float) -> dict[str, Any]:
    factor = found.intervals / generations
    strengths = {name: getattr(found, name) * factor for name in ("strength", "strength_low", "strength_high")}
    return {
        "worlds": found.worlds,
        "generations": generations / found.worlds,
        "optimum": found.optimum,
        "optimum_low": found.optimum_low,
        "optimum_high": found.optimum_high,
        **strengths,
        "p": found.p,
    }
