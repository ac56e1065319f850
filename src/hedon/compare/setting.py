"""The settings in which two conditions differ."""

from collections.abc import Sequence
from typing import Any

from hedon.check.difference import changed_line
from hedon.config import Config
from hedon.config.dump import diff
from hedon.text import count

MOST_SHOWN = 10
"""Largest number of settings that are listed."""
MOST_CLEAR = 3
"""Largest number of differing settings without a caution."""


def differing_settings(first: Config, second: Config) -> list[tuple[str, Any, Any]]:
    """The settings in which the worlds of two conditions differ, with both values; colors change no world."""
    return [row for row in diff(first, second) if not row[0].endswith(".color")]


def setting_lines(rows: Sequence[tuple[str, Any, Any]]) -> list[str]:
    """A line for each setting, as `hedon check A --against B` shows it; beyond `MOST_SHOWN`, their number."""
    lines = [changed_line(*row) for row in rows[:MOST_SHOWN]]
    return lines + ([f"and {count(len(rows) - MOST_SHOWN, 'other setting')}"] if len(rows) > MOST_SHOWN else [])


def setting_cautions(rows: Sequence[tuple[str, Any, Any]]) -> list[str]:
    """Sentences on what a comparison of conditions that differ in these settings cannot show."""
    if not rows:
        return ["No setting differs: these are two samples of the same condition."]
    if len(rows) > MOST_CLEAR:
        return [f"{len(rows)} settings differ: the comparison cannot tell which of them matters."]
    return []
