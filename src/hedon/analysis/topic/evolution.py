"""Topics about what evolves: genomes, selection, Price's equation, drift, modes."""

from dataclasses import asdict

import numpy as np
import polars as pl

from hedon.analysis.cohort import COMPLETE, genome_distribution, window_bounds, with_cohorts
from hedon.analysis.drift import drift_tests, standard_drift
from hedon.analysis.genealogy import genealogy
from hedon.analysis.selection import selection
from hedon.analysis.topic.life import Conditions, window_count
from hedon.analysis.topic.result import SEED, ResultTable, generator, labels, over_worlds, table
from hedon.analysis.weight import last_mean
from hedon.statistic.mode import ENOUGH_WORLDS, modes
from hedon.statistic.price import price


def genome(conditions: Conditions) -> list[ResultTable]:
    """Distributions of the weights over birth cohorts."""
    parts = []
    for worlds in conditions.values():
        windows = window_count(worlds)
        for world in worlds:
            cohorts = with_cohorts(world.agents, world.last_step, windows)
            found = genome_distribution(cohorts, world.weight_names).with_columns(pl.col("weight").cast(pl.String))
            named = found.select(*(pl.lit(v).alias(k) for k, v in labels(world).items()), pl.all())
            parts.append(named.with_columns(to_step=_ends(world.last_step, windows, named["window"])))
    worlds_table = ResultTable(
        "genome_world",
        "Weights by world and birth cohort",
        pl.concat(parts) if parts else pl.DataFrame(),
        shown=False,
    )
    last = worlds_table.rows
    if not last.is_empty():
        last = last.filter(pl.col("window") == pl.col("window").max().over("condition", "seed"))
    summary = over_worlds(last, ("weight",), {"mean": "mean", "sd": "sd within a world"})
    return [table("genome", "Weights in the last birth cohort, means over worlds", summary), worlds_table]


def selection_topic(conditions: Conditions) -> list[ResultTable]:
    """Selection differentials and gradients by birth cohort."""
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
                found = selection(cohort, world.weight_names, world.last_step, rng)
                rows += [labels(world) | span | asdict(row) for row in found]
    worlds_table = table(
        "selection_world",
        "Selection by world and birth cohort",
        rows,
        "Bounds are percentiles of a bootstrap over sibships within a world.",
        shown=False,
    )
    whole = worlds_table.rows
    quantities = {"standard_gradient": "standardized gradient", "intensity": "standardized differential"}
    by_world = whole
    if rows:
        whole = whole.filter(pl.col("complete") >= COMPLETE)
        groups = whole.group_by("condition", "seed", "fitness", "weight", maintain_order=True)
        by_world = groups.agg(pl.col(*quantities).drop_nulls().mean())
    by_window = over_worlds(
        whole, ("fitness", "weight", "window", "to_step"), {"standard_gradient": "standardized gradient"}
    )
    note = (
        "Change of relative fitness per standard deviation of the weight: the gradient with the other weights held "
        "fixed, the differential by whatever route. Means over cohorts of which at least "
        f"{100 * COMPLETE:.0f} % have died, then over worlds."
    )
    return [
        table("selection", "Selection on each weight", over_worlds(by_world, ("fitness", "weight"), quantities), note),
        table("selection_window", "Standardized gradient over time, means over worlds", by_window, shown=False),
        worlds_table,
    ]


def price_topic(conditions: Conditions) -> list[ResultTable]:
    """Price's equation by birth cohort of the parents."""
    rows = []
    for worlds in conditions.values():
        windows = window_count(worlds)
        for world in worlds:
            tree = genealogy(world.agents)
            cohorts = with_cohorts(world.agents, world.last_step, windows)["window"].to_numpy()
            weights = {name: world.agents[name].to_numpy().astype(np.float64) for name in world.weight_names}
            for window in range(windows):
                rows += [
                    labels(world)
                    | {"window": window, "weight": name}
                    | asdict(price(z, tree.parent, cohorts == window))
                    for name, z in weights.items()
                ]
    worlds_table = table("price_world", "Price's equation by world and cohort of parents", rows, shown=False)
    by_world = worlds_table.rows
    terms = ("change", "selection", "transmission", "residual")
    if rows:
        groups = by_world.group_by("condition", "seed", "weight", maintain_order=True)
        by_world = groups.agg(pl.col(*terms).drop_nulls().mean())
    note = (
        "Change of the mean weight from parents to their children, mean over cohorts and worlds: the part by unequal "
        "numbers of children, and the part by mutation. The residual is rounding."
    )
    summary = over_worlds(by_world, ("weight",), {term: term for term in terms})
    return [table("price", "Price's equation", summary, note), worlds_table]


def drift(conditions: Conditions) -> list[ResultTable]:
    """Each weight against drift."""
    world_rows, rows = [], []
    for condition, worlds in conditions.items():
        found = [standard_drift(world) for world in worlds]
        for world, results in zip(worlds, found, strict=True):
            world_rows += [labels(world) | asdict(result) for result in results]
        names = worlds[0].reward_names, worlds[0].neutral_names
        tests = drift_tests(found, *names, np.random.default_rng(SEED))
        rows += [{"condition": condition} | asdict(test) for test in tests]
    note = (
        "direction: mean score against neutral genes walked down the recorded pedigree, in standard deviations of "
        "drift; drift_low and drift_high are its bounds by the spread of drift itself, as p takes it. distance and "
        "held: root mean square score, 1 under drift, with the chance of a larger one (distance) or of a smaller one "
        "(held). marker: how much further than the neutral markers the weight moved. p_holm is corrected for all "
        "reward weights and tests of one control; neutral markers are there as a check."
    )
    return [
        table("drift", "Weights of the agents born last against drift", rows, note),
        table("drift_world", "Weights against drift, world by world", world_rows, shown=False),
    ]


def mode(conditions: Conditions) -> list[ResultTable]:
    """One mode or two, over worlds."""
    rows = []
    for condition, worlds in conditions.items():
        for name in worlds[0].weight_names:
            means = [last_mean(name, world) for world in worlds if world.extinct_step is None]
            found = modes(np.array([mean for mean in means if mean is not None], np.float64))
            rows.append({"condition": condition, "weight": name} | asdict(found))
    note = (
        "Dip test over worlds that live. power: chance to find two modes six standard deviations apart with as many "
        f"worlds; below 0.8, so with fewer than {ENOUGH_WORLDS} worlds, a single mode is not called."
    )
    return [table("mode", "Modes of the worlds' mean weights", rows, note)]


def _ends(last_step: int, windows: int, window: pl.Series) -> pl.Series:
    return pl.Series(window_bounds(last_step, windows)[window.to_numpy() + 1])
