"""Checks all input: builds settings from plain nested tables, or raises one error that lists all problems."""

import math
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import is_dataclass, replace
from typing import Any, TypeVar, cast, get_args, get_origin

from hedon.config.check import contradictions
from hedon.config.field import Setting, number_of, sections, settings
from hedon.config.problem import ConfigError, Problem, folded, format_value, nearest, single
from hedon.config.schema.settings import Settings
from hedon.config.schema.species import PER_SPECIES
from hedon.config.toml import require_plain

T = TypeVar("T")
S = TypeVar("S", bound=Settings)


def build(root: type[S], tables: Mapping[str, Any], origin: str, found: Sequence[Problem] = ()) -> S:
    """Builds a config from nested tables; missing settings get their defaults.

    Raises:
        ConfigError: A type, range or name is wrong, settings contradict one another, or `found` has problems.
    """
    require_plain(tables, origin)
    new_problems: list[Problem] = []
    config = _section(root, tables, "", new_problems)
    known_paths = [_parts(problem.path) for problem in found]
    problems = [candidate for candidate in new_problems if not _is_at(_parts(candidate.path), known_paths)]
    invalid_paths = [*known_paths, *(_parts(problem.path) for problem in problems)]
    # Invalid values have their defaults now; contradictions are sought among the rest.
    remaining = (candidate for candidate in contradictions(config) if not _is_at(_parts(candidate.path), invalid_paths))
    problems.extend(remaining)
    if found or problems:
        raise ConfigError(origin, [*found, *folded(problems, tuple(config.species))])
    return config


def rebuild(config: S, values: Mapping[str, Any], origin: str) -> S:
    """Returns the config with some values replaced; checks only these, and contradictions.

    It takes a fifth of the time of `build`, for sweeps that change the same few settings many times.

    Raises:
        ConfigError: A type or range is wrong, or settings contradict one another.
        KeyError: The config has no such setting.
    """
    problems: list[Problem] = []
    rebuilt = _rebuilt(config, "", [(path.split("."), value) for path, value in values.items()], problems)
    problems = problems or contradictions(rebuilt)
    if problems:
        raise ConfigError(origin, folded(problems, tuple(config.species)))
    return rebuilt


def _rebuilt(section: T, path: str, values: Iterable[tuple[Sequence[str], Any]], problems: list[Problem]) -> T:
    """A section, or a table of sections, with values replaced; invalid values are skipped and added to `problems`."""
    known_settings, known_sections = (
        (settings(type(section)), sections(type(section))) if is_dataclass(section) else ({}, {})
    )
    updated: dict[str, Any] = {}
    nested: dict[str, list[tuple[Sequence[str], Any]]] = {}
    for (name, *tail), value in values:
        if name in known_settings:
            plain_value = _plain(value)
            plain_value = {**updated.get(name, getattr(section, name)), tail[0]: plain_value} if tail else plain_value
            value_problems = list(_setting_problems(known_settings[name], plain_value, f"{path}{name}"))
            updated |= {} if value_problems else {name: _converted(known_settings[name].type, plain_value)}
            problems.extend(value_problems)
        elif name in known_sections or (isinstance(section, dict) and name in section):
            nested.setdefault(name, []).append((tail, value))
        else:
            raise KeyError(f"{path}{name}")
    for name, group in nested.items():
        old_section = section[name] if isinstance(section, dict) else getattr(section, name)
        updated[name] = _rebuilt(old_section, f"{path}{name}.", group, problems)
    return cast(T, {**section, **updated}) if isinstance(section, dict) else replace(cast(Any, section), **updated)


def _section(kind: type[T], table: Mapping[str, Any], path: str, problems: list[Problem], base: T | None = None) -> T:
    """A section from its table, with the defaults of `base`; invalid values are skipped and added to `problems`."""
    known_settings, known_sections, values = settings(kind), sections(kind), {}
    default: Any = kind() if base is None else base
    for name, value in zip(map(str, table), table.values(), strict=True):
        place = f"{path}{name}"
        if name in known_settings:
            plain_value = _plain(value)
            value_problems = list(_setting_problems(known_settings[name], plain_value, place))
            values |= {} if value_problems else {name: _converted(known_settings[name].type, plain_value)}
            problems.extend(value_problems)
        elif name not in known_sections:
            suggestion = _named_below(kind, table, name) or _nearest_name(kind, name)
            problems.append(Problem(place, "unknown name", nearest=suggestion))
        elif not isinstance(value, Mapping):
            problems.append(Problem(place, "must be a table", format_value(value)))
        elif not known_sections[name].repeated:
            values[name] = _section(known_sections[name].type, value, f"{place}.", problems, getattr(default, name))
        else:
            values[name] = {}
            for key, content in zip(map(str, value), value.values(), strict=True):
                if isinstance(content, Mapping):
                    values[name][key] = _section(known_sections[name].type, content, f"{place}.{key}.", problems)
                else:
                    sibling = next((k for k, section in value.items() if isinstance(section, Mapping)), f"<{name}>")
                    suggestion = f"{place}.{sibling}.{key}" if key in settings(known_sections[name].type) else None
                    problems.append(Problem(f"{place}.{key}", "must be a table", format_value(content), suggestion))
    return replace(default, **values)


