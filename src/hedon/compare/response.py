"""The measures that a comparison shows, and their means over worlds of the same condition."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import polars as pl

from hedon.compare.error import CompareError
from hedon.config.problem import did_you_mean
from hedon.ensemble.row import KEYS
from hedon.measure.catalogue import column_measure
from hedon.statistic.interval import ANY, Interval, mean_interval, share_interval

BINS = 8
"""Largest number of groups of neighboring values for which means are shown, if every world has its own value."""


@dataclass(frozen=True)
class Point:
    """The mean response of worlds with equal or neighboring values of some factors.

    Attributes:
        at: Values of the factors; for neighboring values, their mean.
        mean: Mean of the response, with its 95 % interval.
    """

    at: tuple[float | str, ...]
    mean: Interval


def responses(
    table: pl.DataFrame, asked: Sequence[str], factors: Sequence[str], titles: Mapping[str, str] | None = None
) -> dict[str, str]:
    """The columns to show, with their titles.

    Args:
        table: Table of worlds.
        asked: Columns to show; by default the usual ones. The name of a gene, such as "w_action", stands for the column
            with its mean.
        factors: Columns that distinguish conditions.
        titles: Titles of measures that configs add, by name.

    Raises:
        CompareError: One of them is not a column of numbers.
    """
    fit = [name for name, kind in table.schema.items() if kind.is_numeric() or kind == pl.Boolean]
    fit = [name for name in fit if name not in (*KEYS, *factors)]
    asked = [_with_mean(name, fit) for name in asked]
    for name in asked:
        if name not in fit:
            hint = did_you_mean(name, fit, f" (there are {', '.join(fit)})")
            raise CompareError(f"--only: {name!r} is not a column of numbers of the table{hint}")
    known = {name: found for name in fit if (found := column_measure(name, titles))}
    shown = asked or [name for name, found in known.items() if found.usual] or fit
    return {name: known[name].title if name in known else name for name in shown}


def _with_mean(name: str, columns: Sequence[str]) -> str:
    """The column with the mean of a gene if only its name is given; the name itself if there is no or no single one."""
    means = [each for each in columns if f"{name}_mean" in (each, each.rpartition(".")[2])]
    return means[0] if name not in columns and len(means) == 1 else name


def points(table: pl.DataFrame, factors: Sequence[str], response: str) -> list[Point]:
    """The mean of a response at each combination of some factors' values, averaged over all other factors.

    Args:
        table: Table of worlds.
        factors: Columns of the factors.
        response: Column of the response.
    """
    made = []
    if not factors:
        return [Point((), _response_interval(table, response))]
    for at, rows in table.sort(*factors).group_by(*factors, maintain_order=True):
        made.append(Point(tuple(at), _response_interval(rows, response)))
    return made


def binned(table: pl.DataFrame, factor: str, response: str) -> list[Point]:
    """Means over groups of neighboring values of a factor that was drawn from a range.

    Args:
        table: Table of worlds.
        factor: Column of the factor.
        response: Column of the response.
    """
    rows = table.sort(factor)
    count = min(BINS, max(1, rows.height // 4))
    edges = [round(i * rows.height / count) for i in range(count + 1)]
    groups = [rows[low:high] for low, high in pairwise(edges) if high > low]
    return [Point((_mean(group[factor]),), _response_interval(group, response)) for group in groups]


def _response_interval(table: pl.DataFrame, response: str) -> Interval:
    """The mean over worlds with Student's t interval, or, for yes or no, the share with Jeffreys' interval."""
    known = table[response].drop_nulls()
    if known.dtype != pl.Boolean:
        measure = column_measure(response)
        return mean_interval(known.cast(pl.Float64).to_list(), within=measure.within if measure else ANY)
    if not len(known):
        return Interval(None, None, None, 0)
    count = int(known.sum())
    return Interval(count / len(known), *share_interval(count, len(known)), len(known))


def _mean(values: pl.Series) -> float:
    return math.fsum(values.to_list()) / len(values)
