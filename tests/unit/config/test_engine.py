"""What the engine receives from a config: every setting, at its own path or in a layout."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from two_stores import FED

from hedon.config import engine_config, load_config, settable, walls
from hedon.config.config import Config
from hedon.config.engine import engine_paths
from hedon.config.field import Setting, leaves
from hedon.config.header import header
from hedon.config.schema.life import distance_sd

ENGINE = Path(__file__).parents[3] / "engine"
CONFIG = load_config(
    "poison",
    overrides=[
        "reward.pay.see_poison.coef=0.1",
        "sensor.smells=['poison']",
        "sensor.scaling=unit",
        "reward.pay.smell_poison.coef=0.1",
        "reward.family=between",
        "reward.gate=age",
        *FED,
        "food.poison.needs.nutrient=1.0",
        "reward.drive_reduction_coef=1.0",
        "reward.pay.moved.coef=0.1",
        "sensor.observes.age=100",
        "sensor.season_period=100",
        "genome.learning.gamma.initial_sd=0.1",
        'reward.rule="my.py:pay"',
        "genome.extra.kindness.initial_sd=0.2",
        "genome.set.sensor.ray_length.initial_sd=0.2",
        "neighbor.near.range=30",
        "genome.mutation.w_action.scale=0.1",
    ],
)
OWN = "species.agent."
WALLS = walls(CONFIG.arena).tolist()
LEAVES = {path: setting for path, setting, _ in leaves(CONFIG)}
del LEAVES["food.poison.looks_like"]  # the sight of it is rewarded, so it has to look like itself
OTHER: dict[str, Any] = {
    OWN + "body.collides": ("normal",),
    OWN + "sensor.sees": ("normal", "poison"),
    OWN + "sensor.smells": ("normal", "poison"),
    OWN + "reward.pay.see_poison.channel": "see_normal",
    OWN + "diet.eats": (("normal", 0.5),),
    OWN + "neighbor.near.of": (),
    OWN + "reward.rule": "",
    OWN + "reward.gate": "energy",
    OWN + "reward.pay.moved.channel": "effort",
    "arena.inner_walls": ((1.0, 1.0, 2.0, 2.0),),
    "food.normal.looks_like": "poison",
    "food.normal.placement.centers": ((1.0, 1.0),),
    "food.poison.placement.centers": ((1.0, 1.0),),
}
"""Alternative values for settings that are lists or names."""


def changed(config: Any, path: str, value: Any) -> Any:
    """A config, or part of one, with one setting replaced and nothing checked."""
    name, _, rest = path.partition(".")
    if isinstance(config, dict):  # its names may contain dots
        name = max((each for each in config if f"{path}.".startswith(f"{each}.")), key=len)
        rest = path[len(name) + 1 :]
        return {**config, name: changed(config[name], rest, value) if rest else value}
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


def test_the_engines_structs_match_the_settings() -> None:
    """After changing settings: `python -m hedon.config.header > engine/config/schema.h`, and likewise for settable."""
    assert (ENGINE / "config" / "schema.h").read_text() == header()
    assert (ENGINE / "config" / "settable.h").read_text() == settable.header()


@pytest.mark.parametrize("path", LEAVES)
def test_every_setting_of_a_world_reaches_the_engine(path: str) -> None:
    """At its own path, in a layout or in walls; all except names, colors and the source of founders."""
    other = changed(CONFIG, path, other_value(path, LEAVES[path]))
    reaches = (engine_config(other), walls(other.arena).tolist()) != (engine_config(CONFIG), WALLS)
    # genome.prey acts only if a species eats another.
    quiet = r"name|preset|fidelity|world\.(founders|networks)|food\.\w+\.color|.*genome\.prey\.\w+"
    # The engine does not distinguish rules: it only learns whether there is one.
    assert reaches != bool(re.fullmatch(quiet, path)), path


def test_the_engine_has_settings_at_their_own_paths() -> None:
    places = engine_paths(CONFIG)
    assert places["physics.dt"] == ["physics.dt"]
    assert places["world.rollout_steps"] == ["world.rollout_steps"]
    assert places["food.poison.gives.energy"] == ["layout[0].gives[3]"]
    assert places[OWN + "hazard.beta_age"] == ["species[0].hazard.beta_age"]
    assert places["food.poison.gene.initial_sd"] == ["layout[0].genes[2].law.initial_sd"]
    assert places[OWN + "genome.mutation.w_action.scale"] == ["layout[0].genes[4].mutation.scale"]
    assert OWN + "motor.min_force" in places
    assert OWN + "motor.min_force" not in engine_paths(CONFIG.with_("motor.force_scale", 2.0))


def test_genes_follow_the_order_of_the_layout() -> None:
    config = load_config("poison", overrides=["food.poison.gene.initial_mean=3", "genome.action.initial_mean=-2"])
    genes = engine_config(config)["layout"][0]["genes"]
    assert [gene["law"]["initial_mean"] for gene in genes][:4] == [0, 3, -2, 0]
    assert len(genes) == 3 + config.species["agent"].genome.neutral_count


def test_distance_is_in_arena_units() -> None:
    def sd(config: Config) -> float:
        return distance_sd(config.arena, config.species["agent"].birth)

    assert sd(load_config("baseline")) == 100.0
    assert sd(load_config("small", "as_printed")) == pytest.approx(28.8)
