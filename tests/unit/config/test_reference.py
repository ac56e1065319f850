"""The settings page is what its generator writes, and its defaults and allowed values are those of a config."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from setting_page import PAGE, page_rows, values

from hedon.config import ConfigError, load_config
from hedon.config.reference import reference

EVERY_TABLE = """
[measure.peak]
[food.fungus]
gives = { energy = 1.0 }
schedule.growth_rate.points = [[0, 1.0]]
[obstacle]
schedule.harmful.points = [[0, 1.0]]
[hazard]
schedule.scale.points = [[0, 1.0]]
[genome]
learning.gamma = {}
family.threshold = {}
extra.kindness = {}
set.sensor.ray_length = {}
mutation.w_action = {}
[reward]
family = "above"
rule = "my.py:pay"
pay.moved = {}
[sensor]
smells = ["*"]
[store.water]
capacity = 100.0
[neighbor.near]
"""
"""A config with every table of the page, each with only the settings that it must have."""
SAID = {
    "name",
    "reward.family",
    "reward.rule",
    "sensor.smells",
    "food.fungus.schedule.growth_rate.points",
    "obstacle.schedule.harmful.points",
    "hazard.schedule.scale.points",
}
"""Where it differs from the defaults: in its name and in the settings that it gives."""
KINDS = {
    "measure.<kind>": "measure.peak",
    "food.<kind>": "food.fungus",
    "store.<kind>": "store.water",
    "neighbor.<kind>": "neighbor.near",
    "food.<kind>.schedule.<kind>": "food.fungus.schedule.growth_rate",
    "obstacle.schedule.<kind>": "obstacle.schedule.harmful",
    "hazard.schedule.<kind>": "hazard.schedule.scale",
    "genome.learning.<kind>": "genome.learning.gamma",
    "genome.family.<kind>": "genome.family.threshold",
    "genome.set.<kind>": "genome.set.sensor.ray_length",
    "genome.extra.<kind>": "genome.extra.kindness",
    "genome.mutation.<kind>": "genome.mutation.w_action",
    "reward.pay.<kind>": "reward.pay.moved",
}


def test_the_committed_page_is_current() -> None:
    current = PAGE.read_text(encoding="utf-8")
    assert current == reference(), "run: uv run python -m hedon.config.reference > docs/config.md"


def test_a_config_that_sets_nothing_has_the_defaults_of_the_page(write: Callable[[str], Path]) -> None:
    config = load_config(str(write(EVERY_TABLE)))
    have = {path: value for path, value in values(config).items() if not path.startswith("food.normal.")}
    told = {path: row.default for path, row in page_rows(KINDS).items()}
    assert told.keys() == have.keys()
    assert {path for path in told if told[path] != have[path]} == SAID


@pytest.mark.parametrize("way", ["from", "to"])
def test_values_that_the_page_does_not_allow_are_refused_in_its_words(write: Callable[[str], Path], way: str) -> None:
    file, tried = str(write(EVERY_TABLE)), 0
    for path, (default, _, _, allowed, _) in page_rows(KINDS).items():
        bounds = re.fullmatch(r"an? (number|integer) from (\S+) to (\S+)", allowed)
        if bounds is None:
            continue
        tried += 1
        step = (1 if isinstance(default, int) else 1e-3) * (1 if way == "to" else -1)
        bound = type(default)(float(bounds[3 if way == "to" else 2]))
        with pytest.raises(ConfigError) as refused:
            load_config(file, overrides=[f"{path}={bound + step}"])
        assert f"{path} = {bound + step}" in str(refused.value)
        assert allowed in str(refused.value)
    assert tried > 80
