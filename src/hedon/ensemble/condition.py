"""A planned condition: a base config, and the settings that the condition changes in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hedon.config.config import Config
from hedon.config.problem import format_value
from hedon.record.manifest import RuleSource

DIGITS = 16
"""Length of a digest that names a config."""

Settings = dict[str, Any]
"""The value of each factor, by name."""


def describe(settings: Settings, seeds: Sequence[int]) -> str:
    """Values of factors and seeds as short text: "basic_cost=0.002, seed 4". Names are shortened while still unique.

    Args:
        settings: Value of each factor.
        seeds: Seeds of the worlds.
    """
    words = [
        f"{short_name}={format_value(value)}"
        for short_name, value in zip(_short(list(settings)), settings.values(), strict=True)
    ]
    return ", ".join([*words, f"seed{'' if len(seeds) == 1 else 's'} {seed_text(seeds).replace('.', ',')}"])


def seed_text(seeds: Sequence[int]) -> str:
    """Seeds as part of a name, such as "1-4.9"; `parse_seeds` reads it after replacing "." by ","."""
    starts = [i for i in range(len(seeds)) if i == 0 or seeds[i] != seeds[i - 1] + 1]
    ends = [*starts[1:], len(seeds)]
    runs = [(seeds[start], seeds[end - 1]) for start, end in zip(starts, ends, strict=True)]
    return ".".join(f"{first}" if first == last else f"{first}-{last}" for first, last in runs)


def _short(names: Sequence[str]) -> list[str]:
    """The shortest endings of some paths that are still unique."""
    for parts in range(1, 9):
        short_names = [".".join(name.split(".")[-parts:]) for name in names]
        if len(set(short_names)) == len(names):
            return short_names
    return list(names)


@dataclass(frozen=True)
class Base:
    """A config from which conditions are derived.

    Attributes:
        digest: Digest of the config, shortened to `DIGITS`.
        config: The config.
        rules: Source texts of its rules.
        places: Complete paths of the settings that each factor changes in it.
    """

    digest: str
    config: Config
    rules: tuple[RuleSource, ...]
    places: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class SweepCondition:
    """A condition of a sweep.

    Attributes:
        digest: Digest of its config, shortened to `DIGITS`.
        base: Digest of its base, shortened likewise.
        settings: Values of the factors, by name.
    """

    digest: str
    base: str
    settings: Settings


def changes(places: Mapping[str, Sequence[str]], settings: Settings) -> dict[str, Any]:
    """The settings that a condition changes in its base, by complete path.

    Args:
        places: Complete paths of the settings that each factor changes.
        settings: Value of each factor.
    """
    return {path: settings[name] for name, paths in places.items() for path in paths}
