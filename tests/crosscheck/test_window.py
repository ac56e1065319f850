"""The input of learning, and which agents learn: rollout rows compared with steps, one update with NumPy."""

from dataclasses import asdict
from typing import Any

import numpy as np
import ppo_reference
import pytest
from acting_weights import as_read
from worlds import QUICK, make_simulation

from hedon import _engine
from hedon.experiment.simulation import Simulation

SEED = 5
WINDOW = 64
LIVELY = (*QUICK, "birth.kappa=0.01", "hazard.kappa=0.1", "energy.initial=4", "food.normal.growth_rate=2")
CASES = {
    "per state": LIVELY,
    "batch mean, unit scale": (*LIVELY, 'learning.critic_target="batch_mean"', 'sensor.scaling="unit"'),
}
ROWS = ("action", "log_prob", "value", "reward")


def network_shape(simulation: Simulation) -> tuple[int, int, int, int]:
    sensor, types = simulation.config.species["agent"].sensor, len(simulation.config.food) + 2
    return sensor.ray_count, types, types * sensor.touch_sectors, 5 if sensor.scaling == "raw" else 6


def rows_of(simulation: Simulation, name: str, slots: Any) -> np.ndarray:
    """A rollout array (agents, steps, …) of the agents in `slots`, copied."""
    table = simulation.worlds[0].view(name)[slots]
    return table.reshape(len(table), WINDOW, -1) if name == "action" else table


def live_a_window(simulation: Simulation) -> dict[int, dict[str, Any]]:
    """Runs a window; returns by id what each agent saw, did and got, and its learner before the last step."""
    world = simulation.worlds[0]
    told: dict[int, dict[str, Any]] = {}
    for t in range(WINDOW):
        slots, ids, seen = world.living.tolist(), world.agents()["agent_id"].tolist(), world.observations()
        learner = {name: world.view(name)[slots] for name in ("params", "first_moment", "second_moment", "updates")}
        simulation.run(1)
        rows = {name: rows_of(simulation, name, slots)[:, t] for name in ROWS}
        for i, agent_id in enumerate(ids):
            mine = told.setdefault(agent_id, {name: [] for name in ("observation", *ROWS)})
            mine["observation"].append(seen[i])
            for name in ROWS:
                mine[name].append(rows[name][i].copy())
            mine |= {name: values[i].copy() for name, values in learner.items()}
            told[agent_id] = mine
    return told


@pytest.mark.parametrize("case", CASES)
def test_a_window_of_learning(case):
    simulation = make_simulation(*CASES[case], seeds=(SEED,))
    world, shape = simulation.worlds[0], network_shape(simulation)
    settings = asdict(simulation.config.species["agent"].learning)
    simulation.run(WINDOW)  # so that moments are not zero and some agents are born later than others
    told = live_a_window(simulation)
    agents, slots, next_seen = world.agents(), world.living, world.observations()
    packed = world.view("observation")[slots].copy()
    learned = unlearned = 0
    for i, agent_id in enumerate(agents["agent_id"].tolist()):
        slot = slots[i]
        after = {name: world.view(name)[slot] for name in ("params", "first_moment", "second_moment", "updates")}
        if agents["birth_step"][i] > WINDOW:
            fresh = _engine.learning.init_network(shape, SEED, agent_id)
            np.testing.assert_array_equal(after["params"], fresh)
            assert not after["first_moment"].any()
            assert not after["second_moment"].any()
            assert after["updates"] == 0
            unlearned += 1
            continue
        mine = told[agent_id]
        rows = {name: np.ascontiguousarray(rows_of(simulation, name, [slot])[0]) for name in ROWS}
        for name in ROWS:
            np.testing.assert_array_equal(rows[name], np.array(mine[name]).reshape(rows[name].shape), err_msg=name)
        # The row after the last step holds the next observation.
        seen = _engine.learning.unpack(shape, np.ascontiguousarray(packed[i]))
        np.testing.assert_array_equal(seen, [*mine["observation"], next_seen[i]])

        bootstrap = _engine.learning.forward(
            simulation.engine.backend, shape, mine["params"], np.ascontiguousarray(packed[i, -1:]), rounded=True
        )[0, 2]
        expected = _engine.learning.learn(
            simulation.engine.backend,
            shape,
            settings,
            mine["params"],
            mine["first_moment"],
            mine["second_moment"],
            int(mine["updates"]),
            np.ascontiguousarray(packed[i, :-1]),
            rows["action"],
            rows["log_prob"],
            rows["value"],
            rows["reward"],
            float(bootstrap),
            SEED,
            agent_id,
            world.step,
        )
        for name, value in zip(("params", "first_moment", "second_moment"), expected, strict=False):
            np.testing.assert_array_equal(after[name], value, err_msg=name)
        assert after["updates"] == expected[3] == mine["updates"] + 4
        learned += 1
    assert learned > 10
    assert unlearned > 5
    assert world.counters["deaths"] > 5


