"""A condition of an ensemble that is planned: a base config, and what the condition changes in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hedon.config.config import Config
from hedon.config.problem import format_value
from hedon.record.manifest import RuleSource

DIGITS = 16
"""Of a digest that names a config."""

Settings = dict[str, Any]
"""A value for each factor, by its name."""


def describe(settings: Settings, seeds: Sequence[int]) -> str:
    """Values of factors and seeds in a few words: "basic_cost=0.002, seed 4"; names are as short as they tell apart."""
    words = [
        f"{short}={format_value(value)}" for short, value in zip(_short(list(settings)), settings.values(), strict=True)
    ]
    return ", ".join([*words, f"seed{'' if len(seeds) == 1 else 's'} {seed_text(seeds).replace('.', ',')}"])


def seed_text(seeds: Sequence[int]) -> str:
    """Seeds as part of a name, "1-4.9"; `parse_seeds` reads it with "," for "."."""
    begins = [i for i in range(len(seeds)) if i == 0 or seeds[i] != seeds[i - 1] + 1]
    ends = [*begins[1:], len(seeds)]
    runs = [(seeds[begin], seeds[end - 1]) for begin, end in zip(begins, ends, strict=True)]
    return ".".join(f"{first}" if first == last else f"{first}-{last}" for first, last in runs)


def _short(names: Sequence[str]) -> list[str]:
    """The ends of some paths that tell them apart."""
    for parts in range(1, 9):
        short = [".".join(name.split(".")[-parts:]) for name in names]
        if len(set(short)) == len(names):
            return short
    return list(names)


@dataclass(frozen=True)
class Base:
    """A config that conditions begin with.

    Attributes:
        digest: of the config, `DIGITS` of it.
        config: itself.
        rules: the texts of its rules.
        places: the settings that each factor changes in it, by complete paths.
    """

    digest: str
    config: Config
    rules: tuple[RuleSource, ...]
    places: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class SweepCondition:
    """A setting of a sweep.

    Attributes:
        digest: of its config, `DIGITS` of it.
        base: that of its base.
        settings: values of the factors, by name.
    """

    digest: str
    base: str
    settings: Settings


def changes(places: Mapping[str, Sequence[str]], settings: Settings) -> dict[str, Any]:
    """What a condition changes in its base, by complete paths."""
    return {place: settings[name] for name, own in places.items() for place in own}
