"""Study: does enough food grow for agents to eat as much as the paper reports?"""

from collections.abc import Iterator
from typing import Any

from hedon.analysis import (
    ResultTable,
    WorldRecord,
    food_per_agent_step,
    make_table,
    run_tail,
)
from hedon.config import Config
from hedon.figure import NamedFigure
from hedon.measure import MEASURES, Measure
from hedon.study import Condition, Item, ItemInputs, Scale, missing_note, sentences, shown_interval, world_rows
from hedon_studies.kanagawa_doya_2024 import figure
from hedon_studies.kanagawa_doya_2024.fault import FACTORS
from hedon_studies.kanagawa_doya_2024.paper import PAPER

PRESETS = ("small", "baseline", "centered")
"""The baseline, and the two presets in which food is plentiful for the paper's agents."""
CORRECTED, GROWTH, RELEASED = "corrected", "growth", "released"
SCALE = Scale((1, 2), 1_024_000)


def _conditions(preset: str) -> Iterator[Condition]:
    yield Condition(f"{preset}, {CORRECTED}", preset, fidelity="corrected")
    yield Condition(f"{preset}, {GROWTH}", preset, (FACTORS["growth"],), fidelity="corrected")
    yield Condition(f"{preset}, {RELEASED}", preset, fidelity="released")


RULES = (CORRECTED, GROWTH, RELEASED)
CONDITIONS = tuple(condition for preset in PRESETS for condition in _conditions(preset))

_NOTE = (
    "grows: food that grows per step; eaten_share: how much of it was eaten; eaten: foods per step lived; both in the "
    "last tenth of a run; food_per_step: mean over the dead of foods / lifetime, the paper's rule, over all of a run. "
    "feeds: the number of agents that eat all that grows, at the rate that the paper reports. Its mean counts each of "
    "the dead once; agents that eat more live longer, so that more is eaten per step lived, and those fed are "
    "fewer. Means over worlds, geometric for rates and lifetimes."
)
_DRAWN = (
    "A point is a world, in the last tenth of its run. On a line all that grows is eaten, so no world lives above the "
    "line of its own supply for long. Dashed: the rate that the paper reports."
)


def make_supply(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """The figure and the tables of the study."""
    missing = missing_note(inputs, CONDITIONS, SCALE)
    rows = world_rows(inputs, CONDITIONS, _ASKED)
    if rows:
        question = "Could agents eat what the paper reports of the food that grows?"
        supply_figure = figure.draw_supply(_eaters(rows), RULES, _rates(), _supplies(inputs))
        yield NamedFigure("supply", question, supply_figure, _DRAWN)
    condition_rows = [
        _condition_row(condition, inputs, group_rows)
        for condition in CONDITIONS
        if (group_rows := [r for r in rows if r["condition"] == condition.label])
    ]
    yield make_table("supply", "Food that grows, and food that is eaten", condition_rows, sentences(_NOTE, missing))
    yield make_table("supply_worlds", "The worlds of the study of supply", rows, missing, shown=False)


def _condition_row(condition: Condition, inputs: ItemInputs, rows: list[dict[str, Any]]) -> dict[str, Any]:
    food_growth, paper = growth(condition.config(inputs.fidelity)), PAPER[condition.preset]
    means = {measure.name: shown_interval([row[measure.name] for row in rows], measure).mean for measure in _ASKED}
    fed_agents = food_growth / paper.food_per_step if paper.food_per_step else None
    reference = {"paper_food": paper.food_per_step, "feeds": fed_agents, "paper_lifetime": paper.mean_lifetime}
    return {"condition": condition.label, "worlds": len(rows), "grows": food_growth} | means | reference


def growth(config: Config) -> float:
    """Food that grows, summed over all kinds [food/step]."""
    return sum(kind.growth_rate for kind in config.food.values())


def _eaters(rows: list[dict[str, Any]]) -> "list[figure.Eater]":
    """The worlds with food eaten, as entries of the figure."""
    eaters = []
    for row in rows:
        preset, rule = row["condition"].split(", ")
        if row["alive_mean"] and row["eaten"]:
            eaters.append(figure.Eater(preset, rule, row["alive_mean"], row["eaten"]))
    return eaters


def _rates() -> dict[str, float | None]:
    return {preset: PAPER[preset].food_per_step for preset in PRESETS}


def _supplies(inputs: ItemInputs) -> list[float]:
    return sorted({growth(condition.config(inputs.fidelity)) for condition in CONDITIONS})


def _eaten(world: WorldRecord) -> float | None:
    return food_per_agent_step(run_tail(world.population), world.food_kinds)


def _eaten_share(world: WorldRecord) -> float | None:
    tail = run_tail(world.population)
    grown = growth(world.config) * int(tail["steps"].sum())
    eaten = sum(int(tail[f"eaten_{kind}"].sum()) for kind in world.food_kinds)
    return eaten / grown if grown else None


_ASKED = (
    Measure("eaten_share", "share of the food that grows that is eaten, last tenth", _eaten_share),
    MEASURES["alive_mean"],
    Measure("eaten", "foods per step lived, last tenth [1/step]", _eaten, ratio=True),
    MEASURES["food_per_step"],
    MEASURES["mean_lifetime"],
    MEASURES["mean_energy"],
)


SUPPLY = Item(
    "supply",
    "The supply of food",
    "In the small arena and with food around the center, the paper's agents eat four times as much as in the "
    "baseline and live for 100,000 steps. Does enough food grow for that, as it is set to, five times as fast, or "
    "in the released program?",
    make_supply,
    CONDITIONS,
    SCALE,
)
