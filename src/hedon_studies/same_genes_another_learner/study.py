"""Does it depend on how agents learn which reward is fit? README.md has the question, expected.md the design."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import polars as pl
from lazy_loader import load

import hedon.assay
import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, make_table
from hedon.config import Config
from hedon.figure import NamedFigure
from hedon.record import Founders
from hedon.study import Condition, Item, ItemInputs, Scale, Study, missing, missing_note
from hedon_studies.same_genes_another_learner import evolution, landscape
from hedon_studies.same_genes_another_learner.answer import EVOLUTION, LANDSCAPE, answer_table
from hedon_studies.same_genes_another_learner.evolution import EVOLVING, PRESET, SEEN
from hedon_studies.same_genes_another_learner.landscape import ACTION, FOOD, SIGHT

# Imported late: Matplotlib is slow to import.
drawing: Any = load("hedon_studies.same_genes_another_learner.drawing", suppress_warning=True)

FOLDER = Path(__file__).parent
RANGE = (-2.0, 2.0)
"""Bounds of the founders' genes in part A."""
_LANDSCAPE = ("learner-landscape", "Does the direction of the fittest reward depend on the learner?")
_EVOLUTION = ("learner-evolution", "Does evolution follow the landscapes?")
LANDSCAPE_SCALE, EVOLUTION_SCALE = Scale(tuple(range(1001, 1031)), 20_480), Scale(tuple(range(1101, 1161)), 184_320)


def _spread(config: Config) -> Founders:
    """The founders of `hedon assay landscape --range=-2:2`."""
    return hedon.assay.spread_founders(config, hedon.assay.Spread(*RANGE), next(iter(config.species)))


LANDSCAPES = {
    arm: Condition(arm, PRESET, (SEEN, *filter(None, [setting]), "genome.mutation_scale=0"), founders=_spread)
    for arm, setting in landscape.ARMS.items()
}
LEARNERS = {
    arm: Condition(f"{arm}, evolving", PRESET, (*EVOLVING, f"learning.learning_rate={rate:g}"))
    for arm, rate in evolution.ARMS.items()
}


def founders_of(worlds: Sequence[WorldRecord]) -> pl.DataFrame:
    """The founders of an arm with their genes and outcomes.

    Returns:
        One row per founder: "seed", "agent_id", the genes, "descendants", "offspring", "food" and "lifespan".
    """
    tables = [hedon.assay.founder_outcomes(world.agents, world.weight_names, world.last_step) for world in worlds]
    return pl.concat(
        table.select(pl.lit(world.seed, pl.Int64).alias("seed"), pl.all())
        for world, table in zip(worlds, tables, strict=True)
    )


