"""Checks all input: turns plain nested tables into a `Config`, or raises one error that names all problems."""

import json
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import cache
from typing import TYPE_CHECKING, Any

from hedon.config.check import contradictions
from hedon.config.config import Config
from hedon.config.field import Setting, find, places, sections, settings
from hedon.config.problem import ConfigError, Problem, folded, format_path, format_value, nearest
from hedon.config.species import PER_SPECIES
from hedon.config.toml import require_plain
from hedon.error import ArgumentError
from hedon.text import brief

if TYPE_CHECKING:
    from pydantic import TypeAdapter
    from pydantic_core import ErrorDetails


def from_tables(tables: Mapping[str, Any], origin: str = "config") -> Config:
    """Builds a config from nested tables; settings that are not given have their defaults.

    Args:
        tables: Sections and settings by name, as TOML gives them.
        origin: The name of the tables in errors.

    Raises:
        ConfigError: A type, a range or a name is wrong, or settings contradict one another.
    """
    require_plain(tables, origin)
    config, errors = _try(tables)
    problems = list(dict.fromkeys(_problem(details) for details in errors))
    if errors:
        # Leave out what is wrong by itself, so that the same error also lists contradictions among the rest.
        config, _ = _try(_without(tables, [details["loc"] for details in errors]))
    if config is not None:
        wrong = [_parts(problem.path) for problem in problems]
        problems += [
            each for each in contradictions(config) if not any(_overlap(_parts(each.path), path) for path in wrong)
        ]
    if problems or config is None:
        species = tables.get("species")
        raise ConfigError(origin, folded(problems, tuple(species) if isinstance(species, Mapping) else ()))
    return config


def _try(tables: Mapping[str, Any]) -> "tuple[Config | None, list[ErrorDetails]]":
    from pydantic import ValidationError

    try:
        # Through JSON: only there does a strict validator accept tables for dataclasses and lists for tuples.
        return _validator().validate_json(json.dumps(tables, default=_plain)), []
    except ValidationError as error:
        return None, error.errors(include_url=False)


def _plain(value: Any) -> Any:
    """NumPy's numbers as Python's, anything else as text, which a setting for numbers refuses."""
    return value.item() if hasattr(value, "item") else str(value)


def _parts(path: str) -> list[str]:
    return re.split(r"[.\[]", path)


def _overlap(path: list[str], other: list[str]) -> bool:
    """Whether two paths name the same setting, or one path names a section that holds the other."""
    return all(x == y for x, y in zip(path, other, strict=False))


def _without(tables: Mapping[str, Any], locations: Sequence[Sequence[str | int]]) -> dict[str, Any]:
    """A copy of nested tables without the settings at these places."""
    kept, below = {}, defaultdict(list)
    for location in locations:
        below[location[0]].append(location[1:])
    for name, value in tables.items():
        inner = below[name]
        if isinstance(value, Mapping) and all(inner):
            kept[name] = _without(value, inner)
        elif not inner:
            kept[name] = value
    return kept


def validated(config: Config, origin: str = "config") -> Config:
    """The same config, after all checks; for a config that was made in Python.

    Args:
        config: put together in any way.
        origin: what errors call it.

    Raises:
        ConfigError: As `from_tables`.
        ArgumentError: It is not a `Config`.
    """
    if not isinstance(config, Config):
        raise ArgumentError(f"config: must be a Config, as `load_config` gives it, not {brief(repr(config))}")
    return from_tables(asdict(config), origin)


@cache
def _validator() -> "TypeAdapter[Config]":
    from pydantic import TypeAdapter

    return TypeAdapter(Config)


def _problem(details: "ErrorDetails") -> Problem:
    location = details["loc"]
    path = format_path(location)
    if details["type"] == "unexpected_keyword_argument":
        return Problem(path, "unknown name", nearest=_nearest_name(location))
    target = find(Config, location)
    if isinstance(target, Setting):
        given = details["input"]
        near = nearest(given, target.choices) if isinstance(given, str) else None
        return Problem(path, f"must be {target.allowed}", format_value(given), near)
    if target is not None:
        return Problem(path, "must be a table", format_value(details["input"]))
    return Problem(path, details["msg"])


def _nearest_name(location: Sequence[str | int]) -> str | None:
    """The name nearest to an unknown one in its section, else the sections that have this name."""
    name, section = str(location[-1]), find(Config, location[:-1])
    if not isinstance(section, type):
        return None
    default = PER_SPECIES if section is Config else ()
    beside = nearest(name, [*settings(section), *sections(section), *default])
    return beside or " or ".join(places(Config, name)) or None
