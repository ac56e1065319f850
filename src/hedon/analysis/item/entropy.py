"""Study: does the bonus for entropy set how large the weight of food must be?"""

from collections.abc import Iterator, Sequence
from typing import Any

import polars as pl

from hedon.analysis.appetite import WINDOWS, appetite, half_way_weight
from hedon.analysis.condition_figure import NamedFigure
from hedon.analysis.figure_appetite import draw_appetite
from hedon.analysis.item.census import present, sentences
from hedon.analysis.item.item import Arm, Item, Material, Scale
from hedon.analysis.item.study import missing_note, shown_interval, world_rows
from hedon.analysis.population import history
from hedon.analysis.response import RESPONSES, Response
from hedon.analysis.topic.result import ResultTable, table
from hedon.analysis.world import WorldRecord

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
    f"Means over worlds; change: {WITHOUT} against {WITH}, seed by seed, as a difference or, for lifetimes and rates "
    "of food, a ratio (then all means are geometric); its 95 % interval is Student's t over seeds, from three on. "
    "change_low and change_high are the least and the largest of single seeds. half_way_weight: the weight of food at "
    "which agents eat half-way between those with negative weights and those of the best bin."
)
_APPETITE = (
    f"Agents that died with a life of at least {WINDOWS} windows of learning. eaten: foods per 1000 steps lived. "
    "Agents with larger weights were mostly born later, into other company."
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
        yield NamedFigure("entropy_appetite", question, draw_appetite(bins, courses))
    yield table(
        "entropy",
        "With and without the bonus for entropy",
        [row for response in _ASKED for row in _difference(rows, response)],
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
    populations = [world.population.with_columns(world=pl.lit(i, pl.Int32)) for i, world in enumerate(worlds)]
    return history(pl.concat(populations), ("normal",), ("w_normal",))


def _difference(rows: list[dict[str, Any]], response: Response) -> Iterator[dict[str, Any]]:
    """One response, where both arms or one of them have it."""
    by_arm = {arm.label: {row["seed"]: row[response.name] for row in rows if row["arm"] == arm.label} for arm in ARMS}
    means = {label: shown_interval(list(values.values()), response).mean for label, values in by_arm.items()}
    if all(mean is None for mean in means.values()):
        return
    changes = [
        response.scaled(value) - response.scaled(before)
        for seed, value in by_arm[WITHOUT].items()
        if value is not None and (before := by_arm[WITH].get(seed)) is not None
    ]
    found = shown_interval(changes)
    low, high = (found.low, found.high) if response.sure else (None, None)
    values = {"change": found.mean, "low": low, "high": high}
    values |= {"change_low": min(changes, default=None), "change_high": max(changes, default=None)}
    head = {"response": response.name} | means | {"scale": "ratio" if response.ratio else "difference"}
    yield head | {name: response.unscaled(value) for name, value in values.items()} | {"seeds": len(changes)}


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
