"""Loads a config from a preset or a file. Later layers win: preset, fidelity, file, overrides."""

import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from hedon.config.config import Config
from hedon.config.dump import LATER, SCHEMA, diff, digest
from hedon.config.field import leaves, value_at
from hedon.config.layer import (
    Table,
    settle_food,
    settle_genes,
    settle_species,
    settle_stores_and_queries,
    stack,
    with_defaults,
)
from hedon.config.override import parse_override
from hedon.config.problem import ConfigError, Problem, folded, format_value, nearest
from hedon.config.retired import FIDELITY_NOW, renamed
from hedon.config.rule_path import with_absolute_rules
from hedon.config.schema.settings import PROVENANCE
from hedon.config.schema.species import ONLY
from hedon.config.toml import parse_toml, read_toml, require_plain
from hedon.config.validate import build
from hedon.error import ArgumentError
from hedon.text import brief

_FOLDER = Path(__file__).parent
DEFAULT_PRESET = "baseline"
DEFAULT_FIDELITY = "corrected"
PAPER_PRESETS = ("baseline", "small", "large", "centered", "relocation", "poor", "poison")
"""Conditions of the paper."""
SEQUEL_PRESETS = (
    "predator",
    "predator-square",
    "predator-small-mouth",
    "predator-large-mouth",
    "predator-less-food",
    "predator-frozen",
    "prey-alone",
    "pitfall",
    "pitfall-weak",
    "pitfall-15",
    "pitfall-small",
    "pitfall-sparse",
    "pitfall-default-birth",
)
"""Conditions of the sequel, on predators and prey."""
OUR_PRESETS = ("seasons", "appetite")
"""Conditions of this project."""
PRESETS = (*PAPER_PRESETS, *SEQUEL_PRESETS, *OUR_PRESETS)
MISTYPED = 0.75
"""Similarity from which one name counts as a misspelling of another: one letter in four differs."""
FIDELITIES = ("corrected", "released", "as_printed")
"""Variants of every preset: correct algorithms, the released code with its faults, and the values as printed."""


def load_config(source: str | Path, fidelity: str | None = None, overrides: Iterable[str] = ()) -> Config:
    """Loads a run's settings.

    The file of a Python rule is resolved relative to the folder of the TOML file, or to the current folder if an
    override names it; the config holds its absolute path.

    Raises:
        ConfigError: The preset or file does not exist, or something in it is wrong; the error lists all problems.
        ArgumentError: An argument has the wrong type.
    """
    texts = override_texts(overrides)
    path = _path_of(source)
    tables = {"preset": source} if path is None else read_toml(path)
    return _config_of(tables, path, fidelity, texts)


def _config_of(tables: Table, path: Path | None, fidelity: str | None = None, texts: Sequence[str] = ()) -> Config:
    """Config from a file's tables; without a path, the tables only name a preset."""
    origin = str(path or tables["preset"])
    file_tables = tables if path is None else with_absolute_rules(tables, path.parent)
    parsed = [parse_override(text) for text in texts]
    problems = [item for item in parsed if isinstance(item, Problem)]
    changes = [with_absolute_rules(item, Path()) for item in parsed if not isinstance(item, Problem)]
    require_plain(changes, f"{origin}, with changes")
    for name in [key for table in changes for key in table if key in ("preset", "fidelity", "complete")]:
        option = "--fidelity" if name == "fidelity" else "the preset or file itself"
        problems.append(Problem(name, f"is not a setting: give it with {option}"))
    unknown: list[Problem] = []
    lower_layers = _layers_below(file_tables, fidelity, unknown)
    if unknown:  # without a valid preset and fidelity nothing else can be checked
        raise ConfigError(origin, [*problems, *unknown])
    name = {"name": origin if path is None else _name_of(path)}
    return _from_layers(
        [name, *lower_layers], [file_tables, *changes], f"{origin}, with changes" if changes else origin, problems
    )


def load_config_text(text: str, path: Path) -> Config:
    """Loads a config from text that was read from a file, as `load_config` does.

    Raises:
        ConfigError: Something in it is wrong; the error lists all problems.
    """
    return _config_of(parse_toml(text, str(path)), path)


