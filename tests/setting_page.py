"""Parses the page of settings and flattens a config, independently of the code that writes them."""

import re
import tomllib
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, NamedTuple

NUMBERS = ("gives", "needs", "observes")
"""Settings that are tables of numbers."""
PAGE = Path(__file__).parents[1] / "docs" / "config.md"


class Row(NamedTuple):
    """One setting as shown on the page."""

    default: Any
    meaning: str
    unit: str
    allowed: str
    source: str


def page_rows(kinds: dict[str, str]) -> dict[str, Row]:
    """Rows of the page by setting path; `kinds` has a path for each section with a `<kind>`."""
    found, section = {}, None
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            section = re.sub(r"^## (`\[(.*)\]`|At the top)$", r"\2", line)
            for pattern in sorted(kinds, key=len, reverse=True):
                section = section.replace(pattern, kinds[pattern])
        elif section not in (None, "## Channels") and line.startswith("| `"):
            cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            name, default, *rest = cells
            path = f"{section}.{name.strip('`')}".lstrip(".")
            found[path] = Row(tomllib.loads(f"it = {default.strip('`')}")["it"], *rest)
    return found


def values(part: Any, path: str = "") -> dict[str, Any]:
    """Each value of a config by its path in a single-species file, with lists for tuples."""
    inner = part.items() if isinstance(part, dict) else ((each.name, getattr(part, each.name)) for each in fields(part))
    found = {}
    for name, value in inner:
        if name not in NUMBERS and (isinstance(value, dict) or is_dataclass(value)):
            found |= values(value, f"{path}{name}.")
        else:
            found[f"{path}{name}".removeprefix("species.agent.")] = _plain(value)
    return found


def _plain(value: Any) -> Any:
    return [_plain(each) for each in value] if isinstance(value, tuple) else value
