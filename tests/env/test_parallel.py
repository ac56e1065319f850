"""The environment with PettingZoo's Parallel API, checked by PettingZoo's own tests and against the world itself."""

import warnings

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, load_config

pytest.importorskip("pettingzoo", reason='needs the optional packages: pip install "hedon[env]"')
from pettingzoo.test import parallel_api_test, parallel_seed_test

from hedon.env import ParallelEnv

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=30", "population.initial_count=20")
CONFIG = load_config("baseline", overrides=LIVELY)


def play(world, steps, seed=7):
    """All results of a reset and of some steps with random actions."""
    begun = world.reset(seed=seed)

    def tell():
        return world.step({agent: world.action_space(agent).sample() for agent in world.agents})

    return [begun, *(tell() for _ in range(steps))]


def test_it_passes_pettingzoos_tests():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # possible agents are not listed, and newborns are new agents
        parallel_api_test(ParallelEnv(CONFIG), num_cycles=200)
    parallel_seed_test(lambda: ParallelEnv(CONFIG), num_cycles=100)


def test_a_seed_gives_the_same_world_with_its_newborns():
    first, second = play(ParallelEnv(CONFIG), 120), play(ParallelEnv(CONFIG), 120)
    for one, other in zip(first, second, strict=True):
        for mine, theirs in zip(one, other, strict=True):
            assert mine.keys() == theirs.keys()
            for name in mine:
                np.testing.assert_array_equal(mine[name], theirs[name])
    assert first[-1][0].keys() != play(ParallelEnv(CONFIG), 120, seed=8)[-1][0].keys()


def test_agents_appear_and_vanish():
    world = ParallelEnv(CONFIG)
    observations, _ = world.reset(seed=3)
    gone, seen = set(), set(world.agents)
    for _ in range(100):
        before = set(world.agents)
        observations, rewards, ended, cut, _ = world.step({})
        for name, over in ended.items():
            assert over == (name not in world.agents)
            assert over <= (name in before)
            assert not (over and observations[name].any())
        assert not any(cut.values())
        assert set(rewards) == set(observations) == before | set(world.agents)
        gone |= {name for name, over in ended.items() if over}
        seen |= set(world.agents)
        assert not gone & set(world.agents)
    real = world.simulation.worlds[0]
    assert len(gone) == real.counters["deaths"] > 10
    assert len(seen) == 20 + real.counters["births"] > 30
    assert [f"agent_{identity}" for identity in real.agents()["agent_id"]] == world.agents
    mine = np.array([observations[name] for name in world.agents])
    np.testing.assert_array_equal(mine, real.observations())


def test_a_time_limit_ends_the_world():
    world = ParallelEnv(CONFIG, max_steps=5)
    said = play(world, 5)
    assert all(said[-1][3].values())
    assert world.agents == []
    assert world.step({}) == ({}, {}, {}, {}, {})
    world.reset()
    assert len(world.agents) == 20


@pytest.mark.parametrize(
    ("actions", "says"),
    [
        ({"agent_99": np.zeros(2)}, "no agent 'agent_99' is alive"),
        ({"agent_0": np.zeros(3)}, "two finite numbers"),
        ({"agent_0": [0.0, np.inf]}, "two finite numbers"),
    ],
)
def test_bad_actions_are_named(actions, says):
    world = ParallelEnv(CONFIG)
    world.reset()
    with pytest.raises(ArgumentError, match=says):
        world.step(actions)
    with pytest.raises(ArgumentError, match="no such agent"):
        world.action_space("wolf_1")