def make_landscape(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure and the tables of the slopes of fitness under each learner."""
    absent = missing(LANDSCAPES.values(), inputs)
    if absent:
        yield NamedFigure(*_LANDSCAPE, hedon.figure.draw_message("not all worlds yet"), absent)
        return
    arms = {arm: founders_of(inputs.worlds[condition.label]) for arm, condition in LANDSCAPES.items()}
    note = missing_note(inputs, tuple(LANDSCAPES.values()), LANDSCAPE_SCALE)
    yield from landscape_results(arms, note, complete=_is_complete(inputs, LANDSCAPES.values(), LANDSCAPE_SCALE))


def _is_complete(inputs: ItemInputs, conditions: Iterable[Condition], scale: Scale) -> bool:
    """Whether all worlds of a part have run to their end."""
    worlds = [inputs.worlds.get(condition.label, ()) for condition in conditions]
    return all(
        {world.seed for world in group} >= set(scale.seeds)
        and all(world.extinct_step is not None or world.last_step >= scale.steps for world in group)
        for group in worlds
    )


def landscape_results(
    arms: Mapping[str, pl.DataFrame], note: str = "", *, complete: bool
) -> Iterator[NamedFigure | ResultTable]:
    """The figure and the tables of part A.

    Args:
        arms: Founders of each arm with their genes and outcomes.
        note: Remark below the table of tests.
        complete: Whether all worlds have run.
    """
    slopes = {arm: landscape.slopes(founders, "food") for arm, founders in arms.items()}
    yield NamedFigure(
        *_LANDSCAPE,
        drawing.draw_slopes(slopes),
        "Slopes of relative food intake on the weights of food and of its sight: means over worlds, from five on with "
        "95 % intervals. Above the dashed line, liking the sight of food adds more than liking food itself.",
    )
    tests = landscape.named_tests(arms)
    repeats = f"The landscapes {'repeat' if landscape.repeats_the_pilots(tests) else 'do not repeat'} the pilots."
    yield answer_table("learner_landscape_verdict", tests, LANDSCAPE, f"{repeats} {note}".strip(), complete=complete)
    control = landscape.neutral_control(arms).iter_rows(named=True)
    control_note = "excluding_0: neutral genes whose interval over worlds excludes 0; one in twenty is expected."
    yield make_table("learner_landscape_control", "Negative control: slopes on neutral genes", control, control_note)
    worlds = [
        {"arm": arm} | row | {"hump": hump}
        for arm, founders in arms.items()
        for row, hump in zip(
            slopes[arm].iter_rows(named=True), _humps(founders, slopes[arm]["seed"].to_list()), strict=True
        )
    ]
    title = "Each world: slopes of relative food intake, and the hump in living descendants"
    yield make_table("learner_landscape_world", title, worlds, shown=False)


def _humps(founders: pl.DataFrame, seeds: Sequence[int]) -> list[float | None]:
    """The hump of each world; None in a world without founders that like food."""
    humps = dict(landscape.hump(founders).iter_rows())
    return [humps.get(seed) for seed in seeds]


def make_evolution(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure and the tables of the weights that evolve under the slow and the fast learner."""
    rows = [
        evolution.measure(world) for condition in LEARNERS.values() for world in inputs.worlds.get(condition.label, ())
    ]
    survivors = {row["arm"] for row in rows if row["extinct_step"] is None}
    if survivors != set(LEARNERS):
        note = missing(LEARNERS.values(), inputs) or "All worlds of an arm died out."
        yield NamedFigure(*_EVOLUTION, hedon.figure.draw_message("not all worlds yet"), note)
        return
    worlds = pl.DataFrame(rows, infer_schema_length=None)
    note = missing_note(inputs, tuple(LEARNERS.values()), EVOLUTION_SCALE)
    yield from evolution_results(worlds, note, complete=_is_complete(inputs, LEARNERS.values(), EVOLUTION_SCALE))


def evolution_results(worlds: pl.DataFrame, note: str = "", *, complete: bool) -> Iterator[NamedFigure | ResultTable]:
    """The figure and the tables of part B.

    Args:
        worlds: Rows of worlds, as in `worlds.csv`.
        note: Remark below the table of tests.
        complete: Whether all worlds have run.
    """
    caption = (
        "A dot for each world: mean weights among the living at the end. On a line through 0, rewards have one "
        "direction; the colored lines show the mean directions."
    )
    yield NamedFigure(*_EVOLUTION, drawing.draw_ends(worlds), caption)
    yield answer_table("learner_evolution_verdict", evolution.named_tests(worlds), EVOLUTION, note, complete=complete)
    control = evolution.neutral_control(worlds).iter_rows(named=True)
    title = "Negative control: the primary test with each neutral gene in place of sight"
    yield make_table("learner_evolution_control", title, control, shown=False)
    shown = ["arm", "seed", "extinct_step", "alive_all_steps", "mean_lifetime", "food_per_step", "generation"]
    scores = [f"{gene}{end}" for gene in (SIGHT, FOOD, ACTION) for end in ("", "_score")]
    ends = worlds.select(*shown, *scores).iter_rows(named=True)
    yield make_table("learner_evolution_world", "Each world: its agents, and the living at its end", ends, shown=False)


STUDY = Study(
    "same-genes-another-learner",
    "Same genes, another learner",
    "Our own question: for founders with the same genes, does it depend on how they learn which reward is fit, and "
    "does evolution follow?",
    (
        Item(
            "learner-landscape",
            "Fitness of liking food and its sight, for six learners",
            "The sight of food matters more, relative to food itself, to a fast learner than to a slow one.",
            make_landscape,
            tuple(LANDSCAPES.values()),
            LANDSCAPE_SCALE,
        ),
        Item(
            "learner-evolution",
            "Rewards that evolve under a slow and a fast learner",
            "Under the fast learner, the evolved reward points further toward the sight of food.",
            make_evolution,
            tuple(LEARNERS.values()),
            EVOLUTION_SCALE,
        ),
    ),
    (FOLDER / "expected.md").read_text(encoding="utf-8"),
)
