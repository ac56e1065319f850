"""Makes text from outside safe to print in a message."""

import os
import re
import shlex

LINE = 200
"""Characters of a name or a value that a message shows; more would hide the message."""


def printable(text: str) -> str:
    r"""The text with characters that are invisible, or that reverse the order of others, as escapes such as \u202e.

    Line breaks stay: messages have several lines.
    """
    return "".join(c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode() for c in text)


def brief(text: str, limit: int = LINE) -> str:
    """The text, or its beginning and its length if it has more than `limit` characters."""
    return text if len(text) <= limit else f"{text[:limit]}… ({len(text):,} characters)"


def command_word(text: str) -> str:
    """A path as one word of a command that a user copies."""
    if os.name != "nt":
        return shlex.quote(text)
    return text if re.fullmatch(r"[\w\\/:.-]+", text) else f'"{text}"'


def count(number: int, noun: str) -> str:
    """A number of things: "1 run", "2 runs"."""
    ending = "" if number == 1 else "es" if noun.endswith("ch") else "s"
    return f"{number:,} {noun}{ending}"
