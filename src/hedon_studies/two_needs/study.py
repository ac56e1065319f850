"""Is it fitter to be rewarded for reducing a drive than for each meal? README.md has the claim and the rule."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, make_table, mean_alive
from hedon.assay import by_gene, world_lines
from hedon.figure import NamedFigure
from hedon.statistic import mean_interval
from hedon.study import Condition, Item, ItemInputs, Scale, Study, missing_note
from hedon_studies.condition import each_condition, measured_rows, no_worlds
from hedon_studies.rule import Test, by_seed, mean_test, pair_test, verdict_table

FOLDER = Path(__file__).parent
NAME = "two-needs"
GENE = "w_drive_reduction"
SCALE = Scale(tuple(range(1801, 1831)), 40_960)
WORLD = (
    "arena.width=480",
    "arena.height=320",
    "population.capacity=150",
    "population.initial_count=120",
    "hazard.alpha_age=5e-5",
    "birth.kappa=2e-3",
    "genome.mutation_scale=0",
    *(
        f"food.{kind}.{setting}"
        for kind in ("normal", "water")
        for setting in ("growth_rate=2", "capacity=200", "initial_count=200")
    ),
)
"""A small world with much food of two kinds."""
ENERGY = (
    "energy.capacity=20",
    "energy.initial=10",
    "energy.scale=20",
    "energy.set_point.initial_mean=1",
    "energy.set_point.initial_sd=0",
    "reward.drive_reduction_coef=1e-6",  # not 0, without which there is no drive whose reduction a weight could pay
    "reward.pay.drive_reduction.coef=20",  # so that a meal that fills the only need pays as much as one per meal
)
"""A store of energy that 20 meals fill, and drives toward a full one."""
STORE = (
    "food.water.gives={water=1}",
    "store.water.capacity=20",
    "store.water.initial=10",
    "store.water.scale=20",
    "store.water.basic_cost=0.006",
    "store.water.hazard_weight=1",
    "store.water.child_share=0.5",
    "store.water.set_point.initial_mean=1",
    "store.water.set_point.initial_sd=0",
)
"""A second need: without water, agents die as they do without energy."""
TWO, ONE, ADDITIVE, PAID = "two needs", "one need", "two needs, additive drive", "two needs, larger pay"
NEEDS = {
    TWO: STORE,
    ONE: ("food.water.gives={energy=1}",),
    ADDITIVE: (*STORE, "reward.drive_exponent=1", "reward.drive_root=1"),
    # Times the square root of 2: a meal then pays 1 if both stores lack as much, as with an additive drive.
    PAID: (*STORE, "reward.pay.drive_reduction.coef=28.284"),
}
FOLLOW_UP = "Planned after the three tests, tested by itself, and no part of the answer."
REDUCERS = {GENE: 1.0, "w_normal": 0.0, "w_water": 0.0, "w_action": 0.0}
"""Genes of agents that are paid for reducing the drive."""
EATERS = {GENE: 0.0, "w_normal": 1.0, "w_water": 1.0, "w_action": 0.0}
"""Genes of agents that are paid for each meal."""


def _half(genes: Mapping[str, float]) -> str:
    return ",".join(f"{name.removeprefix('w_')}={value:g}" for name, value in genes.items()) + ":0.5"


CONDITIONS = {
    name: Condition(name, "appetite", (*WORLD, *ENERGY, *need), founders=f"{_half(REDUCERS)},{_half(EATERS)}")
    for name, need in NEEDS.items()
}


def measure(world: WorldRecord) -> dict[str, Any]:
    """The measures of one world.

    Returns:
        "change": share of reducers at the end, less the share at the start. "generations": mean generation of those
        alive at the end. "alive": mean number of agents alive. For each group, its "food" and "water": pieces eaten
        per 1,000 steps of life; None where records were cut before the agents died.
    """
    agents = world.agents.sort("agent_id")
    lines = world_lines(agents, world.seed, by_gene(agents, REDUCERS, EATERS), world.last_step)
    steps = (agents["death_step"].fill_null(world.last_step) - agents["birth_step"].clip(0)).to_numpy()
    reduces = agents[GENE].to_numpy() > 0.5
    rates: dict[str, float | None] = {}
    for group, chosen in (("reducers", reduces), ("eaters", ~reduces)):
        for name, kind in (("food", "normal"), ("water", "water")):
            eaten = float(agents[f"eaten_{kind}"].to_numpy()[chosen].sum())
            rates[f"{group} {name}"] = 1000 * eaten / max(int(steps[chosen].sum()), 1) if np.isfinite(eaten) else None
    return {
        "seed": world.seed,
        "died out": world.extinct_step is not None,
        "change": float(lines.share[-1] - lines.share[0]),
        "generations": float(lines.generation[-1]),
        "alive": mean_alive(world.population),
        **rates,
    }


def named_tests(rows: Sequence[Mapping[str, Any]]) -> list[Test]:
    """The three tests, from the rows of all worlds, each with "condition", "seed", "died out" and "change"."""
    two = [row for row in rows if row["condition"] == TWO]
    changes, extinct = by_seed(rows, TWO, "change"), sum(row["died out"] for row in two)
    growth = "with two needs, drive reduction is fitter: change of its share"
    more = "its share grows more than with {}: difference of changes"
    return [
        mean_test(growth, list(changes.values()), len(two), extinct, above=True),
        pair_test(more.format("one need"), rows, (TWO, ONE), "change"),
        pair_test(more.format("an additive drive"), rows, (TWO, ADDITIVE), "change"),
    ]


def follow_up(rows: Sequence[Mapping[str, Any]]) -> Test:
    """The test of the follow-up: whether drives are fitter if they pay more."""
    return pair_test("larger pay makes drive reduction fitter: difference of changes", rows, (PAID, TWO), "change")


def condition_rows(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """A row for each condition, with means over worlds."""
    found = []
    for condition, worlds in each_condition(rows, CONDITIONS):
        bounds = mean_interval(row["change"] for row in worlds)
        keys = [key for key in worlds[0] if key not in ("condition", "seed", "died out", "change")]
        means = {key: mean_interval(row[key] for row in worlds).mean for key in keys}
        found.append(
            {"condition": condition, "worlds": len(worlds)}
            | {"change": bounds.mean, "low": bounds.low, "high": bounds.high}
            | means
        )
    return found


def make(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure, and the tables of the answer, of conditions and of worlds."""
    question = "Is drive reduction fitter than pay per meal?"
    rows = measured_rows(inputs, CONDITIONS, measure)
    if not rows:
        yield no_worlds(NAME, question, inputs, CONDITIONS)
        return
    yield draw_changes(question, rows)
    note = missing_note(inputs, tuple(CONDITIONS.values()), SCALE)
    yield verdict_table("two_needs_verdict", named_tests(rows), note)
    yield verdict_table("two_needs_follow_up_verdict", (follow_up(rows),), FOLLOW_UP)
    yield make_table("two_needs_condition", "Each condition: means over worlds", condition_rows(rows))
    yield make_table("two_needs_world", "Each world: how the share of reducers changed", rows, shown=False)


