"""Measures of one's own: numbers of a world that reports, comparisons and plots show beside those of hedon."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import OURS, setting

MAX_MEASURES = 50


@dataclass(frozen=True, slots=True)
class MeasureConfig:
    """A number of each world, or of each species in it, computed from its records.

    `[measure.NAME]` adds a number to summaries, tables, comparisons, power and plots, under its name. It changes no
    world: runs with and without it have the same digest. `of` is an expression of SQL over the columns of one table,
    which gives one number, as in "sum(births) / sum(agent_steps)". What the columns are is in docs/records.md.
    """

    of: str = setting("", "expression that gives the number, with aggregates such as sum, avg, min, max", "", OURS)
    table: Literal["population", "agents"] = setting("population", "table whose columns it has", "", OURS)
    title: str = setting("", "label with the unit; empty: the name", "", OURS)
