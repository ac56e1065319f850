"""Environments that start from a saved world: the same moment, and a different future for each seed."""

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, load_config, make

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=60", "population.initial_count=40")
CONFIG = load_config("baseline", overrides=LIVELY)


def seen_by_id(worlds, world):
    """The observations of the living agents, ordered by id."""
    (group,) = worlds.groups.values()
    living = np.flatnonzero(group.alive[world])
    return group.observations[world, living[np.argsort(group.ids[world, living])]]


def test_worlds_start_from_a_saved_one_and_go_their_own_ways():
    past = make(CONFIG, 1, seed=3)
    for _ in range(70):
        past.step(past.actions)
    saved = past.save()
    futures = make(CONFIG, 3, seed=[3, 8, 9], world=saved)
    same, digest = np.array([[0.3, -0.2]], np.float32), past.simulation.worlds[0].digest()
    assert [world.digest() for world in futures.simulation.worlds] == [digest] * 3
    for world in range(3):  # agents may live in other slots
        np.testing.assert_array_equal(seen_by_id(futures, world), seen_by_id(past, 0))
    for _ in range(60):
        past.step(np.broadcast_to(same, past.actions.shape))
        futures.step(np.broadcast_to(same, futures.actions.shape))
    ends = [world.digest() for world in futures.simulation.worlds]
    assert ends[0] == past.simulation.worlds[0].digest(), "with its own seed it continues as it would have"
    assert len(set(ends)) == 3
    copied = futures.clone()
    for each in (futures, copied):
        each.reset()
        assert [world.digest() for world in each.simulation.worlds] == [digest] * 3
        assert not set(each.simulation.seeds) & {3, 8, 9}


def test_an_unusable_saved_world_is_refused(tmp_path):
    saved = make(CONFIG, 2, seed=1).save()
    with pytest.raises(ArgumentError, match="saved: there are 2 worlds, here 1"):
        make(CONFIG, 2, world=saved)
    one = make(CONFIG, 1, seed=1).save()
    with pytest.raises(ArgumentError, match="saved: these worlds were saved with another config"):
        make(CONFIG.with_("energy.basic_cost", 0.5), 2, world=one)
    with pytest.raises(ArgumentError, match="record: records begin with worlds"):
        make(CONFIG, 2, world=one, record=tmp_path / "run")
    with pytest.raises(ArgumentError, match="must be bytes"):
        make(CONFIG, 2, world="run")  # pyright: ignore[reportArgumentType]