def draw_changes(question: str, rows: Sequence[Mapping[str, Any]]) -> NamedFigure:
    """Draws the change of the share of reducers in each condition: a dot for each world, and means with intervals."""
    with hedon.figure.styled():
        figure = hedon.figure.new_figure(5.6, 3.2)
        axes = figure.subplots()
        hedon.figure.draw_zero_line(axes)
        for place, condition in enumerate(CONDITIONS):
            worlds = [row for row in rows if row["condition"] == condition]
            spread = np.linspace(-0.25, 0.05, len(worlds)) + place
            for x, row in zip(spread, worlds, strict=True):
                marker = "x" if row["died out"] else "o"
                axes.plot(x, row["change"], marker, color=hedon.figure.PALE, markersize=3)
            interval = mean_interval(row["change"] for row in worlds)
            bounds = np.array([interval.low, interval.high], np.float64)  # None becomes NaN
            axes.plot([place + 0.15] * 2, bounds, color=hedon.figure.BLUE, linewidth=2)
            if interval.mean is not None:
                axes.plot(place + 0.15, interval.mean, "o", color=hedon.figure.BLUE, markersize=6)
        axes.set_xticks(range(len(CONDITIONS)), [name.replace(", ", ",\n") for name in CONDITIONS])
        axes.set_ylabel("change of the share of reducers")
    caption = "A dot for each world, a cross if it died out; means over worlds, from five on with 95 % intervals."
    return NamedFigure(NAME, question, figure, caption)


STUDY = Study(
    NAME,
    "Two needs",
    "Keramati & Gutkin (2014), 10.7554/eLife.04811: rewards are reductions of a drive, the distance of all needs from "
    "their set points. Is such a reward fitter than pay per meal, and only where there are two needs?",
    (
        Item(
            NAME,
            "Drive reduction against pay per meal",
            "Reward is the reduction of a drive.",
            make,
            tuple(CONDITIONS.values()),
            SCALE,
        ),
    ),
    (FOLDER / "expected.md").read_text(encoding="utf-8"),
)
