import dataclasses
import math
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from hedon.config import FIDELITIES, PRESETS, Config, ConfigError, dump_toml, load_config
from hedon.config.load import PAPER_PRESETS, SEQUEL_PRESETS, describe_fidelity, describe_preset, is_modified

Write = Callable[[str], Path]


def problems(source: str | Path, fidelity: str | None = None, overrides: list[str] | None = None) -> str:
    with pytest.raises(ConfigError) as caught:
        load_config(source, fidelity, overrides or [])
    return str(caught.value)


def test_baseline_is_the_default() -> None:
    assert load_config("baseline") == Config()


@pytest.mark.parametrize("fidelity", FIDELITIES)
@pytest.mark.parametrize("preset", PRESETS)
def test_every_preset_loads_with_every_fidelity(preset: str, fidelity: str) -> None:
    config = load_config(preset, fidelity)
    assert (config.name, config.preset, config.fidelity) == (preset, preset, fidelity)
    for what in (describe_preset(preset), describe_fidelity(fidelity)):
        assert re.fullmatch(r"[A-Z][^.]{20,}\.", what), "one sentence"


@pytest.mark.parametrize(
    ("preset", "size", "foods"),
    [
        ("baseline", (480, 360), {"normal": (1.0, 100, "uniform")}),
        ("small", (360, 360), {"normal": (1.0, 100, "uniform")}),
        ("large", (480, 480), {"normal": (1.0, 100, "uniform")}),
        ("centered", (480, 360), {"normal": (1.0, 100, "gaussian")}),
        ("relocation", (480, 360), {"normal": (1.0, 100, "switching")}),
        ("poor", (480, 360), {"normal": (1.0, 90, "uniform"), "poor": (0.2, 30, "uniform")}),
        ("poison", (480, 360), {"normal": (1.0, 120, "uniform"), "poison": (-0.6, 40, "uniform")}),
    ],
)
def test_presets_are_the_conditions_of_the_paper(preset: str, size: tuple[int, int], foods: dict) -> None:
    config = load_config(preset)
    assert (config.arena.width, config.arena.height) == size
    assert {k: (f.gives["energy"], f.capacity, f.placement.form) for k, f in config.food.items()} == foods
    assert list(config.food) == list(foods)
    for food in config.food.values():
        assert (food.growth_rate, food.initial_count, food.candidates) == (0.2, 20, 10)


def test_places_of_food() -> None:
    centered = load_config("centered").food["normal"].placement
    assert (centered.centers, centered.sd) == (((240, 180),), (48, 36))
    moving = load_config("relocation").food["normal"].placement
    assert moving.centers == ((360, 270), (360, 90), (120, 90), (120, 270))
    assert (moving.sd, moving.switch_after) == ((48, 36), 1000)


@pytest.mark.parametrize("preset", PAPER_PRESETS)
def test_released_differs_in_solver_critic_growth_and_the_rules_of_birth_and_senses(preset: str) -> None:
    released, corrected = load_config(preset, "released"), load_config(preset)
    assert released.world.mutation_noise == "tabulated"
    assert released.species["agent"].learning.critic_target == "batch_mean"
    assert released.physics.solver == "jacobi"
    assert all(food.growth_rate == 1.0 for food in released.food.values())
    own, right = released.species["agent"], corrected.species["agent"]
    learning = dataclasses.replace(own.learning, critic_target="per_state")
    species = dataclasses.replace(own, sensor=right.sensor, population=right.population, learning=learning)
    undone = dataclasses.replace(
        released,
        fidelity="corrected",
        physics=corrected.physics,
        world=corrected.world,
        species={"agent": species},
        food={k: dataclasses.replace(food, growth_rate=0.2, candidates=10) for k, food in released.food.items()},
    )
    assert undone == corrected


