"""Writes a config as text, computes its digest, and compares two configs."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import Any

from hedon.config.field import Setting, inner_sections, leaves, sections, settings
from hedon.config.problem import format_value
from hedon.config.schema.settings import Settings, changes_worlds
from hedon.config.schema.species import ONLY, PER_SPECIES, default_path
from hedon.error import ArgumentError
from hedon.text import brief

SCHEMA = "1"
"""Version of the config schema: which settings exist and what they mean. It enters each digest, and complete files of
other versions are refused."""

LATER: Mapping[str, Any] = {".looks_like": "", ".drive_exponent": 2.0, ".drive_root": 2.0}
"""Endings of the paths of settings added to this schema, with the values of worlds from before. Digests omit a setting
that has this value, and complete files may lack it, so older runs can still be read and resumed."""

_HEAD = "# Complete: this file has every setting; none comes from the preset or the fidelity.\n"


def dump_toml(config: Settings, section: str | None = None) -> str:
    """Writes a config as a TOML file that loads to an equal config; comments give each setting's meaning and unit.

    Returns:
        The text. If `section` is given, only that part of a complete file.

    Raises:
        KeyError: The section does not exist.
    """
    tables = list(_tables(config))
    if section is None:
        head = f'{_HEAD}complete = true\nschema = "{SCHEMA}"\n'
        return head + "\n\n".join(text for _, text in tables) + "\n"
    selected = [
        text
        for path, text in tables
        if any(f"{alias}.".startswith(f"{section}.") for alias in (path, default_path(path)))
    ]
    if not section or not selected:
        raise KeyError(section)
    return "\n\n".join(selected) + "\n"


def section_paths(config: Settings) -> list[str]:
    """Sections that `dump_toml` can write separately."""
    species = (
        f"species.{name}{suffix}"
        for name in config.species
        for suffix in ("", *(f".{section}" for section in PER_SPECIES))
    )
    foods = (f"food.{kind}" for kind in config.food)
    return [*sections(Settings), *foods, *PER_SPECIES, *species]


def file_leaves(config: Settings) -> Iterator[tuple[str, Setting, Any]]:
    """Yields every setting as `leaves` does, except names and measures, which change no world.

    If the only species comes from a file without `[species]`, its paths are as in that file: `energy.initial`.
    """
    prefix = f"species.{ONLY}." if list(config.species) == [ONLY] else ""
    for path, setting, value in leaves(config):
        if changes_worlds(path):
            yield path.removeprefix(prefix), setting, value


def flatten(config: Settings) -> dict[str, Any]:
    """Every setting by its path, in the order of `file_leaves`."""
    return {path: value for path, _, value in file_leaves(config)}


def digest(config: Settings) -> str:
    """Fingerprint of a config: equal if and only if all settings are equal, except names, colors and measures.

    It covers the complete config and the schema version.

    Returns:
        SHA-256 as 64 hexadecimal digits.
    """
    return Fingerprint(config).digest({})


class Fingerprint:
    """Computes digests of a config and of variants that differ in some values.

    Args:
        config: Base of the variants.
    """

    def __init__(self, config: Settings) -> None:
        settings_of_worlds = (
            leaf for leaf in leaves(config) if changes_worlds(leaf[0]) and not leaf[0].endswith(".color")
        )
        self._rows = {path: _row(path, value) for path, _, value in settings_of_worlds}

    def digest(self, values: Mapping[str, Any]) -> str:
        """Digest of the config with these values replaced; see the function `digest`."""
        replaced = {path: _row(path, value) for path, value in values.items() if path in self._rows}
        rows = ", ".join(filter(None, (self._rows | replaced).values()))
        return hashlib.sha256(f'{{"schema": {json.dumps(SCHEMA)}, "settings": [{rows}]}}'.encode()).hexdigest()


def _row(path: str, value: Any) -> str:
    """A setting's part of the digest; empty if the setting was added to the schema and is as before."""
    is_as_before = any(path.endswith(ending) and value == before for ending, before in LATER.items())
    return "" if is_as_before else json.dumps([path, value])


def diff(a: Settings, b: Settings) -> list[tuple[str, Any, Any]]:
    """Lists the settings in which two configs differ.

    Returns:
        (path, value in a, value in b) in order; None stands for a missing setting. If the food kinds or their order
        differ, an entry with the path "food" lists their names.

    Raises:
        ArgumentError: An argument is not a config.
    """
    for name, config in (("a", a), ("b", b)):
        if not isinstance(config, Settings):
            raise ArgumentError(f"{name}: must be a Config, as `load_config` gives it, not {brief(repr(config))}")
    left, right = flatten(a), flatten(b)
    kinds = [("food", tuple(a.food), tuple(b.food))] if list(a.food) != list(b.food) else []
    paths = dict.fromkeys([*left, *right])
    return kinds + [(path, left.get(path), right.get(path)) for path in paths if left.get(path) != right.get(path)]


def _tables(section: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """Text of each section that has settings, by path."""
    lines = [f"[{path}]"] if path else []
    for name, setting in settings(type(section)).items():
        unit = f" [{setting.doc.unit}]" if setting.doc.unit else ""
        lines.append(f"{name} = {format_value(getattr(section, name))}  # {setting.doc.meaning}{unit}")
    if len(lines) > bool(path):
        yield path, "\n".join(lines)
    for place, _, inner in inner_sections(section, f"{path}." if path else ""):
        yield from _tables(inner, place)
