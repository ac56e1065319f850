"""What the page receives about a world: its layout, its settings, and the text that the engine reads."""

import json

import pytest

from hedon.config import PRESETS, engine_config, load_config
from hedon.config.dump import flatten
from hedon.config.layout import layouts
from hedon.record.schema import columns_of
from hedon.view.engine_text import engine_text
from hedon.view.layout import describe
from hedon.view.live import live_world

pytestmark = pytest.mark.smoke


@pytest.mark.parametrize("preset", PRESETS)
def test_the_layout_names_everything_that_records_and_senses_have(preset):
    config = load_config(preset)
    layout = describe(config)
    assert [gene["name"] for gene in layout["genes"]] == list(columns_of(config).gene_names)
    neutral = max(own.genome.neutral_count for own in config.species.values())
    assert [gene["role"] for gene in layout["genes"]].count("neutral") == neutral
    obstacles = ["obstacle"] if config.obstacle.count else []
    assert layout["types"] == [*config.species, *config.food, "wall", *obstacles]
    assert (layout["obstacle_corners"] > 0) == bool(obstacles)
    for species, own in zip(layout["species"], layouts(config).values(), strict=True):
        assert [layout["genes"][gene]["name"] for gene in species["genes"]] == list(own.gene_names)
        assert [layout["types"][seen] for seen in species["sees"]] == list(own.sees)
        assert [layout["types"][smelled] for smelled in species["smells"]] == list(own.smells)
        assert species["observed"] == [
            {"name": each.name, "unit": each.unit, "scale": each.scale, "meaning": each.meaning}
            for each in own.observed
        ]
        assert [store["name"] for store in species["stores"]] == list(own.stores)
        told = [layout["genes"][term["gene"]]["name"] for term in species["reward"]["meals"]]
        assert told == [f"w_{layout['meals'][term['meal']]}" for term in species["reward"]["meals"]]
        assert [*told, *(f"w_{name}" for name in species["reward"]["rest"])] == [term.gene for term in own.terms]
    assert [food["energy"] for food in layout["foods"]] == [food.gives["energy"] for food in config.food.values()]
    assert layout["arena"]["width"] == config.arena.width
    assert len(layout["arena"]["walls"]) >= 4
    json.dumps(layout, allow_nan=False)


@pytest.mark.parametrize(
    ("changes", "rest"), [({"family": "sinh"}, ["normal", "poison", "action"]), ({"rule": "my_rules.py:pay"}, [])]
)
def test_meals_are_listed_for_a_reward_only_if_it_is_linear_in_them(changes, rest):
    config = load_config("poison")
    for name, value in changes.items():
        config = config.with_(f"reward.{name}", value)
    assert describe(config)["species"][0]["reward"] == {"meals": [], "rest": rest}


@pytest.mark.parametrize("preset", PRESETS)
def test_each_setting_leads_to_its_value_in_the_engine(preset):
    config = load_config(preset)
    world = live_world(config, preset)
    engine = dict(line.split("=", 1) for line in engine_text(config, 1).splitlines())
    values = flatten(config)
    assert len(world["settings"]) > 70
    for setting in world["settings"]:
        assert setting["value"] == values[setting["path"]]
        assert {engine[name] for name in setting["engine"]} == {str(setting["value"])}


def test_a_changed_setting_changes_only_its_line_of_the_text():
    """The page edits the text by itself, so the result must match the command's config."""
    for setting in live_world(load_config("poison"), "poison")["settings"]:
        if setting["path"] not in ("food.poison.gives.energy", "food.poison.gene.initial_sd", "energy.initial"):
            continue
        before = engine_text(load_config("poison"), 1).splitlines()
        after = engine_text(load_config("poison", overrides=[f"{setting['path']}=0.5"]), 1).splitlines()
        changed = [(old, new) for old, new in zip(before, after, strict=True) if old != new]
        assert changed == [(f"{name}={setting['value']}", f"{name}=0.5") for name in setting["engine"]]


def test_the_text_has_every_setting_of_the_engine():
    text = engine_text(load_config("baseline"), 7)
    assert text.startswith("seed=7\nouter_walls=")
    for section in engine_config(load_config("baseline")):
        assert f"\n{section}" in text
