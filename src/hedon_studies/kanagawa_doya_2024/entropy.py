"""Study: does the bonus for entropy set how large the weight of food must be?"""

from collections.abc import Iterator, Sequence

import polars as pl

from hedon.analysis.response import RESPONSES, Response
from hedon.analysis.table import ResultTable, table
from hedon.analysis.world.population import history
from hedon.analysis.world.record import WorldRecord
from hedon.figure.named import NamedFigure
from hedon.study.census import present, sentences, stack, world_indices
from hedon.study.change import change, missing_note, read_change, world_rows
from hedon.study.item import Arm, Item, Material, Scale
from hedon_studies.kanagawa_doya_2024.analysis.appetite import WINDOWS, appetite, half_way_weight
from hedon_studies.kanagawa_doya_2024.figure.appetite import draw_appetite

WITH, WITHOUT = "entropy 0.001", "entropy 0"
ARMS = (
    Arm(WITH, fidelity="corrected"),
    Arm(WITHOUT, overrides=("learning.entropy_coef=0.0",), fidelity="corrected"),
)
SCALE = Scale((1, 2), 1_024_000)
_HALF_WAY = Response(
    "half_way_weight",
    "weight of food at which agents eat half-way to the best",
    lambda world, _: half_way_weight(appetite(world)),
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
    "time. Thin lines are worlds, thick lines are means over the worlds of an arm, at the left where more than half of "
    "them have such agents; the band is a 95 % interval, from three worlds on."
)


def make_entropy(material: Material) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    missing = missing_note(material, ARMS, SCALE)
    worlds = present(ARMS, material)
    bins = {label: [appetite(world) for world in found] for label, found in worlds.items()}
    rows = world_rows(material, ARMS, _ASKED)
    if worlds:
        courses = {label: _course(found) for label, found in worlds.items()}
        question = "How large must the weight of food be before agents eat well?"
        yield NamedFigure("entropy_appetite", question, draw_appetite(bins, courses), _DRAWN)
    yield table(
        "entropy",
        "With and without the bonus for entropy",
        [row for response in _ASKED for row in change(rows, response, WITH, WITHOUT)],
        sentences(_DIFFERENCE, missing),
    )
    eaten = [
        {"arm": label, "seed": world.seed} | vars(part)
        for label, found in worlds.items()
        for world, world_bins in zip(found, bins[label], strict=True)
        for part in world_bins
    ]
    yield table("entropy_appetite", "Food eaten, by weight of food", eaten, _APPETITE, shown=False)
    yield table("entropy_worlds", "The worlds of the study of entropy", rows, missing, shown=False)


def _course(worlds: Sequence[WorldRecord]) -> pl.DataFrame:
    """The mean weight of food over time."""
    return history(stack(worlds, "population", world_indices([worlds])), ("normal",), ("w_normal",))


ENTROPY: tuple[Item, ...] = (
    Item(
        "entropy",
        "The bonus for entropy",
        "study",
        "The paper prints an entropy coefficient of 0, its program had 0.001. A reward must outweigh that bonus before "
        "an agent learns to seek it: does it set how large the weight of food must be?",
        make_entropy,
        ARMS,
        SCALE,
    ),
)
