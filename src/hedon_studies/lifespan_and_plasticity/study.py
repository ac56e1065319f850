"""Do short lives and changing worlds make agents learn faster? README.md has the claim, the rule and the deviations."""

import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, last_mean, make_table, mean_lifetime
from hedon.figure import NamedFigure
from hedon.study import Condition, Item, ItemInputs, Scale, Study, missing, missing_note
from hedon_studies.rule import Test, mean_test, slope_test, verdict_table

FOLDER = Path(__file__).parent
SETTINGS = tomllib.loads((FOLDER / "study.toml").read_text(encoding="utf-8"))
CONSTANT, CHANGING = SETTINGS["worlds"]
GENE, NEUTRAL = "g_learning_rate", "neutral_1"
SCALE = Scale(tuple(range(1, SETTINGS["seeds"] + 1)), SETTINGS["steps"])


def _condition(world: str, hazard: float) -> Condition:
    longer = f"hazard.schedule.scale.points=[[0, {hazard}]]"
    changes = (*SETTINGS["overrides"], *SETTINGS["worlds"][world], longer)
    return Condition(f"{world}, {hazard:g} times the hazard", "relocation", changes)


CONDITIONS = {
    (world, hazard): _condition(world, hazard) for world in SETTINGS["worlds"] for hazard in SETTINGS["hazards"]
}


def measure(world: WorldRecord) -> dict[str, Any]:
    """The evolved learning rate, a neutral gene, and how long agents lived [step]; None if no agent died."""
    return {
        "seed": world.seed,
        "died out": world.extinct_step is not None,
        "rate": last_mean(GENE, world),
        "neutral": last_mean(NEUTRAL, world),
        "lifetime": mean_lifetime(world.agents, born_in_run=True),
    }


def named_tests(rows: Sequence[dict[str, Any]]) -> tuple[Test, Test]:
    """The tests of both claims, from the rows of all worlds."""
    measured = [row for row in rows if row["rate"] is not None and row["lifetime"]]
    constant = [row for row in measured if row["world"] == CONSTANT]
    slope = slope_test(
        "shorter lives, larger rates: slope of log10 rate over log10 lifetime",
        [np.log10(row["lifetime"]) for row in constant],
        [row["rate"] for row in constant],
        sum(row["died out"] for row in constant),
        above=False,
    )
    rates = {(row["world"], row["hazard"], row["seed"]): row for row in rows if row["rate"] is not None}
    pairs = [
        (row, rates[CHANGING, hazard, seed])
        for (world, hazard, seed), row in rates.items()
        if world == CONSTANT and (CHANGING, hazard, seed) in rates
    ]
    difference = mean_test(
        "constant worlds, less learning: log10 rate, changing less constant",
        [after["rate"] - before["rate"] for before, after in pairs],
        len(pairs),
        sum(row["died out"] for pair in pairs for row in pair),
        above=True,
    )
    return slope, difference


def make(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure, and the tables of answers and of worlds."""
    question = "Do short lives and changing worlds make agents learn faster?"
    rows = [
        {"world": world, "hazard": hazard} | measure(record)
        for (world, hazard), condition in CONDITIONS.items()
        for record in inputs.worlds.get(condition.label, ())
    ]
    if not rows:
        note = missing(CONDITIONS.values(), inputs)
        yield NamedFigure("lifespan-and-plasticity", question, hedon.figure.draw_message("no worlds yet"), note)
        return
    tests = named_tests(rows)
    note = missing_note(inputs, tuple(CONDITIONS.values()), SCALE)
    yield draw_rates(question, rows, tests[0])
    yield verdict_table("lifespan_verdict", tests, note)
    yield make_table("lifespan_world", "Each world: log10 of the rate over its setting", rows, shown=False)


def draw_rates(question: str, rows: Sequence[dict[str, Any]], slope: Test) -> NamedFigure:
    """Draws the evolved rate of learning over the lifetime of agents, a point per world that has both numbers."""
    rows = [row for row in rows if row["lifetime"] and row["rate"] is not None]
    with hedon.figure.styled():
        figure = hedon.figure.new_figure(5.6, 3.6)
        axes = figure.subplots()
        for world, color in ((CONSTANT, hedon.figure.BLUE), (CHANGING, hedon.figure.ORANGE)):
            for row in rows:
                if row["world"] == world:
                    marker = "x" if row["died out"] else "o"
                    axes.plot(row["lifetime"], row["rate"], marker, color=color, markersize=4)
            axes.plot([], [], "o", color=color, label=world)
        axes.axhline(0.0, linewidth=0.8)
        if rows:  # an empty axis has no logarithm
            axes.set_xscale("log")
        axes.set_xlabel("mean lifetime [step]")
        axes.set_ylabel("evolved learning rate, log10 of its factor")
        axes.legend(loc="best")
    caption = (
        "A world each; a cross: died out. 0: the setting. Slope over constant worlds, per decade of lifetime: "
        f"{slope.said}."
    )
    return NamedFigure("lifespan-and-plasticity", question, figure, caption)


STUDY = Study(
    "lifespan-and-plasticity",
    "Lifespan and plasticity",
    "Kozielska & Weissing (2024), 10.1371/journal.pcbi.1011840: shorter lives select for larger learning rates, "
    "constant worlds for less learning. Is it so where agents are born, learn and die in one world?",
    (
        Item(
            "lifespan-and-plasticity",
            "Evolved rates of learning, by lifespan",
            "Shorter lives: larger rates. Constant worlds: less learning.",
            make,
            tuple(CONDITIONS.values()),
            SCALE,
        ),
    ),
    (FOLDER / "expected.md").read_text(encoding="utf-8"),
)
