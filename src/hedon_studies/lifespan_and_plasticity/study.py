"""Do shorter lives favor faster learning? README.md has the claim, the rule and the deviations."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

import hedon.assay
import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, make_table, mean_alive
from hedon.figure import NamedFigure
from hedon.statistic import mean_interval
from hedon.study import Condition, Item, ItemInputs, Scale, Study, missing_note
from hedon_studies.condition import each_condition, measured_rows, no_worlds
from hedon_studies.founder import fitness_slope, known_mean, spread_gene
from hedon_studies.rule import Test, mean_test, verdict_table

FOLDER = Path(__file__).parent
NAME = "lifespan-and-plasticity"
GENE = "g_learning_rate"
RANGE = (-1.0, 1.5)
"""Bounds of the founders' genes, except the two weights."""
WEIGHTS = {"w_normal": 1.0, "w_action": 0.0}
"""The weights of all founders."""
HAZARDS = (0.5, 1.0, 2.0, 4.0)
"""Factors by which the hazard is multiplied."""
BINS = np.linspace(*RANGE, 6)
"""Edges of the ranges of the gene for which mean numbers of children are listed."""
SCALE = Scale(tuple(range(1501, 1531)), 32_768)

CONDITIONS = {
    hazard: Condition(
        f"{hazard:g} times the hazard",
        "appetite",
        (
            "genome.learning.learning_rate.initial_mean=0",
            "genome.mutation_scale=0",
            f"hazard.schedule.scale.points=[[0, {hazard}]]",
        ),
        founders=partial(spread_gene, low=RANGE[0], high=RANGE[1], fixed=WEIGHTS),
    )
    for hazard in HAZARDS
}


def measure(world: WorldRecord) -> dict[str, Any]:
    """The measures of one world.

    Returns:
        "lifespan": mean number of steps that the founders lived. "unfinished": share of founders alive at the end.
        "alive": mean number of agents alive. "slope": slope of the founders' relative number of children on the gene.
        "children": their mean relative number of children in each range of `BINS`. A slope for each neutral gene.
    """
    founders = hedon.assay.founder_outcomes(world.agents, world.weight_names, world.last_step)
    children = founders["offspring"].to_numpy().astype(np.float64)
    genes, lifespans = founders[GENE].to_numpy(), founders["lifespan"].to_numpy()
    bins = np.digitize(genes, BINS[1:-1])
    relative = children / children.mean() if children.mean() > 0 else np.full_like(children, np.nan)
    return {
        "seed": world.seed,
        "died out": world.extinct_step is not None,
        "lifespan": float(lifespans.mean()),
        "unfinished": float((lifespans >= world.last_step).mean()),
        "alive": mean_alive(world.population),
        "slope": fitness_slope(genes, children),
        "children": [known_mean(relative[bins == i]) for i in range(len(BINS) - 1)],
        **{name: fitness_slope(founders[name].to_numpy(), children) for name in world.neutral_names},
    }


def trends(rows: Sequence[Mapping[str, Any]], key: str = "slope") -> list[float]:
    """How a slope changes per doubling of the hazard, for each seed with a value at each hazard.

    Args:
        rows: Rows of worlds, each with "hazard", "seed" and the slope.
        key: Column of the slope.

    Returns:
        For each seed, the least-squares slope on the binary logarithm of the hazard.
    """
    by_seed: dict[int, dict[float, float]] = {}
    for row in rows:
        if row[key] is not None:
            by_seed.setdefault(row["seed"], {})[row["hazard"]] = row[key]
    doublings = np.log2(HAZARDS)
    complete = (found for found in by_seed.values() if found.keys() >= set(HAZARDS))
    return [float(np.polyfit(doublings, [found[hazard] for hazard in HAZARDS], 1)[0]) for found in complete]


def named_test(rows: Sequence[Mapping[str, Any]]) -> Test:
    """The test of the claim, from the rows of all worlds."""
    complete = [seed for seed, count in Counter(row["seed"] for row in rows).items() if count == len(HAZARDS)]
    extinct = sum(row["died out"] for row in rows if row["seed"] in complete)
    name = "shorter lives, larger rates: change of the slope on the gene per doubling of the hazard"
    return mean_test(name, trends(rows), len(complete), extinct, above=True)


