"""Makes external text safe to print in a message."""

import os
import re
import shlex

LINE = 200
"""Maximum characters of a name or a value in a message; more would hide the message."""
LEAST_P = 1e-4
"""Smallest p value that people are shown; how much smaller one is depends on assumptions that few worlds can check."""


def printable(text: str) -> str:
    r"""Escapes characters that are invisible, or that reverse the order of others, to forms such as \u202e.

    Line breaks stay, since messages have several lines.
    """
    return "".join(c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode() for c in text)


def brief(text: str, limit: int = LINE) -> str:
    """The text, or its beginning and its length if it has more than `limit` characters."""
    return text if len(text) <= limit else f"{text[:limit]}… ({len(text):,} characters)"


def command_word(text: str) -> str:
    """Quotes a path as one word of a command that a user can copy."""
    if os.name != "nt":
        return shlex.quote(text)
    return text if re.fullmatch(r"[\w\\/:.-]+", text) else f'"{text}"'


def count(number: int, noun: str) -> str:
    """A count with its noun: "1 run", "2 runs"."""
    ending = "" if number == 1 else "es" if noun.endswith("ch") else "s"
    return f"{number:,} {noun}{ending}"


def p_phrase(p: float) -> str:
    """A p value within a sentence: "p = 0.028" or "p < 0.0001"."""
    return f"p < {LEAST_P:g}" if p < LEAST_P else f"p = {p:.2g}"
