"""The tables of an analysis on a terminal."""

from collections.abc import Mapping

from rich.console import Group
from rich.text import Text

from hedon.analysis.result import ResultTable
from hedon.cli.display.table import PrintedTable
from hedon.report.table import HIDDEN, cells, is_numeric


def analysis_group(tables: Mapping[str, ResultTable]) -> Group:
    """Output of `hedon analyze`: the short tables with their notes."""
    parts: list[PrintedTable | Text] = []
    for table in tables.values():
        if table.shown:
            parts.append(_printed(table))
            if table.note:
                parts += [Text(table.note, style="dim"), Text()]
    return Group(*parts)


def _printed(table: ResultTable) -> PrintedTable:
    headers, rows = cells(table, (*HIDDEN, "text"))  # a terminal is too narrow for the full text of a claim
    text = [i for i in range(len(headers)) if not is_numeric(rows, i)]
    return PrintedTable(headers, rows, title=table.title, text=text)
