"""Topics on genomes and selection by birth cohort: distributions, gradients, curvature, terms of Price's equation."""

import numpy as np
import polars as pl

from hedon.analysis.agent.cohort import COMPLETE, genome_distribution, window_bounds, with_cohorts
from hedon.analysis.descent.genealogy import genealogy
from hedon.analysis.gene.selection import curvature, selection
from hedon.analysis.result import ResultTable, make_table, over_worlds
from hedon.analysis.topic.cohort import (
    cohort_rows,
    complete_cohorts,
    incomplete_note,
    window_count,
    world_means,
)
from hedon.analysis.world.record import Conditions, labels, with_roles
from hedon.statistic.price import price


def genome(conditions: Conditions) -> list[ResultTable]:
    """Distributions of the weights over birth cohorts."""
    tables = []
    for worlds in conditions.values():
        windows = window_count(worlds)
        for world in worlds:
            cohorts = with_cohorts(world.born, world.last_step, windows)
            distribution = genome_distribution(cohorts, world.weight_names).with_columns(
                pl.col("weight").cast(pl.String)
            )
            labeled = distribution.select(*(pl.lit(v).alias(k) for k, v in labels(world).items()), pl.all())
            tables.append(labeled.with_columns(to_step=_ends(world.last_step, windows, labeled["window"])))
    worlds_table = ResultTable(
        "genome_world",
        "Weights by world and birth cohort",
        pl.concat(tables) if tables else pl.DataFrame(),
        shown=False,
    )
    last_cohort = worlds_table.rows
    if not last_cohort.is_empty():
        last_cohort = last_cohort.filter(pl.col("window") == pl.col("window").max().over("condition", "seed"))
    summary = over_worlds(last_cohort, ("weight",), {"mean": "mean", "sd": "sd within a world"})
    return [make_table("genome", "Weights in the last birth cohort, means over worlds", summary), worlds_table]


def selection_topic(conditions: Conditions) -> list[ResultTable]:
    """Selection differentials and gradients by birth cohort."""
    rows = cohort_rows(
        conditions,
        lambda world, cohort: selection(cohort, world.weight_names, world.last_step),
    )
    worlds_table = make_table(
        "selection_world",
        "Selection by world and birth cohort",
        rows,
        shown=False,
    )
    complete = complete_cohorts(worlds_table.rows)
    quantities = {"standard_gradient": "standardized gradient", "intensity": "standardized differential"}
    by_world = world_means(complete, ("fitness", "weight"), tuple(quantities))
    by_window = over_worlds(
        complete, ("fitness", "weight", "window", "to_step"), {"standard_gradient": "standardized gradient"}
    )
    note = (
        "Change of relative fitness per standard deviation of the weight: the gradient with the other weights held "
        "fixed, the differential by whatever route. Means over cohorts of which at least "
        f"{100 * COMPLETE:.0f} % have died, then over worlds."
    ) + incomplete_note(worlds_table.rows)
    summary = with_roles(over_worlds(by_world, ("fitness", "weight"), quantities), conditions)
    return [
        make_table("selection", "Selection on each weight", summary, note),
        make_table("selection_window", "Standardized gradient over time, means over worlds", by_window, shown=False),
        worlds_table,
    ]


def curvature_topic(conditions: Conditions) -> list[ResultTable]:
    """Curvature of fitness along each weight, over birth cohorts and worlds."""
    rows = cohort_rows(
        conditions,
        lambda world, cohort: curvature(cohort, world.weight_names, world.last_step),
    )
    worlds_table = make_table(
        "curvature_world",
        "Curvature of fitness by world and birth cohort",
        rows,
        shown=False,
    )
    by_world = world_means(complete_cohorts(worlds_table.rows), ("fitness", "weight"), ("curvature",))
    if rows:
        by_world = _with_excess(by_world, conditions)
    note = (
        "Quadratic selection gradient, per variance of the weight, with the linear parts of all weights held fixed: "
        "below 0 selection is stabilizing, above 0 disruptive. Means over cohorts of which at least "
        f"{100 * COMPLETE:.0f} % have died, then over worlds, less the mean of the other neutral genes: these are "
        "curved too if agents far out have few children for another reason, such as being born later."
    ) + incomplete_note(worlds_table.rows)
    quantities = {"excess": "standardized quadratic gradient, less that of neutral genes"}
    summary = with_roles(over_worlds(by_world, ("fitness", "weight"), quantities), conditions)
    return [make_table("curvature", "Curvature of fitness along each weight", summary, note), worlds_table]


def price_topic(conditions: Conditions) -> list[ResultTable]:
    """Price's equation by birth cohort of the parents."""
    rows = []
    for worlds in conditions.values():
        windows = window_count(worlds)
        for world in worlds:
            tree = genealogy(world.agents)
            cohorts = with_cohorts(world.agents, world.last_step, windows)["window"].to_numpy()
            is_born_in_run = world.agents["agent_id"].is_in(world.born["agent_id"].implode()).to_numpy()
            weights = {name: world.agents[name].to_numpy().astype(np.float64) for name in world.weight_names}
            for window in range(windows):
                rows += [
                    labels(world)
                    | {"window": window, "weight": name}
                    | price(z, tree.parent, is_born_in_run & (cohorts == window))
                    for name, z in weights.items()
                ]
    worlds_table = make_table("price_world", "Price's equation by world and cohort of parents", rows, shown=False)
    terms = ("change", "selection", "transmission", "residual")
    by_world = world_means(worlds_table.rows, ("weight",), terms)
    note = (
        "Change of the mean weight from parents to their children, mean over cohorts and worlds: the part by unequal "
        "numbers of children, and the part by mutation. The residual is rounding."
    )
    summary = with_roles(over_worlds(by_world, ("weight",), {term: term for term in terms}), conditions)
    return [make_table("price", "Price's equation", summary, note), worlds_table]


def _with_excess(by_world: pl.DataFrame, conditions: Conditions) -> pl.DataFrame:
    """Adds the excess of a weight's curvature over the mean of its world's neutral genes, other than itself."""
    neutral = {name for worlds in conditions.values() for world in worlds for name in world.neutral_names}
    neutral_curvature = pl.col("curvature").filter(pl.col("weight").is_in(sorted(neutral)))
    group = ("condition", "seed", "fitness")
    own_curvature = pl.when(pl.col("weight").is_in(sorted(neutral))).then(pl.col("curvature")).otherwise(0.0)
    other_count = neutral_curvature.count().over(group) - pl.col("weight").is_in(sorted(neutral)).cast(pl.Int64)
    mean = (neutral_curvature.sum().over(group) - own_curvature) / other_count
    return by_world.with_columns(excess=pl.when(other_count > 0).then(pl.col("curvature") - mean))


def _ends(last_step: int, windows: int, window: pl.Series) -> pl.Series:
    return pl.Series(window_bounds(last_step, windows)[window.to_numpy() + 1])
