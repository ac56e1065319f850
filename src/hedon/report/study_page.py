"""Studies as one page: verdicts, then for each item what its source says and what was found, then settings."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import by_condition
from hedon.report.page import FigureFile, condition_context, render, runs_context, table_context
from hedon.study.gather import Gathered
from hedon.study.item import Item
from hedon.study.study import Study

HTML, MARKDOWN = "study.html", "study.md"


@dataclass(frozen=True)
class BuiltItem:
    """An item as it was made.

    Attributes:
        item: what it is.
        worlds: that it was made of: a row for each condition.
        parts: its figures and tables, in order.
    """

    item: Item
    worlds: ResultTable | None
    parts: tuple[FigureFile | ResultTable, ...]

    @property
    def tables(self) -> list[ResultTable]:
        """Its tables."""
        return [part for part in self.parts if isinstance(part, ResultTable)]


def study_pages(
    studies: Sequence[Study], gathered: Gathered, made: Sequence[BuiltItem], overall: Sequence[ResultTable]
) -> dict[str, str]:
    """The page by the names of its files: as HTML that needs no other file, and as Markdown beside its figures."""
    built = {one.item.name: _item_context(one) for one in made}
    context = {
        "title": " · ".join(study.title for study in studies),
        "fidelity": gathered.request.fidelity,
        "overall": [table_context(found) for found in overall if found.shown],
        "studies": [
            {
                "question": study.question,
                "title": study.title,
                "expectation": study.expectation,
                "items": [built[item.name] for item in study.items],
            }
            for study in studies
        ],
        "conditions": [condition_context(name, worlds) for name, worlds in by_condition(gathered.demanded()).items()],
        "faults": gathered.faults,
        **runs_context(gathered.runs),
    }
    return {HTML: render("study.html.j2", context), MARKDOWN: render("study.md.j2", context)}


def _item_context(one: BuiltItem) -> dict[str, Any]:
    parts: list[dict[str, Any]] = []
    for part in one.parts:
        if isinstance(part, FigureFile):
            parts.append({"figure": part, "table": None})
        elif part.shown and not part.rows.is_empty():
            parts.append({"figure": None, "table": table_context(part)})
    return {
        "name": one.item.name,
        "title": one.item.title,
        "says": one.item.says,
        "worlds": table_context(one.worlds) if one.worlds is not None else None,
        "parts": parts,
    }
