import dataclasses
from typing import Any

import pytest

from hedon.config import Config, ConfigError, diff, load_config, validated
from hedon.config.layer import settle_species
from hedon.config.schema.evolution import MutationConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import EnergyConfig
from hedon.config.validate import build


def made(tables: dict[str, Any]) -> Config:
    """The config built from a file's tables."""
    assert not list(settle_species(tables, []))
    return build(Config, tables, "here")


def lines(tables: dict[str, Any]) -> list[str]:
    with pytest.raises(ConfigError) as caught:
        made(tables)
    assert str(caught.value).startswith("here: ")
    return [str(problem) for problem in caught.value.problems]


@pytest.mark.parametrize(
    ("tables", "line"),
    [
        ({"energy": {"initial": True}}, "energy.initial = true: must be a number from 0 to 1000000 [energy]"),
        ({"energy": {"initial": "a"}}, 'energy.initial = "a": must be a number from 0 to 1000000 [energy]'),
        (
            {"energy": {"initial": float("nan")}},
            "energy.initial = nan: must be a number from 0 to 1000000 [energy]",
        ),
        ({"body": {"radius": float("inf")}}, "body.radius = inf: must be a number > 0 and <= 1000 [u]"),
        ({"body": {"radius": 0}}, "body.radius = 0: must be a number > 0 and <= 1000 [u]"),
        (
            {"population": {"capacity": True}},
            "population.capacity = true: must be an integer from 1 to 100000 [agent]",
        ),
        ({"sensor": {"ray_count": 24.0}}, "sensor.ray_count = 24.0: must be an integer from 1 to 32"),
        ({"sensor": {"ray_count": 33}}, "sensor.ray_count = 33: must be an integer from 1 to 32"),
        (
            {"sensor": {"scaling": "units"}},
            'sensor.scaling = "units": must be one of "raw", "unit"; did you mean unit?',
        ),
        ({"sensor": {"scaling": 1}}, 'sensor.scaling = 1: must be one of "raw", "unit"'),
        ({"learning": {"adam_beta1": 1.0}}, "learning.adam_beta1 = 1.0: must be a number >= 0 and < 1"),
        ({"energy": 3}, "energy = 3: must be a table"),
        ({"food": {"normal": True}}, "food.normal = true: must be a table"),
        ({"food": 3}, "food = 3: must be a table"),
        ({"energy": {"inital": 3}}, "energy.inital: unknown name; did you mean initial?"),
        (
            {"energy": {"friction": 3}},
            "energy.friction: unknown name; did you mean physics.friction or obstacle.friction?",
        ),
        ({"kappa": 3}, "kappa: unknown name; did you mean hazard.kappa or birth.kappa?"),
        ({"learing_rate": 3}, "learing_rate: unknown name; did you mean learning.learning_rate?"),
        ({"energy": {"learing_rate": 3}}, "energy.learing_rate: unknown name; did you mean learning.learning_rate?"),
        ({"kapa": 3}, "kapa: unknown name; did you mean hazard.kappa or birth.kappa?"),
        ({"zzz": 3}, "zzz: unknown name"),
        (
            {"species": {"hunter": {}}, "hunter": {"energy": {}}},
            "hunter: unknown name; did you mean species.hunter?",
        ),
        ({"food": {"plum": {}}, "plum": {}}, "plum: unknown name; did you mean food.plum?"),
        ({"genom": {}}, "genom: unknown name; did you mean genome?"),
        ({"food": {"a": {"placment": {}}}}, "food.a.placment: unknown name; did you mean placement?"),
        (
            {"food": {"a": {"placement": {"sd": [1, 2, 3]}}}},
            "food.a.placement.sd = [1, 2, 3]: must be [number, number] with numbers from 0 to 100000 [u]",
        ),
        (
            {"arena": {"inner_walls": [[1, 2, 3]]}},
            "arena.inner_walls[0][3] = [1, 2, 3]: "
            "must be a list of [number, number, number, number] with at most 256 items, "
            "with numbers from 0 to 100000 [u]",
        ),
    ],
)
def test_each_error_says_what_is_allowed(tables: dict[str, Any], line: str) -> None:
    assert lines(tables) == [line]


def test_all_errors_are_reported_at_once() -> None:
    found = lines({"energy": {"initial": -1, "nme": 0}, "genome": {"mutation_scale": "x"}, "birht": {}})
    assert len(found) == 4


def test_integers_are_accepted_as_floats() -> None:
    config = made({"energy": {"initial": 20}})
    assert config.species["agent"].energy.initial == 20.0
    assert isinstance(config.species["agent"].energy.initial, float)


def test_configs_built_in_python_are_checked() -> None:
    assert validated(Config()) == Config()
    with pytest.raises(ConfigError, match=r"energy\.initial = -3"):
        validated(dataclasses.replace(Config(), species={"agent": SpeciesConfig(energy=EnergyConfig(initial=-3))}))
    with pytest.raises(ConfigError, match="species: there must be from 1 to 4 species, not 0"):
        validated(dataclasses.replace(Config(), species={}))


def test_one_setting_is_changed_by_its_path() -> None:
    two = load_config("predator")
    one = two.with_("species.prey.birth.kappa", 0.5)
    assert diff(two, one) == [("species.prey.birth.kappa", 1e-3, 0.5)]
    assert [own.birth.kappa for own in two.with_("birth.kappa", 0.5).species.values()] == [0.5, 0.5]
    poison = load_config("poison").with_("food.*.gives.energy", 2.0)
    assert [food.gives["energy"] for food in poison.food.values()] == [2.0, 2.0]
    scaled = two.with_("species.prey.genome.mutation.w_action.scale", 0.1).species["prey"].genome
    assert scaled.mutation["w_action"] == MutationConfig("student_t", 0.1, 2.0, 1.0, 10.0)
    assert two.with_("genome.mutation", {}) == two


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("energy.initial", -1, "energy.initial = -1: must be a number from 0 to 1000000 [energy]"),
        ("energy.inital", 1.0, "energy.inital: unknown name; did you mean initial?"),
        ("enery.initial", 1.0, "enery: unknown name; did you mean energy?"),
        ("energy.initial.x", 1.0, "energy.initial.x: there is no such setting"),
        ("food.norml.gives.energy", 1.0, "food.norml.gives.energy: there is no such setting"),
        ("species.prey.energy.initial", 1.0, "species.prey.energy.initial: there is no such setting"),
        ("energy.", 1.0, "'energy.': must be the path of a setting, as in energy.initial"),
    ],
)
def test_an_impossible_change_is_refused(path: str, value: Any, said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        load_config("baseline").with_(path, value)
    assert str(caught.value) == f"baseline: {said}"
