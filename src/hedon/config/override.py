"""Single settings from the command line, such as `food.normal.growth_rate=0.5`."""

import re
import tomllib
from typing import Any

from hedon.config.layer import Table
from hedon.config.problem import Problem

_PART = re.compile(r'"([^"]+)"|([\w*-]+)')
_WORD = re.compile(r"[A-Za-z_#][\w.#/-]*")


def parse_override(text: str) -> Table | Problem:
    """Parses `path=value` into nested tables.

    Returns:
        The tables, or the problem with the text.
    """
    path, sign, value_text = text.partition("=")
    names = parse_path(path.strip())
    if not sign or not names:
        return Problem(repr(text), 'must be "section.name=value", as in energy.initial=20')
    try:
        value = _value(value_text.strip())
    except (ValueError, RecursionError):
        return Problem(path.strip(), 'not a TOML value; a text of several words needs quotes: "…"', value_text.strip())
    for name in reversed(names):
        value = {name: value}
    return value


def parse_path(path: str) -> list[str]:
    """Names in a path, without quotes; empty for an invalid path."""
    names, position = [], 0
    while match := _PART.match(path, position):
        names.append(match[1] or match[2])
        if match.end() == len(path):
            return names
        if path[match.end()] != ".":
            return []
        position = match.end() + 1
    return []


def _value(text: str) -> Any:
    try:
        tables = tomllib.loads(f"value = {text}\n")
    except tomllib.TOMLDecodeError:
        if _WORD.fullmatch(text):
            return text
        raise
    if list(tables) != ["value"]:
        raise ValueError(text)
    return tables["value"]
