"""Measures times: repeats, quartiles and their format."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Row = dict[str, Any]
"""One measurement: raw numbers, with the unit at the end of each name."""


@dataclass(frozen=True, slots=True)
class Table:
    """The printed table of a part.

    Attributes:
        title: What was measured.
        headings: One per column, with the unit.
        lines: Texts, one per column.
        notes: Sentences below the table.
    """

    title: str
    headings: tuple[str, ...]
    lines: list[tuple[str, ...]]
    notes: tuple[str, ...] = ()


def seconds_of(body: Callable[[], object]) -> float:
    """The time that a call takes [s]."""
    before = time.perf_counter()
    body()
    return time.perf_counter() - before


def interleave(bodies: Mapping[str, Callable[[], object]], repeats: int) -> dict[str, list[float]]:
    """Times of several calls, measured in turn so that a busy minute of the machine affects all of them [s]."""
    times: dict[str, list[float]] = {name: [] for name in bodies}
    for _ in range(repeats):
        for name, body in bodies.items():
            times[name].append(seconds_of(body))
    return times


def median(values: Sequence[float]) -> float:
    """The median of some numbers."""
    return float(np.median(values))


def spread(values: Sequence[float], digits: int, factor: float = 1.0) -> str:
    """Median and quartiles as text, "3.21 (3.15-3.30)", of the values times a factor."""
    low, middle, high = np.quantile(values, (0.25, 0.5, 0.75)) * factor
    return f"{middle:,.{digits}f} ({low:,.{digits}f}-{high:,.{digits}f})"
