"""Formats the cells of a table in the same way for the terminal, Markdown and HTML."""

import io
from collections.abc import Mapping, Sequence
from typing import Any

import polars as pl

from hedon.analysis.result import ResultTable
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.text import LEAST_P

NOTHING = "-"
"""Shown in place of a missing number."""
HIDDEN = ("source", "region_low", "region_high", "window")
"""Columns that appear only in the files."""
_INTERVAL = ("low", "high")
_KEYS = ("condition", "species", "fitness", "quantity", "test")
"""Columns that distinguish the rows of one gene."""


def cells(table: ResultTable, hidden: Sequence[str] = HIDDEN) -> tuple[list[str], list[list[str]]]:
    """The headers and rows of a table as a reader sees them.

    The rows of neutral genes, which show drift, are merged into one. The bounds of an interval become one column, empty
    for fewer than five worlds. A column `condition` with a single value is omitted if there is only one condition, and
    so is every column without a value.
    """
    rows = _with_neutral_folded(table.rows)
    single_condition = "condition" in rows.columns and rows["condition"].n_unique() == 1 and not table.several
    merged = all(bound in rows.columns for bound in _INTERVAL) and "answer" not in rows.columns
    names = [
        c
        for c in rows.columns
        if c not in hidden and not (c == "condition" and single_condition) and not (c == "high" and merged)
    ]
    headers = ["95 % interval" if merged and c == "low" else c if "." in c else c.replace("_", " ") for c in names]
    cell_rows = [[_cell(row, c, merged) for c in names] for row in rows.iter_rows(named=True)]
    filled = [i for i in range(len(names)) if any(row[i] for row in cell_rows)]
    return [headers[i] for i in filled], [[row[i] for i in filled] for row in cell_rows]


def table_json(table: ResultTable) -> dict[str, Any]:
    """A table as it is stored in JSON files."""
    return {"title": table.title, "note": table.note, "rows": table.rows.to_dicts()}


def table_csv(table: ResultTable) -> str:
    """A table as CSV."""
    buffer = io.BytesIO()
    table.rows.write_csv(buffer)
    return buffer.getvalue().decode()


def _with_neutral_folded(rows: pl.DataFrame) -> pl.DataFrame:
    """The rows, with neutral genes merged into one row: their number, how many have a small p, and their means."""
    if rows.is_empty() or rows.schema.get("weight") != pl.String:
        return rows
    keys = [name for name in _KEYS if name in rows.columns]
    numbered = rows.with_columns(pl.int_range(pl.len()).alias("place"))
    is_neutral = pl.col("weight").str.starts_with("neutral_").fill_null(False)
    if numbered.filter(is_neutral)["weight"].n_unique() < 2:
        return rows
    values = {
        name: pl.col(name).mean() if kind.is_float() else pl.col(name).max()
        for name, kind in rows.schema.items()
        if kind.is_numeric() and name not in _INTERVAL and not name.startswith("p")
    }
    small_p = pl.format(": {} with p < 0.05", (pl.col("p") < 0.05).sum()) if "p" in rows.columns else pl.lit("")
    label = pl.format("{} neutral{}", pl.len(), small_p.first()).alias("weight")
    groups = numbered.filter(is_neutral).group_by(keys or [pl.lit(0).alias("all")], maintain_order=True)
    lines = groups.agg(pl.col("place").min(), label, **values)
    return pl.concat([numbered.filter(~is_neutral), lines], how="diagonal_relaxed").sort("place").select(rows.columns)


def is_numeric(rows: Sequence[Sequence[str]], column: int) -> bool:
    """Whether a displayed column contains numbers, which are right-aligned."""
    return all(not row[column] or row[column][0] in "0123456789-<" for row in rows)


def format_number(value: float | None) -> str:
    """A number for display: an integer from 1000 up, otherwise three significant figures; a dash for None."""
    if value is None:
        return NOTHING
    if isinstance(value, int) or abs(value) >= 1000:
        return f"{value:,.0f}"
    return f"{value:#.3g}".rstrip(".") if abs(value) >= 0.01 or value == 0 else f"{value:.2g}"


def format_p(p: float | None) -> str:
    """A p value for display: like any number, but "< 0.0001" if it is smaller."""
    return f"< {LEAST_P:g}" if p is not None and p < LEAST_P else format_number(p)


def _cell(row: Mapping[str, Any], column: str, merged: bool) -> str:
    if merged and column == "low":
        return _interval(row)
    value = row[column]
    return format_p(value) if isinstance(value, float) and _holds_p(column) else _format(value)


def _holds_p(column: str) -> bool:
    """Whether a column holds p values: "p", or one with its kind, as in "p_holm" and "p slope"."""
    return column == "p" or column.startswith(("p_", "p "))


def _interval(row: Mapping[str, Any]) -> str:
    if row["low"] is None or row["high"] is None or row.get("worlds", FOR_INTERVAL) < FOR_INTERVAL:
        return ""
    return f"{_format(row['low'])} … {_format(row['high'])}"


def _format(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, float) and 0 < abs(value) < 1e-12:
        return "0"  # a rounding error
    return format_number(value) if isinstance(value, (int, float)) else str(value)
