"""Environments without a seed differ from one another, and report the seeds that they drew."""

from typing import Any

import pytest
from worlds import QUICK

from hedon import ArgumentError, env, load_config, make

CONFIG = load_config("baseline", overrides=QUICK)
KINDS = {
    "vector": lambda seed: make(CONFIG, 2, seed=seed),
    "agent": lambda seed: env.AgentEnv(CONFIG, seed=seed),
    "parallel": lambda seed: env.ParallelEnv(CONFIG, seed=seed),
}


def _digests(made):
    made.reset()
    return tuple(world.digest() for world in made.simulation.worlds)


@pytest.mark.parametrize("kind", KINDS)
def test_unseeded_environments_differ(kind):
    made = [KINDS[kind](None) for _ in range(4)]
    digests = [_digests(each) for each in made]
    assert len({digest for each in digests for digest in each}) == sum(map(len, digests))
    again = KINDS[kind](made[0].simulation.seeds[0])
    assert _digests(again) == digests[0]


@pytest.mark.parametrize("kind", KINDS)
def test_invalid_options_are_named(kind):
    with pytest.raises(ArgumentError, match="options = 5: must be a dict"):
        KINDS[kind](0).reset(options=5)


def test_other_arguments_of_a_wrong_type_are_named():
    import numpy as np

    wrong: Any = 5
    with pytest.raises(ArgumentError, match=r"overrides = 5: must be a list of texts"):
        make("baseline", overrides=wrong)
    with pytest.raises(ArgumentError, match=r"overrides = 5: must be a list of texts"):
        load_config("baseline", overrides=wrong)
    wrong = np.array(["human", "rgb_array"])
    with pytest.raises(ArgumentError, match="render_mode"):
        make("baseline", render_mode=wrong)