def _plain(value: Any) -> Any:
    """Converts NumPy numbers to Python's."""
    if isinstance(value, Mapping):
        return {str(name): _plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return value.item() if getattr(value, "ndim", 1) == 0 and hasattr(value, "item") else value


def _setting_problems(setting: Setting, value: Any, path: str) -> Iterator[Problem]:
    """Yields the problems of one value: its type, its length, or a number in it."""
    limits, requirement = setting.doc.range, f"must be {setting.allowed}"
    misfits: dict[str, Any] = dict(_misfits(setting.type, value))
    number = setting.type in (int, float)
    if not misfits and (value not in limits if number else limits.max_items and len(value) > limits.max_items):
        misfits = {"": value}
    for place, part in misfits.items():
        suggestion = nearest(part, setting.choices) if isinstance(part, str) else None
        yield Problem(path + place, requirement, format_value(part), suggestion)
    if misfits:
        return
    if setting.type is float and single(value) not in limits:
        yield Problem(
            path, f"is {single(value):g} in the engine's 32-bit numbers, but {requirement}", format_value(value)
        )
    for name, part in value.items() if get_origin(setting.type) is dict else ():
        yield from _setting_problems(number_of(setting, name), part, f"{path}.{name}")
    low, high = limits.each or (-math.inf, math.inf)
    for place, part in _numbers(value):
        if not low <= part <= high:
            yield Problem(path + place, f"must be from {low:.10g} to {high:.10g}", format_value(part))


def _misfits(kind: Any, value: Any, place: str = "") -> Iterator[tuple[str, Any]]:
    """Yields the parts of a value that have the wrong type, each with its index: [2][0]."""
    items = get_args(kind)
    if items and isinstance(items[0], str):
        if not isinstance(value, str) or value not in items:
            yield place, value
    elif not items:
        if not _is_a(kind, value):
            yield place, value
    elif get_origin(kind) is dict:
        if not isinstance(value, dict):
            yield place, value
    elif not isinstance(value, list | tuple):
        yield place, value
    elif items[1:] != (Ellipsis,) and len(value) != len(items):
        yield f"{place}[{len(value)}]" if len(value) < len(items) else place, value
    else:
        for i, part in enumerate(value):
            yield from _misfits(items[0 if items[1] is Ellipsis else i], part, f"{place}[{i}]")


def _is_a(kind: type, value: Any) -> bool:
    if isinstance(value, bool) or kind is bool:
        return isinstance(value, bool) and kind is bool
    if kind is float:
        return isinstance(value, int | float) and abs(value) <= sys.float_info.max  # False for NaN
    # A lone UTF-16 surrogate cannot be stored in a file.
    return isinstance(value, kind) and not (kind is str and re.search("[\ud800-\udfff]", value))


def _numbers(value: Any, place: str = "") -> Iterator[tuple[str, float]]:
    """Yields the numbers in a list and its nested lists, each with its index."""
    for i, item in enumerate(value) if isinstance(value, list | tuple) else ():
        yield from _numbers(item, f"{place}[{i}]")
    if isinstance(value, int | float):
        yield place, value


def _converted(kind: Any, value: Any) -> Any:
    """Converts lists to tuples, and integers to floats if the setting has floats."""
    items = get_args(kind)
    if isinstance(value, dict):
        return {name: float(part) for name, part in value.items()}
    if not isinstance(value, list | tuple):
        return float(value) if kind is float else value
    return tuple(_converted(items[0 if items[1] is Ellipsis else i], part) for i, part in enumerate(value))


def _named_below(section: type, table: Mapping[str, Any], name: str) -> str | None:
    """Path, in the section, of a species, food kind or the like with this name; None if there is none."""
    repeated = (section_name for section_name, inner in sections(section).items() if inner.repeated)
    tables = {
        section_name: table[section_name] for section_name in repeated if isinstance(table.get(section_name), Mapping)
    }
    return " or ".join(f"{section_name}.{name}" for section_name, entries in tables.items() if name in entries) or None


def _nearest_name(section: type, name: str) -> str | None:
    """The name nearest to an unknown one in its section, else the paths of settings with the same or almost the same
    name.

    Outside all sections, the nearest of all names counts, so `learing_rate` is not taken for the section `learning`.
    """
    outside = issubclass(section, Settings)
    own_names = [*settings(section), *sections(section), *(PER_SPECIES if outside else ())]
    all_names = dict.fromkeys(_names(Settings))
    sibling = nearest(name, own_names)
    if sibling is not None and (not outside or nearest(name, [*own_names, *all_names]) in own_names):
        return sibling
    suggestion = nearest(name, all_names)
    return " or ".join(dict.fromkeys(_places(Settings, suggestion))) if suggestion else None


def _names(section: type) -> Iterator[str]:
    """Names of all settings in a section's inner sections."""
    for inner in sections(section).values():
        yield from settings(inner.type)
        yield from _names(inner.type)


def _places(section: type, name: str, path: str = "") -> Iterator[str]:
    """Paths, as in a file, of all settings with this name in a section's inner sections."""
    for inner_name, inner in sections(section).items():
        # In a file, sections of species may also be at the top level.
        prefix = path if inner_name == "species" else f"{path}{inner_name}." + ("<kind>." if inner.repeated else "")
        if name in settings(inner.type):
            yield prefix + name
        yield from _places(inner.type, name, prefix)


def _parts(path: str) -> list[str]:
    return re.split(r"[.\[]", path)


def _is_at(path: list[str], known_paths: Iterable[list[str]]) -> bool:
    """Whether a path overlaps a known one, itself or as a file's default for a species."""
    default = path[2:] if path[0] == "species" and len(path) > 2 else path
    return any(_overlap(path, known_path) or _overlap(default, known_path) for known_path in known_paths)


def _overlap(path: list[str], other: list[str]) -> bool:
    """Whether two paths name the same setting, or one names a section that contains the other."""
    return all(x == y for x, y in zip(path, other, strict=False))
