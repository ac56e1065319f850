"""What users of other environments do with this one: wrappers, spaces, threads, copies, ends of the world."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, load_config, make

pytest.importorskip("pettingzoo", reason='needs the optional packages: pip install "hedon[env]"')
from gymnasium.spaces import Box
from pettingzoo.utils import BaseParallelWrapper, parallel_to_aec

from hedon.env import ParallelEnv

FEW = (*QUICK, "population.capacity=20", "population.initial_count=10", "birth.kappa=0")
DOOMED = load_config("baseline", overrides=[*FEW, "hazard.alpha_age=0.2"])
CONFIG = load_config("baseline", overrides=[*FEW, "hazard.kappa=0", "hazard.alpha_age=0"])
CROWD = load_config("baseline", overrides=[*QUICK, "birth.kappa=1", "hazard.alpha_age=0.5", "population.capacity=60"])


def trace(config, seed, steps=30):
    worlds = make(config, 2, seed=seed, actions="logit", threads=1)
    group = worlds.groups["agent"]
    rng = np.random.default_rng(seed)
    for _ in range(steps):
        group.actions[...] = rng.standard_normal(group.actions.shape)
        worlds.step(worlds.actions)
    return [world.digest() for world in worlds.simulation.worlds], group.observations.copy()


def test_two_environments_in_two_threads_do_not_disturb_each_other():
    alone = [trace(CONFIG, seed) for seed in (1, 5)]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(lambda seed: trace(CONFIG, seed), (1, 5)))
    for mine, theirs in zip(alone, together, strict=True):
        assert mine[0] == theirs[0]
        np.testing.assert_array_equal(mine[1], theirs[1])


def test_worlds_that_die_out_stand_still_while_others_continue():
    worlds = make(DOOMED, 6, seed=1, threads=1)
    group = worlds.groups["agent"]
    ends = []
    for _ in range(60):
        worlds.step(worlds.actions)
        ends.append([world.alive for world in worlds.simulation.worlds])
        assert ends[-1] == list(group.alive.sum(axis=1))
        assert not group.observations[~group.alive].any()
        assert not group.rewards[~group.alive & ~group.terminated].any()
    assert not any(ends[-1])
    assert len({next(i for i, each in enumerate(ends) if each[w] == 0) for w in range(6)}) > 1
    worlds.reset()
    assert group.alive.sum() == 60


def test_an_extinct_world_says_so_once_and_then_nothing():
    world = ParallelEnv(DOOMED)
    world.reset(seed=1)
    told = []
    while world.agents:
        _, _, ended, _, _ = world.step({})
        told += [name for name, over in ended.items() if over]
    assert len(told) == len(set(told)) == 10
    assert world.step({}) == ({}, {}, {}, {}, {})
    assert len(world.reset(seed=1)[0]) == 10


def test_a_newborn_in_the_slot_of_a_dead_agent_is_a_new_agent():
    """Births come before deaths, so an agent cannot die in the step of its birth; slots are reused."""
    worlds = make(CROWD, 4, seed=1, threads=1)
    group = worlds.groups["agent"]
    seen = [set(row[row >= 0]) for row in group.ids]
    for _ in range(40):
        worlds.step(worlds.actions)
        for known, ids, born in zip(seen, group.ids, group.born, strict=True):
            assert not known & set(ids[born])
            known |= set(ids[born])
        assert not group.rewards[group.born & ~group.terminated].any()
    assert max(len(known) for known in seen) > 100


def test_it_can_be_wrapped():
    wrapped = BaseParallelWrapper(ParallelEnv(CONFIG, max_steps=5))
    observations, _ = wrapped.reset(seed=2)
    space = wrapped.observation_space(wrapped.agents[0])
    assert isinstance(space, Box)
    assert all(each in space for each in observations.values())
    cut: dict[str, bool] = {}
    while wrapped.agents:
        _, _, _, cut, _ = wrapped.step({name: wrapped.action_space(name).sample() for name in wrapped.agents})
    assert all(cut.values())
    wrapped.close()
    wrapped.close()


def test_it_can_be_played_in_turns():
    """With PettingZoo's own conversion, in a world without births."""
    aec = parallel_to_aec(ParallelEnv(CONFIG, max_steps=5))
    aec.reset(seed=2)
    acted = 0
    for name in aec.agent_iter(200):
        observation, _, ended, cut, _ = aec.last()
        assert observation is not None
        assert observation.shape == (95,)
        aec.step(None if ended or cut else aec.action_space(name).sample())
        acted += not (ended or cut)
    assert acted == 5 * 10


@pytest.mark.parametrize(
    ("action", "says"),
    [
        (np.zeros(3), "must be two finite numbers"),
        (np.zeros((2, 1)), "must be two finite numbers"),
        ([np.nan, 0.0], "must be two finite numbers"),
        ([np.inf, 0.0], "must be two finite numbers"),
        ([1e300, 0.0], "must be two finite numbers"),
        ("go", "must be two finite numbers"),
        (None, "must be two finite numbers"),
        ([[1.0], 2.0], "must be two finite numbers"),
    ],
)
def test_a_wrong_action_is_named(action, says):
    world = ParallelEnv(CONFIG)
    world.reset(seed=1)
    with pytest.raises(ArgumentError, match=says):
        world.step({world.agents[0]: action})
    with pytest.raises(ArgumentError, match=r"no agent 'agent_99' is alive"):
        world.step({"agent_99": np.zeros(2, np.float32)})


def test_actions_of_another_shape_cannot_be_put_in_place():
    worlds = make(CONFIG, seed=1)
    group = worlds.groups["agent"]
    with pytest.raises(ValueError, match="broadcast"):
        group.actions[...] = np.zeros((7, 3))
    with pytest.raises(ArgumentError, match=r"actions: must be the array .*write into it"):
        group.actions = np.zeros((1, 3), np.float32)


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5, "one"])
def test_a_wrong_seed_is_named(seed):
    world = ParallelEnv(CONFIG)
    with pytest.raises(ArgumentError, match="seed"):
        world.reset(seed=seed)
    assert len(world.reset(seed=1)[0]) == 10


def test_a_step_before_the_first_reset_is_refused():
    with pytest.raises(ArgumentError, match="call reset first"):
        ParallelEnv(CONFIG).step({})
