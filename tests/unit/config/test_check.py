import numpy as np
import pytest

from hedon.assay.landscape import AssayError, spread_founders
from hedon.assay.option import parse_spread
from hedon.config import ConfigError, load_config
from hedon.config.gene import limits_of

NINE_KINDS = ["sensor.touch_sectors=5", *(f"food.k{i}.gives.energy=1" for i in range(8))]

TWO = ["species.a.body.radius=10", "species.b.body.radius=10"]
NAME_RULE = 'must have only letters, digits, "-", "_" and ".", at most 80 of them, and not begin with a "."'


@pytest.mark.parametrize(
    ("overrides", "line"),
    [
        (
            ["population.capacity=40"],
            "population.initial_count = 50: must be at most population.capacity = 40",
        ),
        (
            ["population={capacity=250, initial_count=250}"],
            "population.initial_count = 250: too many to place: the arena has room for 247",
        ),
        (["body.radius=300"], "body.radius = 300.0: a body does not fit into the arena"),
        (
            ["body.radius=1.4"],
            "body.radius = 1.4: a body of radius 1.4 moves 1.41 u in a substep and may pass a wall: lower "
            "physics.max_speed or physics.dt",
        ),
        (
            ["genome.set.body.radius={}", "genome.weight_limit=0.9"],
            "genome.set.body.radius: can make a radius of 1.26, which passes walls, as it moves 1.41 u in a substep: "
            "give genome.mutation.g_body_radius a limit below 0.849, or lower physics.max_speed",
        ),
        (
            ["learning.minibatch_size=100"],
            "learning.minibatch_size = 100: must divide world.rollout_steps = 1024",
        ),
        (
            ["learning.minibatch_size=2048"],
            "learning.minibatch_size = 2048: must divide world.rollout_steps = 1024",
        ),
        (
            ["food.normal.capacity=10"],
            "food.normal.initial_count = 20: must be at most food.normal.capacity = 10",
        ),
        (["motor.min_force=80"], "motor.min_force = 80.0: must be below motor.max_force = 80"),
        (["energy.capacity=30"], "energy.initial = 40.0: must be at most its capacity = 30"),
        (NINE_KINDS, "food: there must be from 1 to 8 kinds of food, not 9"),
        (
            ["sensor.touch_sectors=32", "food.b.gives.energy=1", "food.c.gives.energy=1"],
            "sensor.touch_sectors = 32: must be at most 25 with 5 types to touch",
        ),
        (
            ["food.normal.placement.form=gaussian", "food.normal.placement.sd=[1, 1]"],
            'food.normal.placement.centers: "gaussian" takes one center, not 0',
        ),
        (
            ["food.normal.placement.form=gaussian", "food.normal.placement.centers=[[50, 50]]"],
            'food.normal.placement.sd = [0.0, 0.0]: "gaussian" takes two numbers > 0 [u]',
        ),
        (
            ["food.normal.placement={form='switching', centers=[[50, 50]], sd=[1, 1]}"],
            'food.normal.placement.centers: "switching" takes at least two centers, not 1',
        ),
        (
            ["food.normal.placement.centers=[[50, 500]]"],
            "food.normal.placement.centers[0] = [50.0, 500.0]: lies outside the arena",
        ),
        (
            ["arena.corner_radius=200"],
            "arena.corner_radius = 200.0: must be 0 or below 180 [u], with no wall shorter than 0.01 [u]",
        ),
        (
            ["arena.inner_walls=[[10, 100, 500, 100]]"],
            "arena.inner_walls[0] = [10.0, 100.0, 500.0, 100.0]: lies outside the arena",
        ),
        (
            ["arena.inner_walls=[[50, 60, 50, 60]]"],
            "arena.inner_walls[0] = [50.0, 60.0, 50.0, 60.0]: must be at least 0.01 [u] long",
        ),
        (
            ["birth.distance_unit=arena_width"],
            'birth.distance_sd = 100.0: must be at most 1 with birth.distance_unit = "arena_width"',
        ),
        (
            ["food.normal.gene.initial_mean=-11"],
            "food.normal.gene.initial_mean = -11.0: must be within ± genome.weight_limit = 10",
        ),
        (
            ["genome.action.initial_mean=11"],
            "genome.action.initial_mean = 11.0: must be within ± genome.weight_limit = 10",
        ),
        (
            [*TWO, "species.b.genome.weight_limit=1", "species.b.genome.action.initial_mean=5"],
            "species.b.genome.action.initial_mean = 5.0: must be within ± species.b.genome.weight_limit = 1",
        ),
        (
            [*TWO, "species.b.genome.weight_limit=1", "food.normal.gene.initial_mean=5"],
            "food.normal.gene.initial_mean = 5.0: must be within ± species.b.genome.weight_limit = 1",
        ),
        (
            [*TWO, "species.b.genome.weight_limit=1", "species.b.reward.pay.see_a.gene.initial_mean=-5"],
            "species.b.reward.pay.see_a.gene.initial_mean = -5.0: must be within ± species.b.genome.weight_limit = 1",
        ),
        (
            ["genome.mutation.w_action.limit=2", "genome.action.initial_mean=5"],
            "genome.action.initial_mean = 5.0: must be within ± genome.mutation.w_action.limit = 2",
        ),
        (
            ['reward.family="sinh"', "genome.action.initial_mean=9"],
            "genome.action.initial_mean = 9.0: must be within ± 2",
        ),
        (
            ["food.normal.color=green"],
            'food.normal.color = "green": must be "#rrggbb" in lower-case hexadecimal digits',
        ),
        (
            ["arena.corner_radius=1e-3"],
            "arena.corner_radius = 0.001: must be 0 or below 180 [u], with no wall shorter than 0.01 [u]",
        ),
        (
            ["world.food_radius=1e-50"],
            "world.food_radius = 1e-50: is 0 in the engine's 32-bit numbers, but must be a number > 0 and <= 1000 [u]",
        ),
        (
            ["learning.adam_beta2=0.999999999"],
            "learning.adam_beta2 = 0.999999999: is 1 in the engine's 32-bit numbers, but must be a number >= 0 and < 1",
        ),
        (['name=""'], f'name = "": {NAME_RULE}'),
        (['name="a\\tb"'], f'name = "a\\tb": {NAME_RULE}'),
        (['name="../up"'], f'name = "../up": {NAME_RULE}'),
        (['name="/etc/x"'], f'name = "/etc/x": {NAME_RULE}'),
        (['name=".hidden"'], f'name = ".hidden": {NAME_RULE}'),
        (['name="' + "a" * 81 + '"'], f'name = "{"a" * 81}": {NAME_RULE}'),
    ],
)
def test_each_contradiction(overrides: list[str], line: str) -> None:
    with pytest.raises(ConfigError) as caught:
        load_config("baseline", overrides=overrides)
    assert [str(problem) for problem in caught.value.problems] == [line]


