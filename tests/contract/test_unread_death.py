"""Deaths that are never read: worlds run on, and a late reader learns how many are lost."""

import numpy as np
import pytest
from cuda_emulation import emulated as emulated
from worlds import QUICK

import hedon
from hedon import EngineError, Simulation, load_config

SLOTS = 4
ROOM = 16 * SLOTS
BRIEF = (
    *QUICK,
    f"population.capacity={SLOTS}",
    f"population.initial_count={SLOTS}",
    "birth.kappa=0.9",
    "birth.beta=0",
    "birth.logit_offset=-9",
    "birth.attempts=100",
    "hazard.alpha_age=0.02",
    "hazard.beta_age=0",
    "sensor.ray_count=4",
)
"""Lives of about fifty steps in a few slots."""
CONFIG = load_config("baseline", overrides=BRIEF)
LONG = 1000 * 16
"""Steps in which far more agents die than the engine has room for."""


def make(kernel: str = "") -> Simulation:
    return Simulation(CONFIG, [1], 1, kernel)


def test_a_loop_that_never_reads_deaths_runs_on_without_growing_memory():
    read, unread = make(), make()
    rows: list[np.ndarray] = []
    for _ in range(LONG // 64):
        read.run(64)
        unread.run(64)
        rows.append(read.worlds[0].deaths()["agent_id"])
    world = unread.worlds[0]
    ids = np.concatenate(rows)
    assert len(ids) == world.counters["deaths"] > 5 * ROOM
    assert world.digest() == read.worlds[0].digest()
    assert world.lost_deaths == len(ids) - ROOM
    assert world.waiting_deaths == len(ids) / ROOM
    with pytest.raises(
        EngineError, match=rf"world 0: {len(ids) - ROOM:,} deaths are lost, since more than {ROOM} came"
    ):
        world.deaths()
    assert world.lost_deaths == len(ids) - ROOM  # nothing was taken
    late = world.deaths(partial=True)
    np.testing.assert_array_equal(late["agent_id"], ids[-ROOM:])  # the newest, oldest first
    assert (np.diff(late["death_step"]) >= 0).all()
    assert all(len(column) == ROOM for column in late.values())
    assert (world.lost_deaths, world.waiting_deaths) == (0, 0.0)
    unread.run(64)
    read.run(64)
    np.testing.assert_array_equal(world.deaths()["agent_id"], read.worlds[0].deaths()["agent_id"])


def test_the_last_row_is_not_lost():
    """All deaths are kept until the room is full; one more replaces the first."""
    simulation = make()
    world = simulation.worlds[0]
    while world.counters["deaths"] < ROOM:
        simulation.run(1)
        before = world.counters["deaths"]
        if before <= ROOM:
            assert world.lost_deaths == 0
    assert world.lost_deaths == world.counters["deaths"] - ROOM
    first = world.view("death_log.agent_id").copy()
    while world.lost_deaths == 0:
        simulation.run(1)
    assert world.deaths(partial=True)["agent_id"][0] != first[0]


def test_lost_deaths_do_not_affect_a_checkpoint():
    read, unread = make(), make()
    for _ in range(200):
        read.run(16)
        read.worlds[0].deaths()
        unread.run(16)
    assert unread.worlds[0].lost_deaths > 0
    one, other = (simulation.engine.save(0) for simulation in (read, unread))
    assert one.keys() == other.keys()
    for name, values in one.items():
        np.testing.assert_array_equal(values, other[name], err_msg=name)


def test_driven_worlds_never_end():
    worlds = hedon.make(CONFIG, 2, seed=1, threads=1)
    group = worlds.groups["agent"]
    died = 0
    while died <= 4 * ROOM:
        worlds.step(worlds.actions)
        died += int(group.deaths.min())
    worlds.repeat = 500
    worlds.step(worlds.actions)
    for world in worlds.simulation.worlds:
        assert world.lost_deaths > 0
        assert len(world.deaths(partial=True)["agent_id"]) == ROOM


def test_a_pettingzoo_world_never_ends():
    pytest.importorskip("pettingzoo", reason='needs the optional packages: pip install "hedon[env]"')
    from hedon.env import ParallelEnv

    world = ParallelEnv(CONFIG)
    world.reset(seed=1)
    died = 0
    while died <= 2 * ROOM:
        _, _, ended, _, _ = world.step({})
        died += sum(ended.values())
        assert world.agents
    assert world.simulation.worlds[0].counters["deaths"] == died


@pytest.mark.more
def test_a_device_keeps_the_same_deaths(emulated: str):
    processor, device = make("avx2"), make(emulated)
    for simulation in (processor, device):
        simulation.run(64 * 40)
    rows = []
    for simulation in (processor, device):
        world = simulation.worlds[0]
        assert world.lost_deaths > 0
        rows.append((world.lost_deaths, world.deaths(partial=True)))
    assert rows[0][0] == rows[1][0]
    for name, values in rows[0][1].items():
        np.testing.assert_array_equal(values, rows[1][1][name], err_msg=name)
    for simulation in (processor, device):
        simulation.run(64)
    np.testing.assert_array_equal(processor.worlds[0].deaths()["agent_id"], device.worlds[0].deaths()["agent_id"])
