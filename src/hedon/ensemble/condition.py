"""A condition of an ensemble that is planned: a base config, and what the condition changes in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hedon.config.config import Config
from hedon.record.manifest import RuleSource

DIGITS = 16
"""Of a digest that names a config."""

Settings = dict[str, Any]
"""A value for each factor, by its name."""


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
