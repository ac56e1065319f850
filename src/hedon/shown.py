"""How objects show themselves: in one line, and in a notebook as a small table."""

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

MOST_ROWS = 12
"""Most rows of a table in a notebook."""


def table_html(title: str, headers: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A small table with a title; of many rows the first ones, and how many more there are."""
    every = list(rows)
    head = "".join(f"<th>{escape(each)}</th>" for each in headers)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in every[:MOST_ROWS]
    )
    more = f"<br>… and {len(every) - MOST_ROWS:,} more" if len(every) > MOST_ROWS else ""
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>" if every else ""
    return f"<div><strong>{escape(title)}</strong>{table}{more}</div>"
