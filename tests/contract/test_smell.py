"""Smell, compared with the sum over all sources in double precision."""

import math

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.config import ConfigError, load_config
from hedon.config.layout import observation_columns

PLAIN = (*QUICK, *STILL, *DEATHLESS, *CHILDLESS, "food.normal.growth_rate=0")
TWO = 'sensor.smells=["agent", "normal"]'


def smelled(world, species: int = 0) -> np.ndarray:
    """The entries of each living agent's observation that hold smells."""
    columns = observation_columns(world.config, list(world.config.species)[species])
    at = [i for i, name in enumerate(columns) if name.startswith("smell_")]
    return world.observations(species)[:, at]


def direct(world, decay: float, angles: tuple[float, ...]) -> np.ndarray:
    """The same as sums over all agents, then all foods, with noses at these angles [degree]: (alive, sources·noses)."""
    lives, foods = world.agents(), world.foods()
    places = np.stack([lives["x"], lives["y"]], axis=1).astype(float)
    sources = [places, np.stack([foods["x"], foods["y"]], axis=1).astype(float)]
    rows = []
    for i, (place, heading) in enumerate(zip(places, lives["angle"].astype(float), strict=True)):
        row = []
        for k, all_of in enumerate(sources):
            others = np.delete(all_of, i, axis=0) if k == 0 else all_of
            for angle in angles:
                turned = heading + math.radians(angle)
                nose = place + 10.0 * np.array([-math.sin(turned), math.cos(turned)])
                row.append(min(1.0, np.exp(-decay * np.linalg.norm(others - nose, axis=1)).sum()))
        rows.append(row)
    return np.array(rows)


@pytest.mark.parametrize(("noses", "angles"), [(1, (0.0,)), (2, (-30.0, 30.0))])
@pytest.mark.parametrize("decay", [0.1, 0.06])
def test_smell_is_the_sum_over_all_sources(decay, noses, angles):
    settings = (f"sensor.noses={noses}", "sensor.nose_angle=30", f"sensor.smell_decay={decay}")
    simulation = make_simulation(*QUICK, TWO, *settings, "food.normal.initial_count=60")
    simulation.run(32)
    world = simulation.worlds[0]
    ours, exact = smelled(world), direct(world, decay, angles)
    assert ours.shape == exact.shape == (world.alive, 2 * noses)
    assert np.abs(ours - exact).max() < 1.1e-4  # the largest error of the cutoff, plus rounding
    assert np.ptp(exact[:, 0]) > 0.1


def test_one_source_by_hand_and_no_smell_of_oneself():
    simulation = make_simulation(*PLAIN, TWO)
    set_scene(simulation, [(100, 100, 0.0)], [(100, 130)])
    assert smelled(simulation.worlds[0])[0].tolist() == pytest.approx([0.0, math.exp(-0.1 * 20)], rel=1e-5)


def test_two_noses_tell_left_from_right():
    simulation = make_simulation(*PLAIN, 'sensor.smells=["normal"]', "sensor.noses=2", "sensor.nose_angle=90")
    set_scene(simulation, [(100, 100, 0.0)], [(130, 100)])  # it faces +y, and the food is on its right
    right, left = smelled(simulation.worlds[0])[0]
    assert (right, left) == pytest.approx((math.exp(-2), math.exp(-4)), rel=1e-5)


def test_smell_is_at_most_one():
    simulation = make_simulation(*PLAIN, TWO, "sensor.smell_decay=0.01")
    set_scene(simulation, [(100, 100, 0.0)], [(100, 120 + 10 * i) for i in range(5)])
    assert smelled(simulation.worlds[0])[0, 1] == 1.0


def test_a_reward_for_smell_is_the_weight_times_the_mean_over_noses():
    gene = ("reward.pay.smell_normal.gene.initial_mean=2", "reward.pay.smell_normal.gene.initial_sd=0")
    simulation = make_simulation(
        *PLAIN, TWO, "sensor.noses=2", "reward.pay.smell_normal.coef=0.3", *gene, "reward.action_coef=0"
    )
    set_scene(simulation, [(100, 100, 0.4)], [(100, 130)])
    world = simulation.worlds[0]
    expected = 0.3 * 2 * smelled(world)[0, 2:].mean()
    simulation.run(1)
    assert world.view("life.reward")[world.living[0]] == pytest.approx(expected, rel=1e-5)
    assert expected > 0.03


def test_agents_learn_from_what_they_smelled():
    """A wide observation: six entries of smell in a world that learns, with the same bits on two threads."""
    settings = (*QUICK, "sensor.noses=2", 'sensor.smells=["*"]')
    worlds = []
    for threads in (1, 2):
        simulation = make_simulation(*settings, preset="poison", threads=threads)
        simulation.run(192)
        worlds.append(simulation.worlds[0])
    assert worlds[0].digest() == worlds[1].digest()
    assert smelled(worlds[0]).shape[1] == 6
    assert worlds[0].counters["learners"] > 0


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ('sensor.smells=["food"]', "must be names of agent, normal"),
        (
            "reward.pay.smell_normal.coef=1",
            "there is no channel 'smell_normal' here; sensor.smells says what it smells",
        ),
        ("sensor.smell_decay=0", "sensor.smell_decay"),
    ],
)
def test_contradictions_are_refused_by_name(setting, message):
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=[setting])