@pytest.mark.parametrize("preset", PAPER_PRESETS)
def test_as_printed_is_what_the_paper_prints(preset: str) -> None:
    text, corrected = load_config(preset, "as_printed"), load_config(preset)
    assert all(food.growth_rate == 0.02 for food in text.food.values())
    own, undone = text.species["agent"], dataclasses.replace(text, fidelity="corrected")
    for path, value in (
        ("energy.initial", own.energy.initial + 20),
        ("birth.distance_unit", "u"),
        ("birth.distance_sd", 100.0),
        ("reward.action_norm", "max_force"),
        ("learning.entropy_coef", 0.001),
        ("food.*.growth_rate", 0.2),
    ):
        undone = undone.with_(path, value)
    assert own.energy.initial == 20
    assert (own.birth.distance_sd, own.birth.distance_unit) == (0.08, "arena_width")
    assert (own.reward.action_norm, own.learning.entropy_coef) == ("none", 0.0)
    assert undone == corrected


def test_later_layers_win(write: Write) -> None:
    path = write('preset = "poor"\nfidelity = "as_printed"\n[energy]\ninitial = 30\ncapacity = 300\n')
    config = load_config(path, overrides=["energy.capacity=200", "energy.capacity=250"])
    assert (config.name, config.preset, config.fidelity) == ("my", "poor", "as_printed")
    assert (config.species["agent"].energy.initial, config.species["agent"].energy.capacity) == (30.0, 250.0)
    assert isinstance(config.species["agent"].energy.initial, float)
    assert config.species["agent"].learning.entropy_coef == 0.0
    assert list(config.food) == ["normal", "poor"]


def test_fidelity_of_the_call_wins_over_the_files(write: Write) -> None:
    config = load_config(write('fidelity = "as_printed"\n'), fidelity="released")
    assert config.fidelity == "released"
    assert config.species["agent"].energy.initial == 40.0
    assert config.preset == "baseline"


def test_file_adds_and_removes_kinds_of_food(write: Write) -> None:
    path = write('preset = "poor"\nfidelity = "released"\n[food]\npoor = false\n[food.fungus]\ngives.energy = 0.5\n')
    config = load_config(path)
    assert list(config.food) == ["normal", "fungus"]
    assert config.food["fungus"].gives == {"energy": 0.5}
    assert config.food["fungus"].growth_rate == 1.0, "the overlay applies to every kind"


def test_every_kind_at_once(write: Write) -> None:
    path = write('preset = "poor"\n[food."*"]\ngrowth_rate = 0.5\n[food.poor]\ngrowth_rate = 0.1\n')
    rates = {kind: food.growth_rate for kind, food in load_config(path).food.items()}
    assert rates == {"normal": 0.5, "poor": 0.1}
    config = load_config(path, overrides=["food.*.growth_rate=2"])
    assert [food.growth_rate for food in config.food.values()] == [2.0, 2.0]


def test_an_unknown_kind_does_not_silently_create_one() -> None:
    message = problems("poor", overrides=["food.norml.growth_rate=0.5"])
    assert "food.norml: there is no such kind of food (known: normal, poor)" in message
    assert "did you mean normal?" in message
    message = problems("poor", overrides=['food."*"=3'])
    assert 'food."*" = 3: must be a table' in message


def test_removing_every_kind_is_refused() -> None:
    assert "food: there must be from 1 to 8 kinds" in problems("small", overrides=["food.normal=false"])
    message = problems("small", overrides=["food.normal=false", "food.normal.capacity=3"])
    assert "a new kind must say what it gives" in message


def test_a_setting_without_its_kind_suggests_the_full_path() -> None:
    message = problems("poison", overrides=["food.growth_rate=1"])
    assert "food.growth_rate = 1: must be a table; did you mean food.normal.growth_rate?" in message


def test_unknown_preset_names_the_nearest() -> None:
    assert problems("relocaton").endswith("there is no such preset; did you mean relocation?")
    assert "(there are baseline, small" in problems("zzz")


