"""Is a liking for water fit if water is only a means to food? README.md has the claim, the rule and the deviations."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

import hedon.assay
import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, make_table, mean_alive
from hedon.figure import NamedFigure
from hedon.statistic import mean_interval
from hedon.study import Condition, Item, ItemInputs, Scale, Study, missing_note
from hedon_studies.condition import each_condition, measured_rows, no_worlds
from hedon_studies.founder import fitness_slope, known_mean, spread_gene
from hedon_studies.rule import Test, by_seed, mean_test, pair_test, verdict_table

FOLDER = Path(__file__).parent
NAME = "optimal-reward"
GENE = "w_water"
BOUNDS = (0.0, 1.0)
"""Range of the founders' genes, except the two weights."""
WEIGHTS = {"w_normal": 1.0, "w_action": 0.0}
"""The weights of all founders."""
BINS = np.linspace(*BOUNDS, 5)
"""Edges of the ranges of the gene for which mean intakes are listed."""
SCALE = Scale(tuple(range(1701, 1731)), 20_480)
WATER = (
    "store.water.capacity=5",
    "store.water.initial=0",
    "store.water.child_share=0.5",
    "food.water.gives={water=1}",
    "food.water.growth_rate=3.5",
    "food.water.capacity=400",
    "food.water.initial_count=400",
    "genome.mutation_scale=0",
    "genome.action.initial_sd=0",
)
"""As much water as food, and a store for it that nothing else uses."""
GATED, FREE = "food needs water", "food needs nothing"
MEALS = {
    GATED: ("food.normal.gives={energy=2, water=-1}", "food.normal.needs={water=1}"),
    FREE: ("food.normal.gives={energy=2}",),
}
CONDITIONS = {
    name: Condition(
        name, "appetite", (*WATER, *meals), founders=partial(spread_gene, low=BOUNDS[0], high=BOUNDS[1], fixed=WEIGHTS)
    )
    for name, meals in MEALS.items()
}


def measure(world: WorldRecord) -> dict[str, Any]:
    """The measures of one world; None where records were cut before the agents died.

    Returns:
        "food", "water" and "children": mean numbers that founders ate, drank and had. "unfinished": share of founders
        alive at the end. "alive": mean number of agents alive. "slope": slope of founders' relative intake of food on
        the gene; "rate slope" and "children slope": the same for their intake per step of life and for their number of
        children. "intake": mean intake of food in each range of `BINS`. Also a slope of intake for each neutral gene.
    """
    founders = world.agents.filter(pl.col("parent_id").is_null()).sort("agent_id")
    food, water, children = (
        founders[name].to_numpy().astype(np.float64) for name in ("eaten_normal", "eaten_water", "children")
    )
    outcomes = hedon.assay.founder_outcomes(world.agents, world.weight_names, world.last_step)
    lifespans = outcomes["lifespan"].to_numpy().astype(np.float64)
    genes = founders[GENE].to_numpy()
    bins = np.digitize(genes, BINS[1:-1])
    return {
        "seed": world.seed,
        "died out": world.extinct_step is not None,
        "food": known_mean(food),
        "water": known_mean(water),
        "children": known_mean(children),
        "unfinished": float((lifespans >= world.last_step).mean()),
        "alive": mean_alive(world.population),
        "slope": fitness_slope(genes, food),
        "rate slope": fitness_slope(genes, food / np.maximum(lifespans, 1)),
        "children slope": fitness_slope(genes, children),
        "intake": [known_mean(food[bins == i]) for i in range(len(BINS) - 1)],
        **{name: fitness_slope(founders[name].to_numpy(), food) for name in world.neutral_names},
    }


def named_tests(rows: Sequence[Mapping[str, Any]], key: str = "slope") -> tuple[Test, Test]:
    """The two tests of the claim, from the rows of all worlds.

    Args:
        rows: Rows of worlds, each with "condition", "seed", "died out" and the slope.
        key: Column of the slope.
    """
    gated = [row for row in rows if row["condition"] == GATED]
    slopes, extinct = by_seed(rows, GATED, key), sum(row["died out"] for row in gated)
    slope = "liking water is fit if food needs it: slope of intake on the gene"
    difference = "it is fit because food needs water: that slope less the one if food needs nothing"
    return (
        mean_test(slope, list(slopes.values()), len(gated), extinct, above=True),
        pair_test(difference, rows, (GATED, FREE), key),
    )