def parse_config(text: str, origin: str) -> Config:
    """Loads a config from a complete TOML text, as `dump_toml` writes it.

    Raises:
        ConfigError: Something in it is wrong or missing.
    """
    return _from_layers([], [parse_toml(text, origin) | {"complete": True}], origin)


def is_modified(config: Config) -> bool:
    """Whether any setting differs from the config's preset and fidelity; names and colors do not count."""
    if config.preset not in PRESETS or config.fidelity not in FIDELITIES:
        return True
    return digest(config) != digest(load_config(config.preset, config.fidelity))


def changed_settings(config: Config) -> list[tuple[str, Any, Any]]:
    """Lists the settings in which a config differs from its preset and fidelity; empty if the preset is unknown.

    If the preset has one species and the config has others, each is compared with the preset's.

    Returns:
        (path, value in the preset, value in the config) in order, as from `diff`.
    """
    if config.preset not in PRESETS:
        return []
    preset = load_config(config.preset, config.fidelity)
    if len(preset.species) == 1 and not preset.species.keys() & config.species.keys():
        (species_config,) = preset.species.values()
        preset = replace(preset, species=dict.fromkeys(config.species, species_config))
    return diff(preset, config)


@cache
def describe_preset(name: str) -> str:
    """Description of a preset, in one sentence."""
    return read_toml(_FOLDER / "presets" / f"{name}.toml")["description"]


@cache
def describe_fidelity(name: str) -> str:
    """Description of a fidelity, in one sentence."""
    return read_toml(_FOLDER / "overlays" / f"{name}.toml")["description"]


def override_texts(overrides: Iterable[str]) -> list[str]:
    """Returns overrides as a list; a single string becomes a list of one.

    Raises:
        ArgumentError: The overrides are not strings.
    """
    if not isinstance(overrides, Iterable):
        raise ArgumentError(f"overrides = {brief(repr(overrides))}: must be a list of texts such as energy.initial=20")
    texts = [overrides] if isinstance(overrides, str) else list(overrides)
    for text in texts:
        if not isinstance(text, str):
            raise ArgumentError(f"overrides: each must be a text such as energy.initial=20, not {text!r}")
    return texts


def _name_of(path: Path) -> str:
    """Default name of a run: the config file's name, reduced to characters that are valid in any folder name."""
    ascii_name = unicodedata.normalize("NFKD", path.stem).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9._-]+", "-", ascii_name).strip(".-")[:80] or "config"


def _path_of(source: str | Path) -> Path | None:
    """The file that a source names, or None for a preset."""
    if not isinstance(source, str | Path):
        raise ArgumentError(f"source: must be the name of a preset or the path of a file, not {source!r}")
    if isinstance(source, Path) or source.endswith(".toml") or "/" in source:
        return Path(source)
    if source not in PRESETS:
        suggestion = nearest(source, [path.name for path in Path().glob("*.toml")], MISTYPED)
        if suggestion is not None and nearest(source, PRESETS, MISTYPED) is None:
            raise ConfigError(
                source, [Problem("", "there is no such preset, and a file's name ends with .toml", None, suggestion)]
            )
        suggestion = nearest(source, PRESETS)
        listing = "" if suggestion else f" (there are {', '.join(PRESETS)}); a file's name ends with .toml"
        raise ConfigError(source, [Problem("", f"there is no such preset{listing}", nearest=suggestion)])
    return None


def _layers_below(tables: Table, fidelity: str | None, problems: list[Problem]) -> list[Table]:
    """Layers below a file; also sets the preset and fidelity in `tables`."""
    if tables.get("complete") is True:
        if fidelity not in (None, tables.get("fidelity")):
            message = "the file already has all settings, so a fidelity changes none; start from its preset instead"
            problems.append(Problem("--fidelity", message, fidelity))
        return []
    if "complete" in tables:
        problems.append(Problem("complete", "must be true or left out", format_value(tables["complete"])))
    tables["fidelity"] = fidelity or tables.get("fidelity", DEFAULT_FIDELITY)
    tables.setdefault("preset", DEFAULT_PRESET)
    for field, names in (("preset", PRESETS), ("fidelity", FIDELITIES)):
        value = tables[field]
        if value not in names:
            suggestion = FIDELITY_NOW.get(value) or nearest(value, names) if isinstance(value, str) else None
            problems.append(Problem(field, "must be one of " + ", ".join(names), format_value(value), suggestion))
    if problems:
        return []
    preset, name = tables["preset"], tables["fidelity"]
    return [*_preset_layers(preset), _settings_of(_FOLDER / "overlays" / f"{name}.toml"), *_own_fidelity(preset, name)]