def control_rows(rows: Sequence[Mapping[str, Any]], neutral: Sequence[str]) -> list[dict[str, Any]]:
    """Negative control: the same test with each neutral gene in place of the learning rate.

    Args:
        rows: Rows of worlds.
        neutral: Names of the neutral genes.
    """
    tests = {gene: mean_test(gene, trends(rows, gene), 0, 0, above=True) for gene in neutral}
    return [{"gene": gene, "effect": t.effect, "low": t.low, "high": t.high, "p": t.p} for gene, t in tests.items()]


def hazard_rows(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """A row for each hazard: how long founders live, and what their gene is worth, as means over worlds."""
    found = []
    for hazard, worlds in each_condition(rows, CONDITIONS, "hazard"):
        bounds = mean_interval(row["slope"] for row in worlds)
        means = {key: mean_interval(row[key] for row in worlds).mean for key in ("lifespan", "unfinished", "alive")}
        children = {
            f"{low:g} to {high:g}": mean_interval(row["children"][i] for row in worlds).mean
            for i, (low, high) in enumerate(pairwise(BINS))
        }
        found.append(
            {"hazard": hazard, "worlds": len(worlds), **means}
            | {"slope": bounds.mean, "low": bounds.low, "high": bounds.high}
            | children
        )
    return found


def make(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure, and the tables of the answer, of hazards, of neutral genes and of worlds."""
    question = "Do shorter lives favor faster learning?"
    rows = measured_rows(inputs, CONDITIONS, measure, "hazard")
    if not rows:
        yield no_worlds(NAME, question, inputs, CONDITIONS)
        return
    yield from results(question, rows, missing_note(inputs, tuple(CONDITIONS.values()), SCALE))


def results(question: str, rows: Sequence[Mapping[str, Any]], note: str = "") -> Iterator[NamedFigure | ResultTable]:
    """The figure and the tables.

    Args:
        question: Title of the figure.
        rows: Rows of worlds.
        note: Remark below the table of the answer.
    """
    yield draw_slopes(question, rows)
    yield verdict_table("lifespan_verdict", (named_test(rows),), note)
    yield make_table("lifespan_hazard", "Each hazard: relative number of children, by the gene", hazard_rows(rows))
    neutral = [name for name in rows[0] if name.startswith("neutral_")]
    title = "Negative control: the same test with each neutral gene"
    yield make_table("lifespan_control", title, control_rows(rows, neutral), shown=False)
    plain = [{key: value for key, value in row.items() if key != "children"} for row in rows]
    yield make_table("lifespan_world", "Each world: its founders, and slopes on their genes", plain, shown=False)


def draw_slopes(question: str, rows: Sequence[Mapping[str, Any]]) -> NamedFigure:
    """Draws the slope on the gene over the lifespan of founders: a dot for each world, and means with intervals."""
    with hedon.figure.styled():
        figure = hedon.figure.new_figure(5.6, 3.6)
        axes = figure.subplots()
        hedon.figure.draw_zero_line(axes)
        measured = [row for row in rows if row["slope"] is not None]
        for row in measured:
            marker = "x" if row["died out"] else "o"
            axes.plot(row["lifespan"], row["slope"], marker, color=hedon.figure.PALE, markersize=3)
        for row in hazard_rows(measured):
            bounds = np.array([row["low"], row["high"]], np.float64)  # None becomes NaN
            axes.plot([row["lifespan"]] * 2, bounds, color=hedon.figure.BLUE, linewidth=2)
            axes.plot(row["lifespan"], row["slope"], "o", color=hedon.figure.BLUE, markersize=6)
        if measured:  # an empty axis has no logarithm
            axes.set_xscale("log")
        axes.set_xlabel("mean lifespan of founders [step]")
        axes.set_ylabel("slope of relative children on the gene")
    caption = "A dot for each world, a cross if it died out; means over worlds, from five on with 95 % intervals."
    return NamedFigure(NAME, question, figure, caption)


STUDY = Study(
    NAME,
    "Lifespan and plasticity",
    "Kozielska & Weissing (2024), 10.1371/journal.pcbi.1011840: shorter lives select for larger learning rates. Is it "
    "so where agents are born, learn and die in one world?",
    (
        Item(
            NAME,
            "Fitness of the learning rate, by lifespan",
            "A shorter lifespan leads to larger learning rates.",
            make,
            tuple(CONDITIONS.values()),
            SCALE,
        ),
    ),
    (FOLDER / "expected.md").read_text(encoding="utf-8"),
)
