"""What the page needs for a live world: the engine's text, the layout, and every setting that can be changed."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hedon.config.config import PROVENANCE, Config
from hedon.config.field import Setting, leaves
from hedon.config.load import PRESETS, describe_preset, is_modified, load_config
from hedon.view.engine_text import engine_settings, engine_text
from hedon.view.layout import describe

PLACE = ("arena.", "birth.distance")
"""Settings that are made into walls or lengths before the engine gets them: the page does not change these."""


def live_worlds(first: str = "", fidelity: str | None = None) -> list[dict[str, Any]]:
    """What `live_world` says of a preset or file, and of all presets after it.

    Raises:
        ConfigError: There is no such preset or file, or something in it is wrong.
    """
    sources = [*([first] if first else []), *(name for name in PRESETS if name != first)]
    return [live_world(load_config(source, fidelity), source) for source in sources]


def live_world(config: Config, source: str) -> dict[str, Any]:
    """One world that the page can make.

    Returns:
        `name`; `description`; `source`, as in `hedon run SOURCE`; `fidelity`; `layout`, as `describe` gives it; `text`
        for the engine, for seed 1; `settings`, each as `_setting` gives it.
    """
    preset = source in PRESETS
    shown = source if preset else Path(source).name
    description = describe_preset(source) if preset else _origin(config)
    return {
        "name": config.name,
        "description": description,
        "source": shown,
        "fidelity": config.fidelity,
        "layout": describe(config),
        "text": engine_text(config, 1),
        "settings": list(_settings(config)),
    }


def _origin(config: Config) -> str:
    changed = ", with changes" if is_modified(config) else ""
    return f"from the preset {config.preset}{changed}"


def _settings(config: Config) -> Iterator[dict[str, Any]]:
    """The settings that the engine gets as they are, with their schema."""
    known = engine_settings(config)
    kinds = list(config.food)
    for path, setting, value in leaves(config):
        if path in PROVENANCE or path.startswith(PLACE):
            continue
        engine = _engine_path(path, kinds)
        if engine in known:
            yield _setting(path, engine, setting, value)


def _engine_path(path: str, kinds: list[str]) -> str:
    """`food.normal.energy` → `food[0].energy`; `food.normal.gene.initial_sd` → `genome.food[0].initial_sd`."""
    found = re.fullmatch(r"food\.(\w+)\.(gene\.)?(.+)", path)
    if found is None:
        return path
    kind, gene, rest = found.groups()
    return f"{'genome.' if gene else ''}food[{kinds.index(kind)}].{rest}"


def _setting(path: str, engine: str, setting: Setting, value: Any) -> dict[str, Any]:
    """One setting: its path here and in the engine, its value, and what `docs/config.md` says of it."""
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