def test_file_errors(write: Write, tmp_path: Path) -> None:
    assert "cannot be read: No such file" in problems(str(tmp_path / "none.toml"))
    assert "cannot be read: it is a folder" in problems(tmp_path)
    assert "is not valid TOML: " in problems(write("[energy\n"))
    for path in (r"C:\own\pay.py:pay", r"C:\Users\own.py:pay"):
        assert "; a path with \\ stands in single quotes" in problems(write(f'reward.rule = "{path}"\n'))
    path = tmp_path / "latin.toml"
    path.write_bytes(b'name = "\xff"\n')
    assert "it is not UTF-8 text" in problems(path)


def test_bad_top_level_names_are_reported_together(write: Write) -> None:
    path = write('preset = "smal"\nfidelity = 3\ncomplete = false\n')
    message = problems(path, overrides=["x", "preset=small", "fidelity=as_printed", "complete=true"])
    assert 'preset = "smal": must be one of baseline, small' in message
    assert "did you mean small?" in message
    assert "fidelity = 3: must be one of corrected, released, as_printed" in message
    assert "complete = false: must be true or left out" in message
    assert 'must be "section.name=value"' in message
    for name in ("preset", "fidelity", "complete"):
        assert f"{name}: is not a setting" in message


def test_complete_file_takes_no_fidelity(write: Write) -> None:
    path = write(dump_toml(load_config("baseline")).replace('fidelity = "corrected"', 'fidelity = "as_printed"'))
    assert load_config(path) == dataclasses.replace(load_config("baseline"), fidelity="as_printed"), (
        "nothing is taken from the overlay"
    )
    assert load_config(path, "as_printed") == load_config(path)
    assert "--fidelity = released: the file already has all settings" in problems(path, "released")


def test_complete_file_without_a_setting_is_refused(write: Write) -> None:
    text = dump_toml(load_config("predator"))
    lines = [line for line in text.splitlines() if not line.startswith(("digestion_steps", "width"))]
    message = problems(write("\n".join(lines)))
    assert "arena.width: is missing in a file that says it is complete; a number > 0" in message
    assert "diet.digestion_steps: is missing" in message


def test_a_shared_setting_that_reaches_no_species_is_refused(write: Write) -> None:
    message = problems("predator", overrides=["energy.basic_cost=1"])
    assert "energy.basic_cost = 1: changes nothing, since each species has its own" in message
    assert "set species.prey.energy.basic_cost and species.predator.energy.basic_cost" in message
    assert "changes nothing" in problems(write('preset = "predator"\n[energy]\nbasic_cost = 1.0\n'))
    dumped = write(dump_toml(load_config("predator")))
    assert "energy.capacity = 5: changes nothing" in problems(dumped, overrides=["energy.capacity=5"])
    # A setting that reaches a species, or is given along with the species' own, is not a mistake.
    species = load_config("predator", overrides=["motor.max_force=30"]).species
    assert [each.motor.max_force for each in species.values()] == [30, 30]
    own = "[species.prey.energy]\nbasic_cost = 2.0\n[species.predator.energy]\nbasic_cost = 3.0\n"
    said = load_config(write('preset = "predator"\n[energy]\nbasic_cost = 1.0\n' + own)).species
    assert [each.energy.basic_cost for each in said.values()] == [2.0, 3.0]


def test_shared_settings_reach_the_only_species_of_a_complete_file(write: Write) -> None:
    for own in ("agent", "bee"):
        made = load_config("poison", overrides=[f"species.{own}.energy.initial=3"])
        assert list(made.species) == [own]
        dumped = write(dump_toml(made))
        assert load_config(dumped).species == made.species
        config = load_config(dumped, overrides=["energy.capacity=500", f"species.{own}.energy.initial=5"])
        assert (config.species[own].energy.capacity, config.species[own].energy.initial) == (500, 5)


