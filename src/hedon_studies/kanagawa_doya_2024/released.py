"""Study: what does the paper's program do over many seeds, and how do results change if only survivors are kept?"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import polars as pl

import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, drift_genes, last_agents, make_table
from hedon.figure import NamedFigure
from hedon.measure import RESPONSES
from hedon.statistic import share_interval
from hedon.study import Condition, Item, ItemInputs, Scale, missing_note, shown_interval, world_rows
from hedon_studies.kanagawa_doya_2024 import figure
from hedon_studies.kanagawa_doya_2024.analysis.fate import EXTINCT, FATES, HEADING, STANDING, Fate, fate
from hedon_studies.kanagawa_doya_2024.mutation import Drifts, condition_drifts, drift_parts
from hedon_studies.kanagawa_doya_2024.paper import EXTINCTION, PAPER

LABEL = "released"
CONDITIONS = (Condition(LABEL, fidelity="released"),)
SCALE = Scale(tuple(range(1, 13)), 1_024_000)

_PAPER_COSTS = (0.001, 2e-5)
_GROUPS = {"all": FATES, "not extinct": (STANDING, HEADING), STANDING: (STANDING,)}
_COMPARED = ("w_normal_last", "w_action_last", "mean_lifetime", "food_per_step", "alive_mean", "generation")
"""Measures that the paper reports."""

_DRAWN = "A line per world; a cross ends that of a world whose record ends before the longest."
_WEIGHTS = (
    "A point is one of the 5000 agents of a world that were born last: its weight of food against its weight of "
    "action; a color is a seed, the same in both figures. Above and beside the axes, the distributions over all "
    "agents, and outlined, those that drift alone would give."
)
_FATE = (
    "A world heads for extinction if it died out or has fewer than half as many agents in its last tenth as in its "
    "second. Standing worlds that had such a low before, and rose again, say how far that can be trusted. The interval "
    "is Jeffreys'. The paper replaced seeds that died out."
)
_SURVIVOR = (
    "Means over worlds with 95 % intervals from five worlds on, geometric for lifetime and food; standing: neither "
    "extinct nor heading for it. The paper's figures are of 5 survivors of 10,240,000 steps."
)


def make_released(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """The figures and tables of the study."""
    worlds = list(inputs.worlds.get(LABEL, ()))
    missing = missing_note(inputs, CONDITIONS, SCALE)
    fates = [fate(world) for world in worlds]
    rows = [
        row | vars(world_fate) for row, world_fate in zip(world_rows(inputs, CONDITIONS, RESPONSES), fates, strict=True)
    ]
    drifts = condition_drifts(inputs, CONDITIONS)
    if worlds:
        yield NamedFigure(
            "released_fate", "Which worlds last, and what evolves there?", figure.draw_fates(worlds, fates), _DRAWN
        )
        yield from _weight_figures(worlds, fates)
    yield make_table(
        "released_fate", "Worlds that head for extinction", _fate_rows(fates), f"{_FATE} {missing}".strip()
    )
    yield make_table("released_survivors", "All worlds, and those that last", _survivor_rows(rows), _SURVIVOR)
    yield from drift_parts("released", drifts, missing)
    yield make_table(
        "released_worlds", "The worlds of the released program", _with_bias(rows, drifts), missing, shown=False
    )


def _weight_figures(worlds: Sequence[WorldRecord], fates: Sequence[Fate]) -> Iterator[NamedFigure]:
    """The paper's figure of weights, for all worlds and for the surviving ones; seeds keep their colors."""
    questions = {"released_weights": "Which rewards evolved, in all worlds?"}
    survivors = [i for i, world_fate in enumerate(fates) if not world_fate.is_lost]
    groups = {"released_weights": list(range(len(worlds)))}
    if 0 < len(survivors) < len(worlds):
        questions["released_weights_standing"] = "And in those that do not head for extinction?"
        groups["released_weights_standing"] = survivors
    for name, question in questions.items():
        last_by_world = {i: last_agents(worlds[i].agents).with_columns(world=pl.lit(i, pl.Int32)) for i in groups[name]}
        drift = drift_genes([worlds[i] for i in last_by_world], list(last_by_world.values()))
        yield NamedFigure(
            name,
            question,
            hedon.figure.draw_weights(pl.concat(last_by_world.values()), worlds[0].reward_names, drift),
            _WEIGHTS,
        )


def _fate_rows(fates: Sequence[Fate]) -> Iterator[dict[str, Any]]:
    paper = {EXTINCT: f"{EXTINCTION[_PAPER_COSTS]:.0%} of 10 seeds"}
    counts = {name: sum(world_fate.fate == name for world_fate in fates) for name in FATES}
    counts = {"extinct or heading for it": sum(world_fate.is_lost for world_fate in fates)} | counts
    counts["standing after such a low"] = sum(world_fate.recovered for world_fate in fates)
    for name, count in counts.items() if fates else ():
        low, high = share_interval(count, len(fates))
        shares = {"count": count, "worlds": len(fates), "share": count / len(fates), "low": low, "high": high}
        yield {"fate": name} | shares | {"paper": paper.get(name)}


def _survivor_rows(rows: Sequence[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    measures = {measure.name: measure for measure in RESPONSES}
    for name in _COMPARED if rows else ():
        for group, group_fates in _GROUPS.items():
            values = [row[name] for row in rows if row["fate"] in group_fates]
            statistics = vars(shown_interval(values, measures[name]))
            if name.startswith("w_"):
                statistics |= {"positive": sum(value > 0 for value in values if value is not None)}
            yield {"measure": name, "worlds_of": group} | statistics | {"paper": _paper(name)}


def _paper(name: str) -> str:
    """The value that the paper reports for a measure in the baseline."""
    paper = PAPER["baseline"]
    texts = {
        "w_normal_last": "mostly above 4",
        "w_action_last": "largely positive or slightly negative",
        "mean_lifetime": f"{paper.mean_lifetime:,.0f}",
        "food_per_step": f"{paper.food_per_step:g}",
        "alive_mean": "{} to {}".format(*paper.population or ()),
        "generation": "{} to {}, in ten times the steps".format(*paper.generation or ()),
    }
    return texts[name]


def _with_bias(rows: Sequence[Mapping[str, Any]], drifts: Drifts) -> list[dict[str, Any]]:
    """The rows, with the bias of each world's noise table added to its weights."""
    biases: dict[int, dict[str, float]] = {}
    for seed, drift in drifts[LABEL]:
        biases.setdefault(seed, {})[f"bias_{drift['weight']}"] = drift["bias"]
    return [dict(row) | biases.get(row["seed"], {}) for row in rows]


RELEASED = Item(
    "released",
    "The released program, seed by seed",
    "The paper shows 5 seeds and replaced those that died out. How many seeds of the released program head for "
    "extinction, does the weight of food follow the bias of the seed's mutations, and do survivors alone give the "
    "paper's picture?",
    make_released,
    CONDITIONS,
    SCALE,
)
