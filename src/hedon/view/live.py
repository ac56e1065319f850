"""What the page needs for a live world: the engine's text, the layout, and every setting that can be changed."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from hedon.config.config import PROVENANCE, Config
from hedon.config.dump import default_path, dump_toml, flatten
from hedon.config.field import Setting, leaves
from hedon.config.load import PRESETS, describe_preset, is_modified, load_config
from hedon.view.engine_text import engine_settings, engine_text
from hedon.view.layout import describe

PLACE = ("arena.", "birth.distance")
"""Settings that are made into walls or lengths before the engine gets them: the page does not change these."""
PYTHON = ("reward.memory",)
"""Ends of settings that mean something only beside a rule in Python, which the page cannot have."""


def live_worlds(first: str = "", fidelity: str | None = None) -> list[dict[str, Any]]:
    """What `live_world` gives for a preset or file, and for all presets after it.

    Args:
        first: a preset or a file; empty for the presets alone.
        fidelity: of them all; None for the config's own.

    Raises:
        ConfigError: There is no such preset or file, or something in it is wrong.
    """
    sources = [*([first] if first else []), *(name for name in PRESETS if name != first)]
    return [live_world(load_config(source, fidelity), source) for source in sources]


def live_world(config: Config, source: str) -> dict[str, Any]:
    """One world that the page can make.

    Args:
        config: of the world.
        source: the preset or the file that it comes from.

    Returns:
        `name`; `description`; `source`, as in `hedon run SOURCE`; `fidelity`; `toml`, the whole config if no preset is
        it, else ""; `layout`, as `describe` gives it; `text` for the engine, for seed 1; `settings`, each as `_setting`
        gives it.
    """
    preset = source in PRESETS
    shown = source if preset else Path(source).name
    description = describe_preset(source) if preset else _origin(config)
    return {
        "name": config.name,
        "description": description,
        "source": shown,
        "fidelity": config.fidelity,
        "toml": "" if preset else dump_toml(config),
        "layout": describe(config),
        "text": engine_text(config, 1),
        "settings": list(_settings(config)),
    }


def _origin(config: Config) -> str:
    changed = ", with changes" if is_modified(config) else ""
    return f"from the preset {config.preset}{changed}"


def _settings(config: Config) -> Iterator[dict[str, Any]]:
    """The settings that the engine gets as they are, with their schema."""
    before = engine_settings(config)
    rows = [row for row in leaves(config) if row[0] not in PROVENANCE]
    for (path, setting, value), shown in zip(rows, flatten(config), strict=True):
        if default_path(path).startswith(PLACE) or path.endswith(PYTHON):
            continue
        reached = _reached(config, path, setting, value, before)
        if reached:
            yield _setting(shown, reached, setting, value)


def _reached(config: Config, path: str, setting: Setting, value: Any, before: dict[str, Any]) -> list[str]:
    """The engine's settings that have just this setting's value; none if it reaches the engine in another form."""
    if isinstance(value, tuple | bool) or (isinstance(value, str) and not setting.choices):
        return []
    number: Any = value
    other = next(choice for choice in setting.choices if choice != value) if setting.choices else number + 1
    after = engine_settings(changed(config, path, other))
    if after.keys() != before.keys():
        return []
    found = [name for name, old in before.items() if after[name] != old]
    direct = all(before[name] == value and after[name] == other for name in found)
    return found if direct else []


def changed(config: Any, path: str, value: Any) -> Any:
    """A config, or a part of one, with one setting replaced, unchecked.

    Args:
        config: a config, a section, or a mapping of sections.
        path: of the setting within it.
        value: the new one.
    """
    name, _, rest = path.partition(".")
    if isinstance(config, dict):
        return {**config, name: changed(config[name], rest, value)}
    return replace(config, **{name: changed(getattr(config, name), rest, value) if rest else value})


def _setting(path: str, engine: list[str], setting: Setting, value: Any) -> dict[str, Any]:
    """One setting: its path here and those in the engine, its value, and what `docs/config.md` says of it."""
    limits = setting.doc.range
    return {
        "path": path,
        "engine": engine,
        "value": value,
        "choices": list(setting.choices),
        "whole": setting.type is int,
        **{name: getattr(limits, name) for name in ("ge", "gt", "le", "lt")},
        "unit": setting.doc.unit,
        "meaning": setting.doc.meaning,
        "allowed": setting.allowed,
    }
