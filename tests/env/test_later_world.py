"""Environments with neighboring seeds, as Gymnasium and Stable-Baselines3 assign them, make different worlds."""

import gymnasium
import numpy as np
import pytest

import hedon
from hedon.env import AgentEnv

SMALL = ("population.initial_count=8", "population.capacity=10")


def firsts(seed: int, episodes: int) -> list[bytes]:
    """First observations of an environment that is seeded once."""
    env = AgentEnv("baseline", overrides=SMALL)
    seen = [env.reset(seed=seed)[0].tobytes()]
    return seen + [env.reset()[0].tobytes() for _ in range(episodes - 1)]


def test_worlds_of_neighboring_seeds_are_not_rerun():
    seen = [first for seed in range(5) for first in firsts(seed, 3)]
    assert len(set(seen)) == 15
    assert firsts(3, 3) == firsts(3, 3), "the same seed gives the same worlds"


def test_a_vector_of_environments_sees_only_new_worlds():
    made = gymnasium.vector.SyncVectorEnv([lambda: AgentEnv("baseline", overrides=SMALL, max_steps=4)] * 5)
    observations, _ = made.reset(seed=7)
    seen = {row.tobytes() for row in observations}
    while len(seen) < 15:
        before = len(seen)
        for _ in range(6):
            observations, *_ = made.step(made.action_space.sample())
        observations, _ = made.reset()
        seen |= {row.tobytes() for row in observations}
        assert len(seen) == before + 5


@pytest.mark.parametrize("masked", [False, True])
def test_later_worlds_follow_from_the_seed_and_a_copy_continues_likewise(masked):
    worlds = hedon.make("baseline", worlds=3, seed=5, overrides=SMALL)
    worlds.reset()
    options = {"reset_mask": np.array([True, False, True])} if masked else None
    worlds.reset(options=options)
    seeds = worlds.simulation.seeds
    assert len(set(seeds)) == 3
    again = worlds.clone()
    for _ in range(2):
        worlds.reset(options=options)
        again.reset(options=options)
        assert worlds.simulation.seeds == again.simulation.seeds
