"""Tables of results, with a title and a note, as they are printed, written and drawn."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import polars as pl

from hedon.statistic.interval import ANY, Range, mean_interval


@dataclass(frozen=True)
class ResultTable:
    """One table of results.

    Attributes:
        name: unique; names the CSV file.
        title: what it tells.
        rows: missing values are null.
        note: what a reader must know to read it; may be empty.
        shown: whether it is printed; else it is only written, since it is long.
        several: whether several conditions were asked about; then readers see of which its rows are, also where only
            one has rows.
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
    """Makes a table from one mapping per row; NaN becomes null. A table without rows has no columns either.

    Args:
        name: of its file.
        title: above it.
        rows: values by column; columns appear in the order in which rows first name them.
        note: below it.
        shown: whether pages print it, or only its file has it.
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
            possible = within if isinstance(within, tuple) else within.get(column, ANY)
            interval = mean_interval(group[column].to_list(), within=possible)
            head = dict(zip(["condition", *by], key, strict=True))
            results.append(head | {"quantity": label} | vars(interval))
    return results
