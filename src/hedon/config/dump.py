"""Writes a config as text or as a digest, and compares two configs."""

import hashlib
import json
import math
import re
from collections.abc import Iterator
from typing import Any

from hedon.config.config import PROVENANCE, Config
from hedon.config.earlier import old_rows
from hedon.config.field import leaves, sections, settings
from hedon.config.problem import format_value

EARLIER = {
    "learning.policy": "ppo",
    "reward.rule": "",
    "hazard.rule": "",
    "birth.rule": "",
    "reward.memory": 0,
    "learning.acting_weights": "float32",
    "physics.solver": "sequential",
    "sensor.ray_inside": "hit",
    "sensor.eaten_food": "gone",
    "sensor.mouths": "nearest",
    "population.heading_range": math.tau,
    "birth.order": "before_deaths",
    "birth.inheritance": "at_birth",
    "birth.parents": "all",
    "birth.heading": "own",
    "genome.founders": "",
    "learning.networks": "",
    "body.collides": ("*",),
    "motor.force_scale": 1.0,
    "sensor.sees": ("*",),
    "diet.eats": (("*", 1.0),),
    "sensor.smells": (),
    "sensor.smell_decay": 0.1,
    "sensor.noses": 1,
    "sensor.nose_angle": 45.0,
    "birth.delay": 0.0,
    "birth.network": "none",
    "birth.network_noise": 0.01,
    "birth.mating": "none",
    "birth.mating_window": 1000,
    "birth.mating_range": 20.0,
    "diet.digestion_steps": 0,
    "diet.prey_sharing": "one",
    "genome.mutation_law": "cauchy",
    "genome.mutation_df": 2.0,
    "genome.mutation_probability": 1.0,
    "genome.prey.initial_mean": 0.0,
    "genome.prey.initial_sd": 0.1,
    "genome.second.initial_mean": 0.0,
    "genome.second.initial_sd": 0.1,
    "genome.set_point.initial_mean": 0.5,
    "genome.set_point.initial_sd": 0.1,
    "genome.set_point_nutrient.initial_mean": 0.5,
    "genome.set_point_nutrient.initial_sd": 0.1,
    "genome.set_point_toxin.initial_mean": 0.0,
    "genome.set_point_toxin.initial_sd": 0.1,
    "food.*.nutrient": 0.0,
    "food.*.toxin": 0.0,
    "nutrient.initial": 40.0,
    "nutrient.capacity": 400.0,
    "nutrient.basic_cost": 1e-4,
    "nutrient.action_cost": 2e-6,
    "nutrient.hazard_share": 0.2,
    "nutrient.observed": True,
    "toxin.decay": 0.01,
    "toxin.threshold": 5.0,
    "toxin.observed": True,
    "food.*.placement.drift": (0.0, 0.0),
    "food.*.placement.spacing": 0.0,
    "obstacle.count": 0,
    "obstacle.corners": 3,
    "obstacle.min_side": 40.0,
    "obstacle.max_side": 40.0,
    "obstacle.friction": 0.6,
    "obstacle.restitution": 0.6,
    "obstacle.damage": 0.0,
    "reward.family": "linear",
    "reward.threshold": 50.0,
    "reward.threshold_width": 10.0,
    "reward.meal_coef": 1.0,
    "reward.relief_coef": 0.0,
}
"""Settings that older versions did not have, with what those versions did; `*` stands for every kind of food. A
complete file without such a setting is older and means this value. Digests leave the setting out if it has this value,
so that older digests stay valid."""
IN_TABLES = {"reward.see.*.reads": ""}
"""The same for settings of tables that a config need not have, whose default is what those versions did."""

_HEAD = "# Complete: this file has every setting; none comes from the preset or the fidelity.\n"


def dump_toml(config: Config, section: str | None = None) -> str:
    """Writes a config as a TOML file that loads to an equal config; each setting with its meaning and unit.

    Args:
        config: What to write.
        section: Write only this section ("food", "food.normal", …).

    Returns:
        The text. With a section it is not a complete file, but a part of one.

    Raises:
        KeyError: There is no such section.
    """
    tables = list(_tables(config))
    if section is None:
        return _HEAD + "complete = true\n" + "\n\n".join(text for _, text in tables) + "\n"
    wanted = [text for path, text in tables if path == section or path.startswith(f"{section}.")]
    if not section or not wanted:
        raise KeyError(section)
    return "\n\n".join(wanted) + "\n"


def section_paths(config: Config) -> list[str]:
    """The sections that `dump_toml` can write separately."""
    shown = [name for name in sections(Config) if name != "species" or config.species]
    return [*shown, *(f"food.{kind}" for kind in config.food), *(f"species.{name}" for name in config.species)]


def flatten(config: Config) -> dict[str, Any]:
    """Every setting by its path, in order, without the names of preset and fidelity."""
    return {path: value for path, _, value in leaves(config) if path not in PROVENANCE}


def digest(config: Config) -> str:
    """A fingerprint of a config: equal exactly if all settings are equal, apart from names and colors.

    What is left out can be told from the rest: a setting that has its value of earlier versions, and founders' genes
    where the old settings, which are put in, say the same. So configs that differ have digests that differ.

    Returns:
        SHA-256, 64 hexadecimal digits.
    """
    seen = [
        [path, value]
        for path, value in flatten(config).items()
        if not path.endswith(".color") and not is_earlier(path, value)
    ]
    old = old_rows(config)
    if old is not None:
        genes, replaced = old
        seen = [row for row in seen if row[0] not in replaced]
        at = next(i for i, row in enumerate(seen) if row[0] == "genome.neutral_count")
        seen[at + 1 : at + 1] = genes
    return hashlib.sha256(json.dumps(seen).encode()).hexdigest()


def is_earlier(path: str, value: Any) -> bool:
    """Whether a setting has the value that it had before it existed, in the sections of a species too."""
    shared = re.sub(r"^species\.[^.]+\.", "", path)
    every = re.sub(r"^(food|reward\.see)\.[^.]+\.", r"\1.*.", shared)
    earlier = EARLIER | IN_TABLES
    return every in earlier and earlier[every] == value


def diff(a: Config, b: Config) -> list[tuple[str, Any, Any]]:
    """The settings in which two configs differ.

    Returns:
        (path, value in a, value in b) in order, with None for a setting that is absent. If the kinds of food or
        their order differ, also the path "food" with their names.
    """
    left, right = flatten(a), flatten(b)
    kinds = [("food", tuple(a.food), tuple(b.food))] if list(a.food) != list(b.food) else []
    paths = dict.fromkeys([*left, *right])
    return kinds + [(path, left.get(path), right.get(path)) for path in paths if left.get(path) != right.get(path)]


def _tables(config: Config) -> Iterator[tuple[str, str]]:
    def write(path: str, section: Any) -> Iterator[tuple[str, str]]:
        lines = [f"[{path}]"] if path else []
        for name, setting in settings(type(section)).items():
            unit = f" [{setting.doc.unit}]" if setting.doc.unit else ""
            lines.append(f"{name} = {format_value(getattr(section, name))}  # {setting.doc.meaning}{unit}")
        if len(lines) > bool(path):
            yield path, "\n".join(lines)
        for name, inner in sections(type(section)).items():
            below, value = f"{path}.{name}".lstrip("."), getattr(section, name)
            for kind, item in value.items() if inner.repeated else [("", value)]:
                yield from write(f"{below}.{kind}".rstrip("."), item)

    return write("", config)