@pytest.mark.parametrize("case", CASES)
def test_the_first_update_matches_plain_ppo(case):
    simulation = make_simulation(*CASES[case], seeds=(SEED,))
    world, settings = simulation.worlds[0], asdict(simulation.config.species["agent"].learning)
    told = live_a_window(simulation)
    agents = world.agents()
    learners = np.flatnonzero(agents["birth_step"] == 0)[:6]
    assert len(learners) == 6
    for i in learners:
        agent_id, mine = int(agents["agent_id"][i]), told[int(agents["agent_id"][i])]
        x, params = np.array(mine["observation"], float), mine["params"].astype(float)
        reward, value = (np.array(mine[name], float) for name in ("reward", "value"))
        acting = as_read(mine["params"]).astype(float)
        bootstrap = ppo_reference.forward(acting, world.observations()[i : i + 1].astype(float))[2][0, 2]
        advantage, next_value, later = np.zeros(WINDOW), bootstrap, 0.0
        for t in reversed(range(WINDOW)):
            later *= settings["gamma"] * settings["gae_lambda"]
            later += reward[t] + settings["gamma"] * next_value - value[t]
            advantage[t], next_value = later, value[t]
        samples = (np.array(mine["action"], float), np.array(mine["log_prob"], float), advantage, advantage + value)
        order = _engine.learning.permutation(SEED, agent_id, WINDOW, WINDOW, settings["update_epochs"])
        expected, _ = ppo_reference.update(params, x, samples, order, settings)
        change, wanted = world.view("params")[world.living[i]] - params, expected - params
        # If a gradient is near Adam's epsilon, its rounding decides; four steps of 3e-4 move at most 1.2e-3.
        assert np.abs(wanted).max() > 5e-4
        assert np.quantile(np.abs(change - wanted), 0.99) < 2e-6
        assert np.abs(change - wanted).max() < 1.2e-3


def test_a_newborn_in_a_used_slot_has_a_new_network():
    simulation = make_simulation(*LIVELY, "population.capacity=60", "hazard.kappa=0.4", seeds=(SEED,))
    world, shape = simulation.worlds[0], network_shape(simulation)
    simulation.run(2 * WINDOW)
    used = world.view("updates") > 0
    reused = 0
    for _ in range(WINDOW - 1):
        simulation.run(1)
        agents = world.agents()
        for i in np.flatnonzero((agents["age"] == 0) & used[world.living]):
            slot = world.living[i]
            fresh = _engine.learning.init_network(shape, SEED, int(agents["agent_id"][i]))
            np.testing.assert_array_equal(world.view("params")[slot], fresh)
            assert not world.view("first_moment")[slot].any()
            assert not world.view("second_moment")[slot].any()
            assert world.view("updates")[slot] == 0
            assert world.view("touch")[slot] == 0
            reused += 1
    assert reused > 3
