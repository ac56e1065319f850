"""User-defined measures: numbers of a world that reports, comparisons and plots show with hedon's own."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import OURS, setting

MAX_MEASURES = 50


@dataclass(frozen=True, slots=True)
class MeasureConfig:
    """A number computed from the records of each world, or of each species in it.

    `[measure.NAME]` adds a number to summaries, tables, comparisons, power and plots, under its name. It changes no
    world: runs with and without it have the same digest. `of` is an SQL expression over the columns of one table that
    gives one number, as in "sum(births) / sum(agent_steps)". docs/records.md describes the columns.
    """

    of: str = setting("", "expression that gives the number, with aggregates such as sum, avg, min, max", "", OURS)
    table: Literal["population", "agents"] = setting("population", "table whose columns it has", "", OURS)
    title: str = setting("", "label with the unit; empty: the name", "", OURS)
