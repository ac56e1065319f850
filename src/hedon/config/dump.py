"""Writes a config as text or as a digest, and compares two configs."""

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
"""The version of the schema of configs: which settings there are, and what they mean. A digest is of a config under it;
complete files of other versions are refused."""

LATER = (".looks_like",)
"""How the paths of settings end that were added to this schema. If one is off, digests are as without it, and complete
files may lack it: runs from before can be read and resumed."""

_HEAD = "# Complete: this file has every setting; none comes from the preset or the fidelity.\n"


def dump_toml(config: Settings, section: str | None = None) -> str:
    """Writes a config as a TOML file that loads to an equal config; each setting with its meaning and unit.

    Returns:
        The text. With a section it is not a complete file, but a part of one.

    Raises:
        KeyError: There is no such section.
    """
    tables = list(_tables(config))
    if section is None:
        head = f'{_HEAD}complete = true\nschema = "{SCHEMA}"\n'
        return head + "\n\n".join(text for _, text in tables) + "\n"
    wanted = [
        text
        for path, text in tables
        if any(f"{each}.".startswith(f"{section}.") for each in (path, default_path(path)))
    ]
    if not section or not wanted:
        raise KeyError(section)
    return "\n\n".join(wanted) + "\n"


def section_paths(config: Settings) -> list[str]:
    """The sections that `dump_toml` can write separately."""
    species = (f"species.{name}{own}" for name in config.species for own in ("", *(f".{each}" for each in PER_SPECIES)))
    foods = (f"food.{kind}" for kind in config.food)
    return [*sections(Settings), *foods, *PER_SPECIES, *species]


def file_leaves(config: Settings) -> Iterator[tuple[str, Setting, Any]]:
    """Every setting as `leaves` has it, but without those that change no world: names and measures.

    Where there is only the species of a file without `[species]`, paths are as in such a file: `energy.initial`.
    """
    unnamed = f"species.{ONLY}." if list(config.species) == [ONLY] else ""
    for path, setting, value in leaves(config):
        if changes_worlds(path):
            yield path.removeprefix(unnamed), setting, value


def flatten(config: Settings) -> dict[str, Any]:
    """Every setting by its path, in order, as `file_leaves` has it."""
    return {path: value for path, _, value in file_leaves(config)}


def digest(config: Settings) -> str:
    """A fingerprint of a config: equal exactly if all settings are equal, apart from names, colors and measures.

    It is of the complete config and of the version of the schema.

    Returns:
        SHA-256, 64 hexadecimal digits.
    """
    return Fingerprint(config).digest({})


class Fingerprint:
    """Gives the digests of a config, and of those that differ from it in some values.

    Args:
        config: The config.
    """

    def __init__(self, config: Settings) -> None:
        counted = (each for each in leaves(config) if changes_worlds(each[0]) and not each[0].endswith(".color"))
        self._rows = {path: _row(path, value) for path, _, value in counted}

    def digest(self, values: Mapping[str, Any]) -> str:
        """The digest of the config with other values; see `digest`."""
        changed = {path: _row(path, value) for path, value in values.items() if path in self._rows}
        rows = ", ".join(filter(None, (self._rows | changed).values()))
        return hashlib.sha256(f'{{"schema": {json.dumps(SCHEMA)}, "settings": [{rows}]}}'.encode()).hexdigest()


def _row(path: str, value: Any) -> str:
    """What a digest is made of, for one setting; empty where it came later and is off."""
    return json.dumps([path, value]) if value or not path.endswith(LATER) else ""


def diff(a: Settings, b: Settings) -> list[tuple[str, Any, Any]]:
    """The settings in which two configs differ.

    Returns:
        (path, value in a, value in b) in order, with None for a setting that is absent. If the kinds of food or
        their order differ, also the path "food" with their names.

    Raises:
        ArgumentError: One of them is no config.
    """
    for name, each in (("a", a), ("b", b)):
        if not isinstance(each, Settings):
            raise ArgumentError(f"{name}: must be a Config, as `load_config` gives it, not {brief(repr(each))}")
    left, right = flatten(a), flatten(b)
    kinds = [("food", tuple(a.food), tuple(b.food))] if list(a.food) != list(b.food) else []
    paths = dict.fromkeys([*left, *right])
    return kinds + [(path, left.get(path), right.get(path)) for path in paths if left.get(path) != right.get(path)]


def _tables(section: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """The text of each section that has settings, by its path."""
    lines = [f"[{path}]"] if path else []
    for name, setting in settings(type(section)).items():
        unit = f" [{setting.doc.unit}]" if setting.doc.unit else ""
        lines.append(f"{name} = {format_value(getattr(section, name))}  # {setting.doc.meaning}{unit}")
    if len(lines) > bool(path):
        yield path, "\n".join(lines)
    for place, _, own in inner_sections(section, f"{path}." if path else ""):
        yield from _tables(own, place)
