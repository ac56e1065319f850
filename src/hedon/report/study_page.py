"""A reproduction as one page: verdicts, then for each item what the paper shows and what was found, then settings."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hedon.analysis.table import ResultTable
from hedon.analysis.world.record import by_condition
from hedon.report.page import FigureFile, condition_context, render, runs_context, table_context
from hedon.study.gather import Gathered
from hedon.study.item import Item


@dataclass(frozen=True)
class Made:
    """An item as it was made.

    Attributes:
        item: what it is.
        worlds: that it was made of: a row for each arm.
        parts: its figures and tables, in order.
    """

    item: Item
    worlds: ResultTable | None
    parts: tuple[FigureFile | ResultTable, ...]

    @property
    def tables(self) -> list[ResultTable]:
        """Its tables."""
        return [part for part in self.parts if isinstance(part, ResultTable)]


def html_page(gathered: Gathered, made: Sequence[Made], overall: Sequence[ResultTable]) -> str:
    """The page as HTML that needs no other file.

    Args:
        gathered: The worlds of a request, by item.
        made: The items, in the order of the page.
        overall: Tables about all of them.
    """
    return render("study.html.j2", _context(gathered, made, overall))


def markdown_page(gathered: Gathered, made: Sequence[Made], overall: Sequence[ResultTable]) -> str:
    """The page as Markdown, with the figures as files beside it.

    Args:
        gathered: The worlds of a request, by item.
        made: The items, in the order of the page.
        overall: Tables about all of them.
    """
    return render("study.md.j2", _context(gathered, made, overall))


def _context(gathered: Gathered, made: Sequence[Made], overall: Sequence[ResultTable]) -> dict[str, Any]:
    return {
        "title": "Evolution of rewards, reproduced",
        "fidelity": gathered.request.fidelity,
        "overall": [table_context(found) for found in overall if found.shown],
        "items": [_item_context(one) for one in made],
        "conditions": [condition_context(name, worlds) for name, worlds in by_condition(gathered.demanded()).items()],
        "faults": gathered.faults,
        **runs_context(gathered.runs),
    }


def _item_context(one: Made) -> dict[str, Any]:
    parts: list[dict[str, Any]] = []
    for part in one.parts:
        if isinstance(part, FigureFile):
            parts.append({"figure": part, "table": None})
        elif part.shown and not part.rows.is_empty():
            parts.append({"figure": None, "table": table_context(part)})
    return {
        "name": one.item.name,
        "title": one.item.title,
        "kind": one.item.kind,
        "paper": one.item.paper,
        "worlds": table_context(one.worlds) if one.worlds is not None else None,
        "parts": parts,
    }
