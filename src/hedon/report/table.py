"""Tables of an analysis for the terminal, for Markdown and for HTML: the same cells everywhere."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Group
from rich.text import Text

from hedon.analysis.summary_table import format_number
from hedon.analysis.topic.result import ResultTable
from hedon.printed_table import PrintedTable
from hedon.report.markdown import pipe_table
from hedon.statistic.interval import SHOWN_FROM

HIDDEN = ("source", "region_low", "region_high", "window")
"""Columns that only the files hold."""
_INTERVAL = ("low", "high")


def cells(table: ResultTable, hidden: Sequence[str] = HIDDEN) -> tuple[list[str], list[list[str]]]:
    """What a reader sees of a table: headers and rows.

    The bounds of an interval become one column, empty below three worlds; a column `condition` with a single
    value is left out, and so is every column without any.

    Args:
        table: the results.
        hidden: columns that are left out too.
    """
    rows = table.rows
    single = "condition" in rows.columns and rows["condition"].n_unique() == 1
    merged = all(bound in rows.columns for bound in _INTERVAL) and "answer" not in rows.columns
    names = [
        c
        for c in rows.columns
        if c not in hidden and not (c == "condition" and single) and not (c == "high" and merged)
    ]
    headers = ["95 % interval" if merged and c == "low" else c.replace("_", " ") for c in names]
    shown = [[_cell(row, c, merged) for c in names] for row in rows.iter_rows(named=True)]
    filled = [i for i in range(len(names)) if any(row[i] for row in shown)]
    return [headers[i] for i in filled], [[row[i] for i in filled] for row in shown]


def is_numeric(rows: Sequence[Sequence[str]], column: int) -> bool:
    """Whether a shown column holds numbers, which are aligned to the right."""
    return all(not row[column] or row[column][0] in "0123456789-" for row in rows)


def analysis_group(tables: Mapping[str, ResultTable]) -> Group:
    """What `hedon analyze` prints: the short tables with their notes."""
    parts: list[PrintedTable | Text] = []
    for table in tables.values():
        if table.shown:
            parts.append(_printed(table))
            if table.note:
                parts += [Text(table.note, style="dim"), Text()]
    return Group(*parts)


def _printed(table: ResultTable) -> PrintedTable:
    headers, rows = cells(table, (*HIDDEN, "text"))  # a terminal is too narrow for a claim in full
    text = [i for i in range(len(headers)) if not is_numeric(rows, i)]
    return PrintedTable(headers, rows, title=table.title, text=text)


def _cell(row: Mapping[str, Any], column: str, merged: bool) -> str:
    if merged and column == "low":
        return _interval(row)
    return _format(row[column])


def _interval(row: Mapping[str, Any]) -> str:
    if row["low"] is None or row["high"] is None or row.get("worlds", SHOWN_FROM) < SHOWN_FROM:
        return ""
    return f"{_format(row['low'])} … {_format(row['high'])}"


def _format(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, float) and 0 < abs(value) < 1e-12:
        return "0"  # rounding
    return format_number(value) if isinstance(value, (int, float)) else str(value)


def markdown_table(table: ResultTable) -> str:
    """The cells as a Markdown table."""
    headers, rows = cells(table)
    return pipe_table(headers, rows)
