"""Study: does the entropy bonus determine how large the weight of food must be?"""

from collections.abc import Iterator, Sequence

import polars as pl

from hedon.analysis import ResultTable, WorldRecord, history, make_table
from hedon.figure import NamedFigure
from hedon.measure import RESPONSES, Measure
from hedon.study import (
    Condition,
    Item,
    ItemInputs,
    Scale,
    change,
    missing_note,
    present,
    read_change,
    sentences,
    stack,
    world_indices,
    world_rows,
)
from hedon_studies.kanagawa_doya_2024 import figure
from hedon_studies.kanagawa_doya_2024.analysis.appetite import WINDOWS, appetite, half_way_weight

WITH, WITHOUT = "entropy 0.001", "entropy 0"
CONDITIONS = (
    Condition(WITH, fidelity="corrected"),
    Condition(WITHOUT, overrides=("learning.entropy_coef=0.0",), fidelity="corrected"),
)
SCALE = Scale((1, 2), 1_024_000)
_HALF_WAY = Measure(
    "half_way_weight",
    "weight of food at which agents eat half-way to the best",
    lambda world: half_way_weight(appetite(world)),
)
_ASKED = (*RESPONSES, _HALF_WAY)

_DIFFERENCE = (
    f"{read_change(WITH, WITHOUT)} half_way_weight: the weight of food at which agents eat half-way between those with "
    "negative weights and those of the best bin."
)
_APPETITE = (
    f"Agents that died with a life of at least {WINDOWS} windows of learning. eaten: foods per 1000 steps lived. "
    "Agents with larger weights were mostly born later, into other company."
)

_DRAWN = (
    f"Left, foods eaten by agents of like weight of food, over lives of at least {WINDOWS} windows of learning: the "
    "further left a curve rises, the smaller a weight is enough. Right, the mean weight of food of the living over "
    "time. Thin lines are worlds, thick lines are means over the worlds of a condition, at the left where more than "
    "half of them have such agents; the band is a 95 % interval, from five worlds on."
)


def make_entropy(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    missing = missing_note(inputs, CONDITIONS, SCALE)
    worlds = present(CONDITIONS, inputs)
    bins = {label: [appetite(world) for world in group] for label, group in worlds.items()}
    rows = world_rows(inputs, CONDITIONS, _ASKED)
    if worlds:
        courses = {label: _course(group) for label, group in worlds.items()}
        question = "How large must the weight of food be before agents eat well?"
        yield NamedFigure("entropy_appetite", question, figure.draw_appetite(bins, courses), _DRAWN)
    yield make_table(
        "entropy",
        "With and without the bonus for entropy",
        [row for measure in _ASKED for row in change(rows, measure, WITH, WITHOUT)],
        sentences(_DIFFERENCE, missing),
    )
    appetite_rows = [
        {"condition": label, "seed": world.seed} | vars(part)
        for label, group in worlds.items()
        for world, world_bins in zip(group, bins[label], strict=True)
        for part in world_bins
    ]
    yield make_table("entropy_appetite", "Food eaten, by weight of food", appetite_rows, _APPETITE, shown=False)
    yield make_table("entropy_worlds", "The worlds of the study of entropy", rows, missing, shown=False)


def _course(worlds: Sequence[WorldRecord]) -> pl.DataFrame:
    """The mean weight of food over time."""
    return history(stack(worlds, "population", world_indices([worlds])), ("normal",), ("w_normal",))


ENTROPY = Item(
    "entropy",
    "The bonus for entropy",
    "The paper prints an entropy coefficient of 0, its program had 0.001. A reward must outweigh that bonus before "
    "an agent learns to seek it: does it set how large the weight of food must be?",
    make_entropy,
    CONDITIONS,
    SCALE,
)
