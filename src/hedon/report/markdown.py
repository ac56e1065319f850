"""Escapes text for Markdown, so that names of folders, settings and foods are shown literally."""

import re
from collections.abc import Sequence

_SPECIAL = re.compile(r"[\\`*\[\]<>&|#~$]|(?<!\w)_|_(?!\w)")  # an underscore within a word has no meaning in Markdown


def escape_markdown(text: str) -> str:
    """Markdown that shows a text literally, on one line."""
    return _SPECIAL.sub(r"\\\g<0>", re.sub(r"\s*\n\s*", " ", text))


def pipe_table(headers: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table of escaped cells."""
    lines = [headers, *rows]
    head, *body = ["| " + " | ".join(map(escape_markdown, line)) + " |" for line in lines]
    return "\n".join([head, "| " + " | ".join(["---"] * len(headers)) + " |", *body]) + "\n"
