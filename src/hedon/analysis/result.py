"""Tables of results with a title and a note, for printing, writing and drawing."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import polars as pl

from hedon.statistic.interval import ANY, Range, mean_interval


@dataclass(frozen=True)
class ResultTable:
    """A table of results.

    Attributes:
        name: Unique name, used for the CSV file.
        title: What the table shows.
        rows: Data; missing values are null.
        note: Explanation that readers need; may be empty.
        shown: Whether the table is printed; a long one is only written.
        several: Whether several conditions were requested, so that rows show their condition even if only one has rows.
    """

    name: str
    title: str
    rows: pl.DataFrame
    note: str = ""
    shown: bool = True
    several: bool = False


def make_table(
    name: str, title: str, rows: Iterable[Mapping[str, Any]], note: str = "", *, shown: bool = True
) -> ResultTable:
    """Makes a table from one mapping per row; NaN becomes null. A table without rows has no columns.

    Args:
        name: Name of its file.
        title: Heading of the table.
        rows: Values by column; columns appear in the order in which rows first use them.
        note: Explanation below the table.
        shown: Whether pages print it; otherwise it is only in its file.
    """
    frame = pl.DataFrame(list(rows), infer_schema_length=None).fill_nan(None)
    return ResultTable(name, title, frame, note, shown)


def over_worlds(
    rows: pl.DataFrame, by: Sequence[str], quantities: Mapping[str, str], within: Mapping[str, Range] | Range = ANY
) -> list[dict[str, Any]]:
    """Means over worlds with Student's t intervals, a row for each group and quantity."""
    if rows.is_empty():
        return []
    results = []
    for key, group in rows.group_by(["condition", *by], maintain_order=True):
        for column, label in quantities.items():
            bounds = within if isinstance(within, tuple) else within.get(column, ANY)
            interval = mean_interval(group[column].to_list(), within=bounds)
            head = dict(zip(["condition", *by], key, strict=True))
            results.append(head | {"quantity": label} | vars(interval))
    return results
