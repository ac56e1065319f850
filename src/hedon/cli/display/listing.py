"""Items of a request as a table, with the needs and time of each."""

from collections.abc import Iterable
from dataclasses import replace

from rich.console import Group
from rich.text import Text

from hedon.cli.display.run import duration
from hedon.cli.display.table import PrintedTable
from hedon.study.cost import RequestCost
from hedon.study.item import Item
from hedon.study.request import Request
from hedon.study.study import Study
from hedon.text import count


def catalogue(studies: Iterable[Study]) -> Group:
    """Output of `hedon study list`: for each study its question and a table of items."""
    parts: list[PrintedTable | Text] = []
    for study in studies:
        rows = [(item.name, item.title) for item in study.items]
        parts += [Text(f"{study.name}: {study.question}"), PrintedTable(("item", "what it is"), rows, text=range(2))]
    return Group(*parts)


def listing(request: Request, cost: RequestCost) -> Group:
    """Output of `hedon study plan`.

    Args:
        request: Items that the user requested.
        cost: Estimated time of their runs [s].
    """
    rows = [
        (item.name, item.title, _needs(request, item), _time(its.total), _time(its.left))
        for item, its in zip(request.items, cost.items, strict=True)
    ]
    together = _time(cost.together.total), _time(cost.together.left)
    rows.append(("together", "shared worlds are counted once", "", *together))
    headers = ("item", "what it is", "needs", "total", "still to run")
    table = PrintedTable(headers, rows, text=range(3), total=True)
    notes = [
        f"Measured now: {speed.rate:,.0f} world-steps/s on {count(speed.threads, 'thread')}"
        f" with {speed.agents:.0f} agents a world and {count(kinds, 'kind')} of food;"
        " worlds with more agents take longer, worlds with fewer take less time."
        for kinds, speed in cost.speeds.items()
    ]
    return Group(table, *(Text(note, style="dim") for note in notes))


def _needs(request: Request, item: Item) -> str:
    if not item.conditions:
        return "only settings"
    scale = request.scale(item)
    settings = {replace(each, label="", species="") for each in item.conditions}  # two species are two conditions
    parts = [count(len(settings), "setting"), count(len(scale.seeds), "world")]
    return ", ".join([*parts, f"{scale.steps:,} steps"])


def _time(seconds: float) -> str:
    return duration(seconds) if seconds >= 1 else "-"
