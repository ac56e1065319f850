"""Paths of rule files, relative to the TOML file that names them or, in overrides, to the current folder."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hedon.config.schema.settings import Settings
from hedon.config.schema.species import RULE_USES

RULE_PATTERN = r"(.+\.py):([A-Za-z_]\w*)(?:@([0-9a-f]{16}))?"
"""A rule: its file, its function and, once a run uses it, the file's digest."""


def rule_places(config: Settings) -> tuple[str, ...]:
    """References to all rules of a config, as `rule` settings."""
    places = (getattr(species, use).rule for species in config.species.values() for use in RULE_USES)
    return tuple(place for place in places if place)


def absolute_rule(place: Any, folder: Path) -> Any:
    """A reference to a rule with the absolute path of its file, if that is relative to `folder`.

    A reference with a digest is unchanged, because the run keeps the rule's text wherever the file is now. An invalid
    reference is unchanged too, and refused later.
    """
    match = re.fullmatch(RULE_PATTERN, place) if isinstance(place, str) else None
    if match is None or match[3] or "\0" in place:
        return place
    return f"{folder.absolute() / match[1]}:{match[2]}"


def with_absolute_rules(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Tables of a config with absolute paths of rule files."""
    result = dict(tables)
    for name, value in tables.items():
        if isinstance(value, dict):
            result[name] = with_absolute_rules(value, folder)
        elif name == "rule":
            result[name] = absolute_rule(value, folder)
    return result
