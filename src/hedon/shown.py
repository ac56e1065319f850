"""Representations of objects: one line, or a small table in a notebook."""

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

MOST_ROWS = 12
"""Maximum number of rows of a table in a notebook."""


def table_html(title: str, headers: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A small table with a title; of many rows, it shows the first and the number of the rest."""
    every = list(rows)
    head = "".join(f"<th>{escape(each)}</th>" for each in headers)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in every[:MOST_ROWS]
    )
    more = f"<br>… and {len(every) - MOST_ROWS:,} more" if len(every) > MOST_ROWS else ""
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>" if every else ""
    return f"<div><strong>{escape(title)}</strong>{table}{more}</div>"
