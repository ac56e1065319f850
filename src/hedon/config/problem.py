"""Problems of a config, each with its place, the allowed values, and the nearest valid name."""

import json
import math
import re
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

from hedon.config.field import value_at
from hedon.error import HedonError
from hedon.text import LINE, brief

SMALLEST = 2.0**-126
"""Smallest positive number that the engine distinguishes from 0; it flushes denormal numbers to 0."""
SHOWN = 20
"""Maximum number of problems listed in a message."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One problem in a config.

    Attributes:
        path: Its place: "food.normal.growth_rate"; "" for the source as a whole.
        message: What is wrong and what is allowed.
        value: The value there, as text; None if it would not help.
        nearest: A valid name close to the given one, if there is one.
    """

    path: str
    message: str
    value: str | None = None
    nearest: str | None = None

    def __str__(self) -> str:
        path = brief(self.path)
        place = f"{path} = {brief(self.value)}" if self.value is not None else path
        hint = f"; did you mean {self.nearest}?" if self.nearest else ""
        message = brief(self.message, 2 * LINE)
        return f"{place}: {message}{hint}" if place else f"{message}{hint}"


class ConfigError(HedonError):
    """An invalid config. It holds all problems; its message lists the first ones and gives their number.

    Attributes:
        origin: The preset or file that was read.
        problems: All problems, in the order of the file if there is one.
    """

    def __init__(self, origin: str, problems: Iterable[Problem]) -> None:
        self.origin = origin
        self.problems = tuple(problems)
        count, lines = len(self.problems), [str(problem) for problem in self.problems[:SHOWN]]
        if count == 1:
            super().__init__(f"{brief(origin)}: {lines[0]}")
        else:
            remainder = [f"and {count - SHOWN:,} more"] if count > SHOWN else []
            super().__init__("\n  ".join([f"{brief(origin)}: {count:,} problems", *lines, *remainder]))


class Check:
    """Collects the problems of a config.

    Args:
        config: The config to check.
    """

    def __init__(self, config: Any) -> None:
        self.config = config
        self.problems: list[Problem] = []

    def add(self, path: str, rule: str, near: str | None = None) -> None:
        """Adds a problem that is not due to a single value."""
        self.problems.append(Problem(path, rule, nearest=near))

    def need(self, good: bool, path: str, rule: str, value: Any = None, near: str | None = None) -> None:
        """Adds a problem unless `good`."""
        if not good:
            value_text = format_value(value_at(self.config, path) if value is None else value)
            self.problems.append(Problem(path, rule, value_text, near))

    def match(self, pattern: str, path: str, rule: str) -> None:
        """Adds a problem unless the string at a path fully matches a pattern."""
        self.need(bool(re.fullmatch(pattern, value_at(self.config, path))), path, rule)

    def has(self, start: str) -> bool:
        """Whether any problem's path starts with `start`."""
        return any(problem.path.startswith(start) for problem in self.problems)


def folded(problems: Iterable[Problem], species: Sequence[str]) -> list[Problem]:
    """Merges each problem that all species share into one under the path of the file's default."""
    listed: list[Problem] = list(problems)
    by_default: dict[Problem, set[Problem]] = {}
    for problem in listed:
        for name in species:
            path = problem.path.removeprefix(f"species.{name}.")
            if path != problem.path:
                by_default.setdefault(replace(problem, path=path), set()).add(problem)
    defaults = {
        original: default
        for default, originals in by_default.items()
        if len(originals) == len(species)
        for original in originals
    }
    return list(dict.fromkeys(defaults.get(original, original) for original in listed))


def format_value(value: Any) -> str:
    """Formats a value as TOML; a table with anything but numbers becomes "a table"."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(format_value(item) for item in value) + "]"
    if not isinstance(value, dict):
        return repr(value)
    if any(isinstance(item, bool) or not isinstance(item, int | float) for item in value.values()):
        return "a table"
    return "{" + ", ".join(f"{name} = {item!r}" for name, item in value.items()) + "}"


def single(value: float) -> float:
    """Converts a number to the engine's 32 bits: infinite beyond their range, 0 where they lose precision."""
    try:
        rounded = struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return rounded if abs(rounded) >= SMALLEST else 0.0


def nearest(name: str, names: Iterable[str], alike: float = 0.6) -> str | None:
    """The closest valid name, or None if none is close."""
    if len(name) > LINE:  # longer than any valid name, and slow to compare
        return None
    matches = get_close_matches(name, list(names), n=1, cutoff=alike)
    return matches[0] if matches else None


def did_you_mean(name: str, names: Iterable[str], otherwise: str = "") -> str:
    """The end of a message on an unknown name: "; did you mean NAME?", or `otherwise` if no valid name is close."""
    match = nearest(name, names)
    return f"; did you mean {match}?" if match else otherwise
