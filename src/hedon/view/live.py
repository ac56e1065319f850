"""The data that the page needs for a live world: the engine's text, the layout, and all adjustable settings."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hedon.config.config import Config
from hedon.config.dump import dump_toml, flatten
from hedon.config.engine import engine_paths
from hedon.config.field import Setting, leaves
from hedon.config.fixed import fixed_path
from hedon.config.load import PRESETS, describe_preset, is_modified, load_config
from hedon.config.rule_path import rule_places
from hedon.config.schema.settings import changes_worlds
from hedon.view.engine_text import engine_text
from hedon.view.layout import describe
from hedon.view.page import ViewError

BEGINNING = (".initial", ".initial_count", ".initial_mean", ".initial_sd", ".at_zero", ".count")
"""Endings of paths of settings that take effect only when a world starts, or that determine what is recorded."""


def live_worlds(first: str = "", fidelity: str | None = None) -> list[dict[str, Any]]:
    """The results of `live_world` for a preset or file, followed by all presets.

    Args:
        first: The preset or file; empty for none.
        fidelity: Its fidelity; None for the default.

    Raises:
        ConfigError: The preset or file does not exist, or is invalid.
        ViewError: The world has a rule in Python.
    """
    sources = [*([first] if first else []), *(name for name in PRESETS if name != first)]
    return [live_world(load_config(source, fidelity), source) for source in sources]


def live_world(config: Config, source: str) -> dict[str, Any]:
    """The data of one world that the page can simulate.

    Args:
        config: Settings of the world.
        source: The preset or file, as in `hedon run SOURCE`.

    Returns:
        `name`; `description`; `source`, as in `hedon run SOURCE`; `fidelity`; `toml`, the whole config if it is not a
        preset, otherwise ""; `layout`, from `describe`; `text` for the engine, for seed 1; `settings`, each from
        `_setting`.

    Raises:
        ViewError: The world has a rule in Python.
    """
    require_live(config, source)
    preset = source in PRESETS
    source_name = source if preset else Path(source).name
    description = describe_preset(source) if preset else _origin(config)
    return {
        "name": config.name,
        "description": description,
        "source": source_name,
        "fidelity": config.fidelity,
        "toml": "" if preset else dump_toml(config),
        "layout": describe(config),
        "text": engine_text(config, 1),
        "settings": list(_settings(config)),
    }


def require_live(config: Config, source: str) -> None:
    """Refuses a world that the page cannot simulate.

    Args:
        config: Settings of the world.
        source: The preset or file, for the error message.

    Raises:
        ViewError: The world has a rule in Python.
    """
    if places := rule_places(config):
        name = Path(places[0]).name
        raise ViewError(
            f"{source}: has the rule {name} in Python, which a browser cannot compute: run it with "
            "`hedon run --frames 64`, and view the run"
        )


def _origin(config: Config) -> str:
    suffix = ", with changes" if is_modified(config) else ""
    return f"from the preset {config.preset}{suffix}"


def _settings(config: Config) -> Iterator[dict[str, Any]]:
    """The numbers and choices that the engine receives unchanged, with their schema."""
    rows, paths = (row for row in leaves(config) if changes_worlds(row[0])), engine_paths(config)
    for (path, setting, value), short_path in zip(rows, flatten(config), strict=True):
        is_single = setting.choices or setting.type in (int, float)
        if is_single and path in paths and not setting.doc.shapes:
            yield _setting(short_path, paths[path], setting, value)


def _setting(path: str, engine: list[str], setting: Setting, value: Any) -> dict[str, Any]:
    """One setting: its path in the config and its paths in the engine, its value, its description in `docs/config.md`,
    and whether it can be changed in a running world."""
    limits = setting.doc.range
    return {
        "path": path,
        "engine": engine,
        "value": value,
        "choices": list(setting.choices),
        "whole": setting.type is int,
        "at_once": not fixed_path(path) and not path.endswith(BEGINNING),
        **{name: getattr(limits, name) for name in ("ge", "gt", "le", "lt")},
        "unit": setting.doc.unit,
        "meaning": setting.doc.meaning,
        "allowed": setting.allowed,
    }
