"""The paper's tables of lifetimes and food eaten, by size of the arena and place of food."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import polars as pl

from hedon.analysis import ResultTable, WorldRecord, food_per_agent_step, food_per_step, lifetime, make_table
from hedon.statistic import AMOUNT, SHARE, mean_interval
from hedon.study import Condition, Item, ItemInputs, count_extinct, missing, present, sentences, steps_reached
from hedon_studies.kanagawa_doya_2024.condition import PAPER_SCALE, PLACES, SIZES
from hedon_studies.kanagawa_doya_2024.paper import paper_figures

# Columns of the table of worlds, each with its title and the paper's figure that is computed by the same rule.
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


def _make(name: str, title: str, conditions: Sequence[Condition], inputs: ItemInputs) -> Iterator[ResultTable]:
    worlds = present(conditions, inputs)
    by_world = make_table(f"{name}-world", f"{title}, world by world", _world_rows(worlds), shown=False)
    rows = [
        row
        for condition in conditions
        if condition.label in worlds
        for row in _rows(condition, worlds[condition.label], by_world.rows)
    ]
    note = sentences(f"{_READ}{_ages(by_world.rows)}.", missing(conditions, inputs))
    yield make_table(name, title, rows, note)
    yield by_world


def _world_rows(worlds: Mapping[str, Sequence[WorldRecord]]) -> Iterator[dict[str, Any]]:
    labelled = {label: [replace(world, condition=label) for world in group] for label, group in worlds.items()}
    life_rows = next(result for result in lifetime(labelled) if result.name == "lifetime_world").rows.iter_rows(
        named=True
    )
    for life, world in zip(life_rows, (world for group in labelled.values() for world in group), strict=True):
        condition, agents = life.pop("condition"), life["agents"]
        yield {
            "condition": condition,
            "seed": life.pop("seed"),
            "steps": world.last_step,
            "extinct_step": world.extinct_step,
            **life,
            "censored": (agents - life["died"]) / agents if agents else None,
            "food_per_life": food_per_step(world.agents, world.food_kinds),
            "food_per_step": food_per_agent_step(world.population, world.food_kinds),
        }


def _rows(condition: Condition, worlds: Sequence[WorldRecord], by_world: pl.DataFrame) -> Iterator[dict[str, Any]]:
    condition_rows, paper = by_world.filter(pl.col("condition") == condition.label), paper_figures(condition.preset)
    for column, (quantity, attribute) in _QUANTITIES.items():
        interval = mean_interval(condition_rows[column], within=SHARE if column == "censored" else AMOUNT)
        paper_value = getattr(paper, attribute) if attribute else None
        yield {
            "condition": condition.label,
            "quantity": quantity,
            "mean": interval.mean,
            "low": interval.low,
            "high": interval.high,
            "paper": paper_value,
            "ratio": interval.mean / paper_value if paper_value and interval.mean is not None else None,
            "worlds": interval.worlds,
            "of": len(worlds),
            "extinct": count_extinct(worlds),
            "steps": steps_reached(worlds),
        }


def _ages(by_world: pl.DataFrame) -> str:
    """The age limit of the restricted means, by condition."""
    if by_world.is_empty():
        return ""
    ages = by_world.group_by("condition", maintain_order=True).agg(pl.col("until").first())
    return " (" + ", ".join(f"{condition}: {until:,.0f} steps" for condition, until in ages.iter_rows()) + ")"


def _item(name: str, title: str, paper: str, conditions: tuple[Condition, ...]) -> Item:
    return Item(name, title, paper, partial(_make, name, title, conditions), conditions, PAPER_SCALE)


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
