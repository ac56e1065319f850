"""A config in the form that the engine takes: the same names, in plain dicts and lists."""

from dataclasses import asdict
from typing import Any

from hedon.config.config import PROVENANCE, Config

PYTHON_ONLY = (
    *PROVENANCE,
    "arena.corner_radius",
    "arena.corner_chords",
    "arena.inner_walls",
    "food.color",
    "genome.founders",
    "birth.distance_unit",
)
"""Settings that the engine does not get: names, colors, and what it gets as walls or as lengths in u."""


def engine_config(config: Config) -> dict[str, Any]:
    """The nested dict that the engine's structs are filled from.

    Names are those of the dataclasses, with these differences: `arena` has only its size (see `arena.walls`
    for the rest); `food` is a list in the order of the kinds, and
    `genome.food` has their genes in this order; `birth.distance_sd` is (x, y) in u.
    """
    native = {name: section for name, section in asdict(config).items() if name not in PROVENANCE}
    native["arena"] = {"width": config.arena.width, "height": config.arena.height}
    foods = native["food"].values()
    native["genome"] = _without(native["genome"], "founders") | {"food": [food["gene"] for food in foods]}
    native["food"] = [_without(_without(food, "color"), "gene") for food in foods]
    native["birth"] = _without(native["birth"], "distance_unit")
    native["birth"]["distance_sd"] = distance_sd(config)
    return native


def distance_sd(config: Config) -> tuple[float, float]:
    """Standard deviation of a child's place around its parent along x and y [u]."""
    scale = config.arena.width if config.birth.distance_unit == "arena_width" else 1.0
    sd = config.birth.distance_sd * scale
    return sd, sd


def _without(table: dict[str, Any], name: str) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key != name}
