"""A kind of food that looks like another: only rays cannot tell them apart."""

import numpy as np
import pytest
from cuda_emulation import emulated as emulated
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon import ConfigError, RunPlan, Simulation, load_config, resume, run
from hedon.check import check_run
from hedon.config import digest
from hedon.env import make

DECOY = ("food.decoy.gives.energy=0", "food.decoy.looks_like=normal", "food.decoy.growth_rate=0")
PAID = ("reward.pay.see_normal.coef=0.2", "reward.pay.see_normal.gene.initial_mean=1")
ALONE = (*QUICK, *STILL, *DEATHLESS, *CHILDLESS, "reward.pay.see_normal.gene.initial_sd=0", *PAID)


def looked_at(kind: int, *settings: str) -> tuple[np.ndarray, float]:
    """The readings of an agent that faces a food item, and its reward for the step."""
    simulation = make_simulation(*ALONE, *DECOY, *settings, preset="baseline")
    set_scene(simulation, [(100, 100, 0.0)], [(100, 125)], [kind])
    world = simulation.worlds[0]
    rays = np.array(world.rays(0)[0])
    simulation.run(1)
    return rays, float(world.view("reward")[world.living[0], 0])


def test_rays_read_a_decoy_as_what_it_looks_like_and_pay_for_it():
    real, fake = looked_at(0), looked_at(1)
    np.testing.assert_array_equal(real[0], fake[0])
    assert real[0].shape[1] == 3, "agents, normal and walls"
    assert (real[0][:, 1] > 0).sum() >= 3
    assert real[1] == fake[1] > 0
    honest = looked_at(1, 'food.decoy.looks_like=""')
    assert honest[0].shape[1] == 4
    np.testing.assert_array_equal(honest[0][:, 2], fake[0][:, 1])
    assert (honest[0][:, 1] <= 0).all()


def test_observations_have_no_rays_of_a_decoy_but_feel_it():
    columns = list(make(load_config("baseline", overrides=DECOY)).groups["agent"].columns)
    plain = list(make("baseline").groups["agent"].columns)
    assert [name for name in columns if name.startswith("ray_")] == [name for name in plain if name.startswith("ray_")]
    assert {name for name in columns if name not in plain} == {f"touch_decoy_{i}" for i in range(6)}


def test_an_agent_that_eats_a_decoy_gets_what_it_gives_and_is_paid_for_the_meal():
    settings = (
        *ALONE,
        *DECOY,
        "food.decoy.gene.initial_mean=0.5",
        "food.decoy.gene.initial_sd=0",
        "sensor.mouth_spread=180",
    )
    simulation = make_simulation(*settings, preset="baseline")
    set_scene(simulation, [(100, 100, 0.0)], [(100, 112)], [1])
    world = simulation.worlds[0]
    before = world.agents()["energy"][0]
    simulation.run(1)
    assert world.agents()["eaten"].tolist() == [[0, 1]]
    assert world.agents()["energy"][0] <= before
    assert world.agents()["reward"][0] > 0.4


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        (("food.decoy.looks_like=nomal",), "must be another kind of food: there are normal.*did you mean normal"),
        (("food.decoy.looks_like=decoy",), "must be another kind of food: there are normal"),
        (("food.normal.looks_like=decoy",), "decoy looks like normal: name a kind that looks like itself"),
        (('sensor.sees=["decoy"]',), "sensor.sees names decoy, which no species sees as itself: name normal"),
        (("reward.pay.see_decoy.coef=1",), "there is no channel 'see_decoy'"),
    ],
)
def test_impossible_settings_are_named(settings, says):
    with pytest.raises(ConfigError, match=says):
        load_config("baseline", overrides=[*DECOY, *settings])


def test_a_look_changes_digests_only_if_there_is_one():
    plain, other = (
        load_config("baseline", overrides=[*DECOY, f'food.decoy.looks_like="{like}"']) for like in ("", "normal")
    )
    assert digest(plain) != digest(other)
    # The same as before the setting existed.
    assert digest(load_config("baseline")) == "2087a81e05045bdcba911792a5019c4820a60a57988a3e577725d88b17329e83"
    assert digest(other.with_("food.decoy.looks_like", "")) == digest(plain)


def test_a_run_from_before_the_setting_can_be_read_and_resumed(tmp_path):
    run(RunPlan(load_config("baseline", overrides=QUICK), (1,), 64, tmp_path / "run"))
    file = tmp_path / "run" / "config.toml"
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    file.write_text("".join(line for line in lines if not line.startswith("looks_like")), encoding="utf-8")
    assert len(lines) > len(file.read_text(encoding="utf-8").splitlines())
    assert resume(tmp_path / "run", steps=128).status == "finished"
    assert check_run(tmp_path / "run").findings == ()


@pytest.mark.more
def test_a_device_sees_decoys_as_the_processor_does(emulated):
    config = load_config(
        "baseline", overrides=[*QUICK, "food.decoy.gives.energy=0", "food.decoy.looks_like=normal", *PAID]
    )
    ends = []
    for backend in ("avx2", emulated):
        simulation = Simulation(config, seeds=[1, 2], backend=backend)
        simulation.run(128)
        ends.append([world.digest() for world in simulation.worlds])
    assert ends[0] == ends[1]