@pytest.mark.parametrize("kind", ["agent", "wall", "obstacle", "action", "Big", "1st", "a-b"])
def test_names_of_kinds(kind: str) -> None:
    with pytest.raises(ConfigError, match=f"food.{kind}: a kind's name must have only a-z"):
        load_config("baseline", overrides=[f"food.{kind}.gives.energy=1"])


def test_all_contradictions_are_reported_at_once() -> None:
    overrides = ["population.capacity=40", "energy.capacity=30", "arena.corner_radius=200"]
    with pytest.raises(ConfigError) as caught:
        load_config("centered", overrides=overrides)
    assert [problem.path for problem in caught.value.problems] == [
        "arena.corner_radius",
        "population.initial_count",
        "energy.initial",
    ]


def test_contradictions_are_reported_together_with_invalid_settings():
    with pytest.raises(ConfigError) as caught:
        load_config("baseline", overrides=["learning.gamma=2", "population.initial_count=300", "arena.widht=3"])
    assert {problem.path for problem in caught.value.problems} == {
        "learning.gamma",
        "population.initial_count",
        "arena.widht",
    }


def test_a_body_with_no_area_is_refused_by_name():
    with pytest.raises(ConfigError, match=r"body.radius = 5e-324: is 0 in the engine"):
        load_config("baseline", overrides=["body.radius=5e-324"])


def test_each_species_has_its_own_limits():
    """A species is checked neither against another species' limit nor against that of the config's own sections."""
    wide = ("species.a.genome.weight_limit=50", "species.a.genome.action.initial_mean=40")
    own = ("species.b.diet.eats=[]", "food.normal.gene.initial_mean=30")
    config = load_config("baseline", overrides=[*TWO, *wide, *own])
    assert config.species["b"].genome.weight_limit == 10
    assert limits_of(config, ["a.w_action"]) == {"a.w_action": 50}
    assert limits_of(config, ["b.w_action", "w_action"]) == {"b.w_action": 10, "w_action": 10}
    spread = parse_spread("-40:40", None, config.species["a"].genome)
    assert np.abs(spread_founders(config, spread, "a").values).max() > 39
    with pytest.raises(AssayError, match=r"within -10:10"):
        parse_spread("-40:40", None, config.species["b"].genome)