def control_rows(rows: Sequence[Mapping[str, Any]], neutral: Sequence[str]) -> list[dict[str, Any]]:
    """Negative control: both tests with each neutral gene in place of the liking for water.

    Args:
        rows: Rows of worlds.
        neutral: Names of the neutral genes.
    """
    return [
        {"gene": gene, "test": test, "effect": found.effect, "low": found.low, "high": found.high, "p": found.p}
        for gene in neutral
        for test, found in zip(("slope", "difference"), named_tests(rows, gene), strict=True)
    ]


def condition_rows(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """A row for each condition: what founders ate, and what their gene is worth, as means over worlds."""
    found = []
    for condition, worlds in each_condition(rows, CONDITIONS):
        columns: dict[str, Any] = {"condition": condition, "worlds": len(worlds)}
        for key in ("food", "water", "children", "unfinished", "alive"):
            columns[key] = mean_interval(row[key] for row in worlds).mean
        for key in ("slope", "rate slope", "children slope"):
            interval = mean_interval(row[key] for row in worlds)
            columns |= {key: interval.mean, f"{key} low": interval.low, f"{key} high": interval.high}
        for i, (low, high) in enumerate(pairwise(BINS)):
            columns[f"{low:g} to {high:g}"] = mean_interval(row["intake"][i] for row in worlds).mean
        found.append(columns)
    return found


def make(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure, and the tables of the answer, of conditions, of neutral genes and of worlds."""
    question = "Is a liking for water fit if water is only a means to food?"
    rows = measured_rows(inputs, CONDITIONS, measure)
    if not rows:
        yield no_worlds(NAME, question, inputs, CONDITIONS)
        return
    yield draw_intake(question, rows)
    note = missing_note(inputs, tuple(CONDITIONS.values()), SCALE)
    yield verdict_table("optimal_reward_verdict", named_tests(rows), note)
    yield make_table("optimal_reward_condition", "Each condition: what founders eat, by the gene", condition_rows(rows))
    neutral = [name for name in rows[0] if name.startswith("neutral_")]
    title = "Negative control: the same tests with each neutral gene"
    yield make_table("optimal_reward_control", title, control_rows(rows, neutral), shown=False)
    plain = [{key: value for key, value in row.items() if key != "intake"} for row in rows]
    yield make_table("optimal_reward_world", "Each world: its founders, and slopes on their genes", plain, shown=False)


def draw_intake(question: str, rows: Sequence[Mapping[str, Any]]) -> NamedFigure:
    """Draws the relative intake of food over the gene: a pale line for each world, and means with intervals."""
    middle = (BINS[:-1] + BINS[1:]) / 2
    colors = {GATED: hedon.figure.BLUE, FREE: hedon.figure.VERMILION}
    with hedon.figure.styled():
        figure = hedon.figure.new_figure(5.6, 3.6)
        axes = figure.subplots()
        axes.axhline(1, color=hedon.figure.PALE, linewidth=0.8)
        for condition, color in colors.items():
            worlds = [row for row in rows if row["condition"] == condition and row["food"]]
            relative = np.array([np.array(row["intake"], np.float64) / row["food"] for row in worlds])
            relative = relative.reshape(-1, len(middle))
            for line in relative:
                axes.plot(middle, line, color=color, linewidth=0.5, alpha=0.2)
            intervals = [mean_interval(column[np.isfinite(column)].tolist()) for column in relative.T]
            bounds = np.array([[each.mean, each.low, each.high] for each in intervals], np.float64)
            axes.plot(middle, bounds[:, 0], "o-", color=color, label=condition)
            axes.vlines(middle, bounds[:, 1], bounds[:, 2], color=color, linewidth=2)
        axes.legend(frameon=False)
        axes.set_xlabel("weight of water (the weight of food is 1)")
        axes.set_ylabel("founders' relative intake of food")
    caption = "A pale line for each world; means over worlds, from five on with 95 % intervals."
    return NamedFigure(NAME, question, figure, caption)


STUDY = Study(
    NAME,
    "Optimal reward",
    "Singh et al. (2010), 10.1109/TAMD.2010.2051031: the best reward for a learner also pays for what is only a means "
    "to its goal. Is a liking for water fit if food needs water?",
    (
        Item(
            NAME,
            "Fitness of a liking for water",
            "The best reward pays for means, too.",
            make,
            tuple(CONDITIONS.values()),
            SCALE,
        ),
    ),
    (FOLDER / "expected.md").read_text(encoding="utf-8"),
)
