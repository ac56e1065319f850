"""The paper's tables of lives: how long agents live and how much they eat, by size of the arena and place of food."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import polars as pl

from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.table import ResultTable, table
from hedon.analysis.topic.life import lifetime
from hedon.analysis.world.record import WorldRecord
from hedon.statistic.interval import mean_interval
from hedon.study.census import count_extinct, missing, present, sentences, steps_reached
from hedon.study.item import Arm, Item, Material
from hedon_studies.kanagawa_doya_2024.condition import PAPER_SCALE, PLACES, SIZES
from hedon_studies.kanagawa_doya_2024.paper import paper_figures

# Column of the table of worlds: what it is called, and which of the paper's figures is made by the same rule.
_QUANTITIES = {
    "mean_of_dead": ("mean lifetime of the dead [step]", "mean_lifetime"),
    "restricted_mean": ("restricted mean lifetime [step]", None),
    "median": ("median lifetime [step]", None),
    "censored": ("share of lives censored", None),
    "food_per_life": ("foods / lifetime, mean over the dead [1/step]", "food_per_step"),
    "food_per_step": ("all foods / all steps lived [1/step]", None),
}
_READ = (
    "Means over worlds, those that died out among them; the paper replaced such. Its figures are read as "
    "unweighted means over agents, and so over the dead; it does not say. A life is censored if the agent lives at the "
    "end: the median counts it, and so does "
    "the restricted mean, that of min(lifetime, age) up to an age that 20 agents of each world that lives reached"
)


def _make(name: str, title: str, arms: Sequence[Arm], material: Material) -> Iterator[ResultTable]:
    worlds = present(arms, material)
    by_world = table(f"{name}-world", f"{title}, world by world", _world_rows(worlds), shown=False)
    rows = [row for arm in arms if arm.label in worlds for row in _rows(arm, worlds[arm.label], by_world.rows)]
    note = sentences(f"{_READ}{_ages(by_world.rows)}.", missing(arms, material))
    yield table(name, title, rows, note)
    yield by_world


def _world_rows(worlds: Mapping[str, Sequence[WorldRecord]]) -> Iterator[dict[str, Any]]:
    named = {label: [replace(world, condition=label) for world in group] for label, group in worlds.items()}
    lives = next(result for result in lifetime(named) if result.name == "lifetime_world").rows.iter_rows(named=True)
    for life, world in zip(lives, (world for group in named.values() for world in group), strict=True):
        arm, agents = life.pop("condition"), life["agents"]
        yield {
            "arm": arm,
            "seed": life.pop("seed"),
            "steps": world.last_step,
            "extinct_step": world.extinct_step,
            **life,
            "censored": (agents - life["died"]) / agents if agents else None,
            "food_per_life": food_per_step(world.agents, world.food_kinds),
            "food_per_step": food_per_agent_step(world.population, world.food_kinds),
        }


def _rows(arm: Arm, worlds: Sequence[WorldRecord], by_world: pl.DataFrame) -> Iterator[dict[str, Any]]:
    mine, paper = by_world.filter(pl.col("arm") == arm.label), paper_figures(arm.preset)
    for column, (quantity, reported) in _QUANTITIES.items():
        interval = mean_interval(mine[column])
        figure = getattr(paper, reported) if reported else None
        yield {
            "arm": arm.label,
            "quantity": quantity,
            "mean": interval.mean,
            "low": interval.low,
            "high": interval.high,
            "paper": figure,
            "ratio": interval.mean / figure if figure and interval.mean is not None else None,
            "worlds": interval.worlds,
            "of": len(worlds),
            "extinct": count_extinct(worlds),
            "steps": steps_reached(worlds),
        }


def _ages(by_world: pl.DataFrame) -> str:
    """Up to which age the restricted means go, arm by arm."""
    if by_world.is_empty():
        return ""
    ages = by_world.group_by("arm", maintain_order=True).agg(pl.col("until").first())
    return " (" + ", ".join(f"{arm}: {until:,.0f} steps" for arm, until in ages.iter_rows()) + ")"


def _item(name: str, title: str, paper: str, arms: tuple[Arm, ...]) -> Item:
    return Item(name, title, "table", paper, partial(_make, name, title, arms), arms, PAPER_SCALE)


LIVES: tuple[Item, ...] = (
    _item(
        "life-sizes",
        "Lifetime and food by the size of the arena",
        "In the small arena agents live some twenty times as long as in the baseline and eat more than four times as "
        "often; the large arena is a little worse than the baseline.",
        SIZES,
    ),
    _item(
        "life-places",
        "Lifetime and food by the place of food",
        "With food around the center agents live some twelve times as long as with food anywhere and eat four times as "
        "often; with food whose place moves on they fare as in the baseline.",
        PLACES,
    ),
)
