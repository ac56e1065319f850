"""Study: could agents eat what the paper reports of the food that grows?"""

from collections.abc import Iterator
from typing import Any

from hedon.analysis.agent.food import food_per_agent_step
from hedon.analysis.response import RESPONSES, Common, Response
from hedon.analysis.table import ResultTable, table
from hedon.analysis.world.population import run_tail
from hedon.analysis.world.record import WorldRecord
from hedon.config import Config
from hedon.figure.named import NamedFigure
from hedon.study.census import sentences
from hedon.study.change import missing_note, shown_interval, world_rows
from hedon.study.item import Arm, Item, Material, Scale
from hedon_studies.kanagawa_doya_2024.fault import FACTORS
from hedon_studies.kanagawa_doya_2024.figure.supply import Eater, draw_supply
from hedon_studies.kanagawa_doya_2024.paper import PAPER

CONDITIONS = ("small", "baseline", "centered")
"""The baseline, and the two in which the paper's agents live in plenty."""
CORRECTED, GROWTH, RELEASED = "corrected", "growth", "released"
SCALE = Scale((1, 2), 1_024_000)


def _arms(preset: str) -> Iterator[Arm]:
    yield Arm(f"{preset}, {CORRECTED}", preset, fidelity="corrected")
    yield Arm(f"{preset}, {GROWTH}", preset, (FACTORS["growth"],), fidelity="corrected")
    yield Arm(f"{preset}, {RELEASED}", preset, fidelity="released")


RULES = (CORRECTED, GROWTH, RELEASED)
ARMS = tuple(arm for preset in CONDITIONS for arm in _arms(preset))

_NOTE = (
    "grows: food that grows per step; eaten_share: how much of it was eaten; eaten: foods per step lived; both in the "
    "last tenth of a run; food_agent: mean over the dead of foods / lifetime, the paper's rule, over all of a run. "
    "feeds: the number of agents that eat all that grows, at the rate that the paper reports. Its mean counts each of "
    "the dead once; who eats more lives longer, so that what is eaten per step lived is rather more, and those fed are "
    "fewer. Means over worlds, geometric for rates and lifetimes."
)
_DRAWN = (
    "A point is a world, in the last tenth of its run. On a line all that grows is eaten, so no world lives above the "
    "line of its own supply for long. Dashed: the rate that the paper reports."
)


def make_supply(material: Material) -> Iterator[NamedFigure | ResultTable]:
    """The figure and the tables of the study."""
    missing = missing_note(material, ARMS, SCALE)
    rows = world_rows(material, ARMS, _ASKED)
    if rows:
        question = "Could agents eat what the paper reports of the food that grows?"
        yield NamedFigure("supply", question, draw_supply(_eaters(rows), RULES, _rates(), _supplies(material)), _DRAWN)
    found = [_arm_row(arm, material, mine) for arm in ARMS if (mine := [r for r in rows if r["arm"] == arm.label])]
    yield table("supply", "Food that grows, and food that is eaten", found, sentences(_NOTE, missing))
    yield table("supply_worlds", "The worlds of the study of supply", rows, missing, shown=False)


def _arm_row(arm: Arm, material: Material, rows: list[dict[str, Any]]) -> dict[str, Any]:
    grows, paper = growth(arm.config(material.fidelity)), PAPER[arm.preset]
    means = {asked.name: shown_interval([row[asked.name] for row in rows], asked).mean for asked in _ASKED}
    feeds = grows / paper.food_per_step if paper.food_per_step else None
    known = {"paper_food": paper.food_per_step, "feeds": feeds, "paper_lifetime": paper.mean_lifetime}
    return {"arm": arm.label, "worlds": len(rows), "grows": grows} | means | known


def growth(config: Config) -> float:
    """Food that grows, over all kinds [food/step]."""
    return sum(kind.growth_rate for kind in config.food.values())


def _eaters(rows: list[dict[str, Any]]) -> list[Eater]:
    """The worlds that eat, as the figure shows them."""
    eaters = []
    for row in rows:
        preset, rule = row["arm"].split(", ")
        if row["alive"] and row["eaten"]:
            eaters.append(Eater(preset, rule, row["alive"], row["eaten"]))
    return eaters


def _rates() -> dict[str, float | None]:
    return {preset: PAPER[preset].food_per_step for preset in CONDITIONS}


def _supplies(material: Material) -> list[float]:
    return sorted({growth(arm.config(material.fidelity)) for arm in ARMS})


def _eaten(world: WorldRecord, _common: Common) -> float | None:
    return food_per_agent_step(run_tail(world.population), world.food_kinds)


def _eaten_share(world: WorldRecord, _common: Common) -> float | None:
    tail = run_tail(world.population)
    grown = growth(world.config) * int(tail["steps"].sum())
    eaten = sum(int(tail[f"eaten_{kind}"].sum()) for kind in world.food_kinds)
    return eaten / grown if grown else None


_KNOWN = {response.name: response for response in RESPONSES}
_ASKED = (
    Response("eaten_share", "share of the food that grows that is eaten, last tenth", _eaten_share),
    _KNOWN["alive"],
    Response("eaten", "foods per step lived, last tenth [1/step]", _eaten, ratio=True),
    _KNOWN["food_agent"],
    _KNOWN["lifetime"],
    _KNOWN["energy"],
)


SUPPLY: tuple[Item, ...] = (
    Item(
        "supply",
        "The supply of food",
        "study",
        "In the small arena and with food around the center, the paper's agents eat four times as much as in the "
        "baseline and live for 100,000 steps. Does enough food grow for that, as it is set to, five times as fast, or "
        "in the released program?",
        make_supply,
        ARMS,
        SCALE,
    ),
)
