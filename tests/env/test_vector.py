"""The arrays of many driven worlds, compared with the worlds themselves."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, make_simulation

from hedon import ArgumentError, load_config, make
from hedon.config.layout import observation_columns

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=60", "population.initial_count=40")
PAIR = (
    *LIVELY,
    "species.wise.body.radius=10",
    "species.led.body.radius=10",
    "species.led.sensor.ray_count=8",
    "reward.pay.see_normal.coef=0.1",
)


def config(*settings, preset="baseline"):
    return load_config(preset, overrides=settings)


LOGIT: Any = "logit"


def act(group, rng):
    group.actions[...] = rng.standard_normal(group.actions.shape)


def test_observations_match_the_world():
    worlds = make(config(*LIVELY), 2, seed=1, actions=LOGIT, threads=2)
    agents = worlds.groups["agent"]
    rng = np.random.default_rng(0)
    for _ in range(80):
        act(agents, rng)
        worlds.step(agents.actions)
    for w, world in enumerate(worlds.simulation.worlds):
        living = world.living
        np.testing.assert_array_equal(agents.ids[w, living], world.agents()["agent_id"])
        np.testing.assert_array_equal(agents.observations[w, living], world.observations())
        assert agents.alive[w].sum() == world.alive
    assert (agents.observations[~agents.alive] == 0).all()


def test_agents_do_what_they_are_told():
    """A driven world that repeats the actions of a learning world takes the same course."""
    settings = (*QUICK, *DEATHLESS, *CHILDLESS)
    learner = make_simulation(*settings, seeds=(5,))
    worlds = make(config(*settings), seed=5, actions=LOGIT, threads=1)
    agents, world = worlds.groups["agent"], worlds.simulation.worlds[0]
    rewards = np.zeros(agents.rewards.shape)
    for step in range(63):
        learner.run(1)
        agents.actions[0] = learner.worlds[0].view("action").reshape(len(agents.actions[0]), -1, 2)[:, step]
        worlds.step(agents.actions)
        rewards += agents.rewards
    for name, values in learner.worlds[0].agents().items():
        np.testing.assert_array_equal(values, world.agents()[name], err_msg=name)
    np.testing.assert_allclose(rewards[0, world.living], world.agents()["reward"], rtol=1e-4, atol=1e-7)


def test_births_and_deaths_appear_in_the_arrays():
    worlds = make(config(*LIVELY), seed=3, actions=LOGIT, threads=1)
    agents = worlds.groups["agent"]
    rng = np.random.default_rng(0)
    born, died, paid = set(), set(), 0.0
    for _ in range(150):
        act(agents, rng)
        before, old = agents.ids.copy(), agents.actions.copy()
        worlds.step(agents.actions)
        fresh, gone = agents.ids[agents.born], before[agents.terminated]
        assert not died & set(agents.ids[agents.alive].tolist())
        assert (agents.actions[agents.born] == 0).all()
        kept = agents.alive & ~agents.born
        np.testing.assert_array_equal(agents.actions[kept], old[kept])
        assert (agents.rewards[before < 0] == 0).all()
        born |= set(fresh.tolist())
        died |= set(gone.tolist())
        paid += agents.rewards.sum(dtype=np.float64)
    world = worlds.simulation.worlds[0]
    assert len(born) == world.counters["births"] > 20
    assert len(died) == world.counters["deaths"] > 20
    lives = world.agents()["reward"].sum() + world.deaths()["reward"].sum()
    assert paid == pytest.approx(lives, rel=1e-4)


def test_threads_change_nothing_and_a_reset_begins_again():
    ends = []
    worlds, other = (
        make(config(*PAIR), 3, seed=1, species="led", actions=LOGIT, threads=threads) for threads in (1, 2)
    )
    for driven in (worlds, worlds, other):
        driven.reset(seed=1)
        rng = np.random.default_rng(1)
        for _ in range(70):
            act(driven.groups["led"], rng)
            driven.step(driven.actions)
        group = driven.groups["led"]
        ends.append([world.digest() for world in driven.simulation.worlds])
        ends[-1] += [group.observations.tobytes(), group.rewards.tobytes(), group.ids.tobytes()]
    assert ends[0] == ends[1] == ends[2]


def test_other_species_learn_while_one_is_driven():
    worlds = make(config(*PAIR), seed=1, species=["led"], repeat=128)
    group = worlds.groups["led"]
    assert list(worlds.groups) == ["led"]
    worlds.step(worlds.actions)
    world = worlds.simulation.worlds[0]
    assert world.counters_of(0)["learners"] > 0 == world.counters_of(1)["learners"]
    living = worlds.config.species["wise"].population.capacity
    mine = world.living[world.living >= living] - living
    np.testing.assert_array_equal(group.observations[0, mine], world.observations(1))
    assert group.columns == observation_columns(worlds.config, "led")


def test_columns_say_what_is_where():
    worlds = make(config(*QUICK, preset="poison"), seed=1)
    world, group = worlds.simulation.worlds[0], worlds.groups["agent"]
    column = {name: group.observations[0, world.living, i] for i, name in enumerate(group.columns)}
    assert len(group.columns) == 125
    rays = world.rays()
    np.testing.assert_array_equal(column["ray_poison_3"], rays[:, 3, 2])
    np.testing.assert_array_equal(column["ray_wall_23"], rays[:, 23, 3])
    np.testing.assert_array_equal(column["energy"], world.agents()["energy"].astype(np.float32))
    np.testing.assert_array_equal(column["heading"], world.agents()["angle"])


def test_sight_is_rewarded():
    worlds = make(config(*PAIR, "species.led.reward.action_coef=0"), seed=1, species="led", repeat=20)
    worlds.step(worlds.actions)
    assert (worlds.groups["led"].rewards != 0).any()


NOT_A_CONFIG: Any = 5


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (lambda w: w.groups["agent"].actions.__setitem__((0, 3, 1), np.nan), r"actions\[0, 3, 1\] \(right\) = nan"),
        (lambda w: w.reset(seed=[1, 2]), "there must be 1, one per world, not 2"),
        (lambda w: make(w.config, species="agnt"), "did you mean agent"),
        (lambda w: make(NOT_A_CONFIG), "must be a Config"),
        (lambda w: make(w.config, species=[]), "at least one"),
    ],
)
def test_bad_input_is_named(wrong, says):
    worlds = make(config(*QUICK), seed=1)

    def go_on():
        wrong(worlds)
        worlds.step(worlds.actions)

    with pytest.raises(ArgumentError, match=says):
        go_on()


def test_the_engine_refuses_arrays_of_another_shape():
    worlds = make(config(*QUICK), seed=1)
    engine, group = worlds.simulation.engine, worlds.groups["agent"]
    with pytest.raises(ValueError, match="a row for each slot"):
        engine.set_actions(0, group.actions[:, 1:].copy())
    with pytest.raises(ValueError, match="as many columns"):
        engine.read_observations(0, group.observations[:, :, 1:].copy(), group.rewards, group.ids)
    with pytest.raises(ValueError, match="must be external"):
        make_simulation(*QUICK).engine.set_actions(0, group.actions)
    with pytest.raises(IndexError):
        engine.set_actions(1, group.actions)


def test_a_trained_policy_forages_better_than_chance():
    """The example, with fewer generations."""
    spec = spec_from_file_location("foraging", Path(__file__).parents[2] / "examples" / "foraging.py")
    assert spec is not None
    assert spec.loader is not None
    foraging = module_from_spec(spec)
    spec.loader.exec_module(foraging)
    trained, random = foraging.compare(generations=4)
    assert trained.mean() > 2 * random.mean() > 0