def _mistyped_species(lower_tables: Table, overrides: list[Table]) -> list[Problem]:
    """Problems for species in overrides whose names are almost those of existing species.

    A new species replaces a single unnamed one, so a misspelled name would leave no other species.
    """
    species = lower_tables.get("species")
    existing = list(species) if isinstance(species, dict) and species else [ONLY]
    overridden = [table["species"] for table in overrides if isinstance(table.get("species"), dict)]
    added = [name for name in dict.fromkeys(name for table in overridden for name in table) if name not in existing]
    message = "there is no such species; a new one of so close a name goes into a file"
    return [
        Problem(f"species.{name}", message, nearest=suggestion)
        for name in added
        if (suggestion := nearest(name, existing, MISTYPED))
    ]


def _from_layers(
    lower_layers: list[Table], user_layers: list[Table], origin: str, known_problems: Sequence[Problem] = ()
) -> Config:
    """Config from layers of tables, lowest first; `user_layers` are the user's layers: a file, then overrides.

    Problems in `known_problems` are reported with the others.
    """
    known_problems = [*known_problems, *(problem for layer in user_layers for problem in renamed(layer))]
    complete = user_layers[0].get("complete") is True
    user_layers = [with_defaults(user_layers[0]) if complete else user_layers[0], *user_layers[1:]]
    merged = stack([*lower_layers, *user_layers])
    mistyped = _mistyped_species(stack([*lower_layers, user_layers[0]]), user_layers[1:])
    problems = [
        *mistyped,
        *_schema_problems(merged, complete),
        *settle_food(merged),
        *settle_species(merged, user_layers),
    ]
    problems += settle_stores_and_queries(merged)
    settle_genes(merged)
    config = build(Config, merged, origin, [*known_problems, *folded(problems, _species_of(merged))])
    if complete:
        _require_complete(config, merged, origin)
    return config


def _species_of(tables: Table) -> tuple[str, ...]:
    """Names of the species, if the tables have valid ones."""
    species = tables.get("species")
    return tuple(species) if isinstance(species, dict) else ()


def _schema_problems(tables: Table, complete: bool) -> Iterator[Problem]:
    """Removes the schema version and the mark of a complete file from the tables; yields problems with them."""
    tables.pop("complete", None)
    schema = tables.pop("schema", None if complete else SCHEMA)
    if schema != SCHEMA:
        rule = f'must be "{SCHEMA}": this version reads no complete files of others'
        yield Problem("schema", rule, None if schema is None else format_value(schema))


def _require_complete(config: Config, tables: Table, origin: str) -> None:
    """Raises ConfigError if a file marked as complete lacks a setting, since its default would not be a choice."""
    problems = [
        Problem(path, f"is missing in a file that says it is complete; {setting.allowed}")
        for path, setting, _ in leaves(config)
        if path not in PROVENANCE and not path.endswith(tuple(LATER)) and not _says(tables, path)
    ]
    if problems:
        raise ConfigError(origin, folded(problems, tuple(config.species)))


def _says(tables: Table, path: str) -> bool:
    """Whether tables have something at a path whose names may contain dots."""
    try:
        value_at(tables, path)
    except (ValueError, AttributeError):
        return False
    return True


def _preset_layers(name: str) -> list[Table]:
    """A preset and the presets that it is based on, lowest first."""
    return [{key: value for key, value in tables.items() if key not in FIDELITIES} for tables in _preset_files(name)]


def _own_fidelity(preset: str, fidelity: str) -> list[Table]:
    """Settings that a preset and its base presets add to a fidelity's own, lowest first."""
    return [tables[fidelity] for tables in _preset_files(preset) if fidelity in tables]


def _preset_files(name: str) -> list[Table]:
    tables = _settings_of(_FOLDER / "presets" / f"{name}.toml")
    return [*(_preset_files(tables["preset"]) if "preset" in tables else []), tables]


def _settings_of(path: Path) -> Table:
    tables = read_toml(path)
    tables.pop("description")
    return tables
