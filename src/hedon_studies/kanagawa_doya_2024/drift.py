"""Study: in which of the paper's conditions did weights move further, or more in one direction, than under drift?"""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

import hedon.figure
from hedon.analysis import LAST_AGENTS, SEED, ResultTable, WorldDrift, drift_tests, make_table, standard_drift
from hedon.figure import NamedFigure
from hedon.statistic import FOR_INTERVAL
from hedon.study import Condition, Item, ItemInputs, Scale, missing_note, present, sentences
from hedon_studies.kanagawa_doya_2024.condition import PAPER_SCALE, PLACES, POISON, POOR, SIZES

CONDITIONS = (*SIZES, *PLACES[1:], POOR, POISON)
REWARDS = {"w_normal": "weight of food", "w_action": "weight of action"}
"""The weights that all conditions have."""
NEUTRAL = {"neutral_1": "neutral gene"}
ALL = "all conditions"
_BOUNDS = ("low", "high", "drift_low", "drift_high")

_TESTS = (
    "A score is the standard normal score of a world's mean weight (5000 agents born last) among neutral genes that "
    "mutate along the same pedigree. direction: the mean score, 0 under drift, with Stouffer's p; distance and held: "
    "the root mean square score, 1 under drift, below 1 where a weight was held back, with the chi-squared p of a "
    "larger one (distance) or of a smaller one (held). Intervals are Student's t and chi-squared; drift_low and "
    "drift_high are those of the mean score by the spread of drift itself, 1, as p takes it. p_holm is corrected for "
    "all weights and all three tests."
)
_SHARED = (
    "Worlds of one seed share founders and the mutations of agents of equal number in all conditions, so that they are "
    "not quite independent; the neutral gene, which nothing selects, shows what that alone would do."
)
_DRAWN = (
    "A point is a world, by the color of its seed; the band holds 95 % of drifting genes. Below, the mean over all "
    "worlds with its 95 % interval."
)

Scores = Mapping[str, Mapping[int, Sequence[WorldDrift]]]
"""The drift of each weight by condition and seed; worlds without a complete pedigree are left out."""


def make_drift(
    conditions: Sequence[Condition], rewards: Mapping[str, str], scale: Scale, name: str, inputs: ItemInputs
) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure and the tables of scores against drift.

    Args:
        conditions: Conditions of the study.
        rewards: Titles of the weights, by genome column.
        scale: Number and length of the worlds that the study needs.
        name: Name of the item.
        inputs: Data with the worlds.
    """
    worlds = present(conditions, inputs)
    scores = {
        label: {w.seed: drifts for w in group if (drifts := standard_drift(w, LAST_AGENTS))}
        for label, group in worlds.items()
    }
    note = missing_note(inputs, conditions, scale)
    groups = {ALL: [drifts for by_seed in scores.values() for drifts in by_seed.values()]}
    groups |= {label: list(by_seed.values()) for label, by_seed in scores.items()}
    tests = {label: list(_test_rows(label, group, rewards)) for label, group in groups.items()}
    question = "Which weights went further, or more in one direction, than drift?"
    if groups[ALL]:
        means = {row["weight"]: row for row in tests[ALL] if row["test"] == "direction"}
        figure = hedon.figure.draw_scores(_points(scores), {**rewards, **NEUTRAL}, means)
        yield NamedFigure(name, question, figure, _DRAWN)
    yield make_table(
        f"{name}_all", "Weights against drift, all conditions", tests.pop(ALL), sentences(_TESTS, _SHARED, note)
    )
    by_condition = [row for rows in tests.values() for row in rows if row["test"] == "direction"]
    yield make_table(f"{name}_condition", "Weights against drift, by condition", by_condition, _TESTS)
    yield make_table(f"{name}_world", "Weights against drift, world by world", _world_rows(scores))


def _test_rows(
    label: str, worlds: Sequence[Sequence[WorldDrift]], rewards: Mapping[str, str]
) -> Iterator[dict[str, Any]]:
    """Both tests of each weight, without bounds below five worlds."""
    names = {**rewards, **NEUTRAL}
    matching = [[drift for drift in world if drift.weight in names] for world in worlds]
    for test in drift_tests(matching, list(rewards), list(NEUTRAL), {}, np.random.default_rng(SEED)):
        if test.test == "recorded":
            continue
        positive = sum(drift.score > 0 for world in matching for drift in world if drift.weight == test.weight)
        row = {
            "condition": label,
            "weight": test.weight,
            "test": test.test,
            "worlds": test.worlds,
            "positive": positive,
        }
        row |= {name: getattr(test, name) for name in ("effect", *_BOUNDS, "p", "p_holm")}
        yield row if test.worlds >= FOR_INTERVAL else row | dict.fromkeys(_BOUNDS)


def _world_rows(scores: Scores) -> Iterator[dict[str, Any]]:
    for label, by_seed in scores.items():
        for seed, drifts in by_seed.items():
            for drift in drifts:
                yield {"condition": label, "seed": seed} | vars(drift)


def _points(scores: Scores) -> dict[str, dict[int, dict[str, float]]]:
    """The score of each weight by condition and seed."""
    return {
        label: {seed: {drift.weight: drift.score for drift in drifts} for seed, drifts in by_seed.items()}
        for label, by_seed in scores.items()
    }


DRIFT = Item(
    "drift",
    "Rewards against drift",
    "The paper compares no weight with what drift alone would do. Over all of its conditions, does selection move "
    "the weights of food and of action?",
    partial(make_drift, CONDITIONS, REWARDS, PAPER_SCALE, "drift"),
    CONDITIONS,
    PAPER_SCALE,
)
