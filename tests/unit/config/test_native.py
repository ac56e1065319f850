"""What the engine gets of a config: every setting, under the names of the engine's structs."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hedon.config import engine_config, load_config
from hedon.config.config import Config
from hedon.config.field import Setting, leaves
from hedon.config.life import distance_sd
from hedon.config.native import PYTHON_ONLY

ENGINE = Path(__file__).parents[3] / "engine"
CONFIG = load_config(
    "poison",
    overrides=[
        "reward.see.poison.coef=0.1",
        "sensor.smells=['poison']",
        "reward.smell.poison.coef=0.1",
        "reward.family=by_age",
        "food.poison.nutrient=1.0",
        "food.normal.toxin=1.0",
        "reward.drive_reduction_coef=1.0",
        "genome.learning.gamma.initial_sd=0.1",
        "genome.mutation.w_action.scale=0.1",
    ],
)
OWN = "species.agent."
LEAVES = {path: setting for path, setting, _ in leaves(CONFIG)}
OTHER: dict[str, Any] = {
    OWN + "body.collides": ("normal",),
    OWN + "sensor.sees": ("normal", "poison"),
    OWN + "sensor.smells": ("normal", "poison"),
    OWN + "reward.see.poison.reads": "normal",
    OWN + "diet.eats": (("normal", 0.5),),
    "arena.inner_walls": ((1.0, 1.0, 2.0, 2.0),),
    "food.normal.placement.centers": ((1.0, 1.0),),
    "food.poison.placement.centers": ((1.0, 1.0),),
}
"""Other values of settings that are lists."""


def engine_structs() -> dict[str, list[str]]:
    """Names of the fields of each config struct of the engine, read from its headers."""
    text = "".join(path.read_text() for path in ENGINE.glob("*/config.h"))
    lists = re.findall(r"HEDON_FIELDS\((\w+),([^)]*)\)", text)
    return {name: [field.strip() for field in fields.split(",")] for name, fields in lists}


def changed(config: Any, path: str, value: Any) -> Any:
    """A config, or a part of one, with one setting replaced, unchecked."""
    name, _, rest = path.partition(".")
    if isinstance(config, dict):
        return {**config, name: changed(config[name], rest, value)}
    return replace(config, **{name: changed(getattr(config, name), rest, value) if rest else value})


def other_value(path: str, setting: Setting) -> Any:
    if path in OTHER:
        return OTHER[path]
    if setting.choices:
        return next(choice for choice in setting.choices if choice != value_of(path))
    value = value_of(path)
    if isinstance(value, bool):
        return not value
    if isinstance(value, tuple):
        return tuple(item + 1.0 for item in value)
    return value + "x" if isinstance(value, str) else value + 1


def value_of(path: str) -> Any:
    return next(value for name, _, value in leaves(CONFIG) if name == path)


def test_names_are_those_of_the_engines_structs() -> None:
    structs = engine_structs()
    native = engine_config(CONFIG)
    assert list(native) == structs["WorldConfig"]
    for name in ("arena", "physics"):
        assert list(native[name]) == structs[f"{name.capitalize()}Config"]
    assert list(native["rules"]) == structs["RuleConfig"]
    assert list(native["food"][0]) == structs["FoodConfig"]
    assert list(native["food"][0]["placement"]) == structs["PlacementConfig"]
    species = native["species"][0]
    assert list(species) == structs["SpeciesConfig"]
    for name, section in species.items():
        assert set(section) == set(structs[f"{name.capitalize()}Config"]), name
    assert list(species["genome"]["genes"][0]) == structs["GeneConfig"]
    assert list(species["genome"]["learning"][0]) == structs["LearningGene"]
    assert list(species["reward"]["terms"][0]) == structs["RewardTerm"]


@pytest.mark.parametrize("path", LEAVES)
def test_every_setting_arrives_or_is_listed(path: str) -> None:
    other = engine_config(changed(CONFIG, path, other_value(path, LEAVES[path])))
    shown = path.removeprefix(OWN)
    plain = re.sub(r"^(food|reward\.see|genome\.learning|genome\.mutation)\.\w+\.", r"\1.", shown)
    # These act only where a species eats another one.
    quiet = {"genome.prey.initial_mean", "genome.prey.initial_sd"}
    assert (other != engine_config(CONFIG)) == (plain not in {*PYTHON_ONLY, *quiet} - {"birth.distance_unit"}), path


def test_python_only_settings_exist() -> None:
    plain = {re.sub(r"^food\.\w+\.", "food.", path.removeprefix(OWN)) for path in LEAVES}
    assert set(PYTHON_ONLY) <= plain


def test_genes_stand_in_the_order_of_the_layout() -> None:
    config = load_config("poison", overrides=["food.poison.gene.initial_mean=3", "genome.action.initial_mean=-2"])
    genome = engine_config(config)["species"][0]["genome"]
    assert [gene["initial_mean"] for gene in genome["genes"]][:4] == [0, 3, -2, 0]
    assert len(genome["genes"]) == 3 + config.species["agent"].genome.neutral_count


def test_distance_is_in_arena_units() -> None:
    def sd(config: Config) -> float:
        return distance_sd(config.arena, config.species["agent"].birth)

    assert sd(load_config("baseline")) == 100.0
    assert sd(load_config("small", "text")) == pytest.approx(28.8)
