"""The factors of a sweep: what they vary, and how a sweep's file specifies them."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from hedon.config.load import FIDELITIES, PRESETS
from hedon.config.problem import Problem, format_value, nearest

PRESET, FIDELITY = "preset", "fidelity"
"""Factors that are not settings: they choose the starting values of all settings."""
NAMED = {PRESET: PRESETS, FIDELITY: FIDELITIES}
KEYS = ("values", "range", "log", "count")
MOST_VALUES = 10_000
"""Largest number of values of one factor."""


@dataclass(frozen=True)
class Factor:
    """A setting that a sweep varies.

    Attributes:
        name: Path of a setting such as "energy.basic_cost", or `PRESET` or `FIDELITY`.
        values: The values that it takes; empty if they are drawn from a range.
        low, high: Ends of the range.
        log: Whether values are drawn evenly on a logarithmic scale.
        whole: Whether drawn values are rounded to whole numbers, as is done if both ends of the range are whole.
    """

    name: str
    values: tuple[Any, ...] = ()
    low: float = 0.0
    high: float = 0.0
    log: bool = False
    whole: bool = False

    @property
    def drawn(self) -> bool:
        """Whether its values are drawn from a range."""
        return not self.values

    def at(self, share: float) -> float | int:
        """The value at a share of the range, from 0 to 1."""
        if self.log:
            value = math.exp(math.log(self.low) + share * (math.log(self.high) - math.log(self.low)))
        else:
            value = self.low + share * (self.high - self.low)
        value = float(f"{value:.12g}")  # 0.3, not 0.30000000000000004
        return round(value) if self.whole else value


def read_factor(name: str, said: Any) -> Factor | Problem:
    """Reads a factor from its entry: a list of values, or a table with `values`, or with `range` or `log` and `count`.

    With `count`, a range gives that many evenly spaced values, including both ends. Without it, values are drawn.

    Args:
        name: Name of the factor.
        said: Its entry in the file.

    Returns:
        The factor, or the problem with its entry.
    """
    place = f"factor.{name}"
    table = {"values": said} if isinstance(said, list) else said
    if not isinstance(table, dict):
        form = "must be a list of values, or a table such as { range = [0.0, 1.0], count = 5 }"
        return Problem(place, form, format_value(said))
    for key in table:
        if key not in KEYS:
            return Problem(
                f"{place}.{key}", f"is not a part of a factor ({', '.join(KEYS)})", nearest=nearest(key, KEYS)
            )
    if sum(key in table for key in ("values", "range", "log")) != 1 or ("values" in table and "count" in table):
        return Problem(place, "must have one of values, range or log; count goes with range and log")
    if "values" in table:
        return _listed(name, place, table["values"])
    return _ranged(name, place, table, log="log" in table)


def _listed(name: str, place: str, values: Any) -> Factor | Problem:
    if not isinstance(values, list) or not 1 <= len(values) <= MOST_VALUES:
        return Problem(place, f"must be a list of 1 to {MOST_VALUES:,} values", format_value(values))
    for i, value in enumerate(values):
        if value in values[:i]:
            return Problem(place, "appears twice in the list", format_value(value))
        if name in NAMED and value not in NAMED[name]:
            suggestion = nearest(value, NAMED[name]) if isinstance(value, str) else None
            return Problem(f"{place}[{i}]", f"must be one of {', '.join(NAMED[name])}", format_value(value), suggestion)
        if isinstance(value, dict):
            return Problem(f"{place}[{i}]", "must be the value of one setting: vary each setting by itself", "a table")
    return Factor(name, tuple(values))


def _ranged(name: str, place: str, table: dict[str, Any], *, log: bool) -> Factor | Problem:
    key = "log" if log else "range"
    bounds, count = table[key], table.get("count")
    if name in NAMED:
        return Problem(place, "has names, not numbers: give a list", format_value(bounds))
    if (
        not isinstance(bounds, list)
        or len(bounds) != 2
        or not all(map(_is_number, bounds))
        or not bounds[0] < bounds[1]
    ):
        return Problem(f"{place}.{key}", "must be two finite numbers, the smaller first", format_value(bounds))
    if log and bounds[0] <= 0:
        return Problem(f"{place}.log", "must be above 0", format_value(bounds))
    factor = Factor(name, (), float(bounds[0]), float(bounds[1]), log, all(isinstance(end, int) for end in bounds))
    if count is None:
        return factor
    if not isinstance(count, int) or isinstance(count, bool) or not 2 <= count <= MOST_VALUES:
        return Problem(f"{place}.count", f"must be a whole number from 2 to {MOST_VALUES:,}", format_value(count))
    values = tuple(factor.at(share) for share in np.linspace(0.0, 1.0, count).tolist())
    if len(set(values)) < count:
        return Problem(place, "has fewer different values than count: whole ends give whole numbers; write 1.0 for 1")
    return Factor(name, values)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