def test_agents_of_the_sequel_see_and_turn_as_in_its_program() -> None:
    for preset in SEQUEL_PRESETS:
        config = load_config(preset)
        assert {each.sensor.ray_spread for each in config.species.values()} == {60.0}
        assert {(each.hazard.alpha_age, each.hazard.beta_age) for name, each in config.species.items()} == {
            (2e-7, 4e-6) if name == "predator" else (4e-7, 2e-6) for name in config.species
        }
        for each in config.species.values():
            lever = each.body.radius * math.sin(math.radians(each.motor.angle))
            assert lever == pytest.approx(10 * math.sin(math.radians(45)), abs=1e-6)


def test_released_presets_of_the_sequel_have_its_faults_instead_of_the_first_papers() -> None:
    for preset in SEQUEL_PRESETS:
        config, corrected = load_config(preset, "released"), load_config(preset)
        assert config.physics.solver == "jacobi"
        assert config.world.mutation_noise == "independent"
        for kind, food in config.food.items():
            assert (food.growth_rate, food.candidates) == (corrected.food[kind].growth_rate, 10)
        for each in config.species.values():
            assert each.population.heading_range == pytest.approx(math.tau)
            assert each.learning.critic_target == "batch_mean"
    lopsided = {p: load_config(p, "released").species["predator"].sensor.mouth_center for p in SEQUEL_PRESETS[:6]}
    assert {preset for preset, center in lopsided.items() if center == 0} == {
        "predator-small-mouth",
        "predator-large-mouth",
    }
    assert set(lopsided.values()) == {0.0, 10.0}
    assert load_config("pitfall-weak", "released").obstacle.sight == "released"
    assert load_config("baseline", "released").world.mutation_noise == "tabulated"


def test_name_can_be_given(write: Write) -> None:
    assert load_config(write('name = "My-run.2"\n')).name == "My-run.2"
    assert load_config("small", overrides=['name="second"']).name == "second"


@pytest.mark.parametrize(
    ("file", "name"),
    [("größe (2).toml", "groe-2"), ("my.v2.toml", "my.v2"), ("..toml", "config"), ("蝶.toml", "config")],
)
def test_a_config_without_a_name_gets_one_that_is_valid_for_a_folder(tmp_path: Path, file: str, name: str) -> None:
    path = tmp_path / file
    path.write_text('preset = "small"\n')
    assert load_config(path).name == name


def test_a_config_is_modified_if_a_setting_differs_from_its_preset(write: Write) -> None:
    assert not is_modified(load_config("poison", "released"))
    assert not is_modified(load_config("poison", overrides=['food.poison.color="#112233"']))
    assert not is_modified(load_config(write('preset = "small"\nfidelity = "as_printed"\n')))
    assert is_modified(load_config("poison", overrides=["energy.initial=7"]))
    assert is_modified(load_config(write("[food.mushroom]\ngives.energy = 3.0\n")))
    assert is_modified(dataclasses.replace(Config(), preset="mine"))


def test_all_problems_of_a_file_and_its_overrides_are_reported_at_once(tmp_path):
    """Problems found at different stages: in names, foods, stores, settings, between settings, and in overrides."""
    path = tmp_path / "many.toml"
    path.write_text(
        """
        [energy]
        capacity = -3
        starvation = "die"
        [food.bad]
        growth_rate = 1.0
        [food.normal]
        growth_rate = "x"
        [species.a.store.fat]
        initial = 2
        [species.a.birth]
        logit_offse = 1
        [learning]
        minibatch_size = 7
        """
    )
    with pytest.raises(ConfigError) as caught:
        load_config(path, overrides=["nonsense", "hazard.kapp=1"])
    places = [problem.path for problem in caught.value.problems]
    assert sorted(places) == sorted(
        [
            "'nonsense'",
            "energy.starvation",
            "food.bad",
            "store.fat",
            "energy.capacity",
            "food.normal.growth_rate",
            "birth.logit_offse",
            "hazard.kapp",
            "learning.minibatch_size",
        ]
    )
