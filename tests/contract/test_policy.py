"""Policies other than learning: what such agents do, and that they keep nothing for learning."""

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, make_simulation

from hedon import RunPlan, load_config
from hedon.error import ArgumentError

LIVELY = (*QUICK, "birth.kappa=0.02", "hazard.kappa=0.2")
BOTH = (
    *LIVELY,
    "population.capacity=60",
    "population.initial_count=30",
    "species.wise.body.radius=10",
    'species.fool.learning.policy="random"',
)


def lone(policy, *settings, seeds=(1,)):
    """A world without births and deaths, after 30 steps."""
    simulation = make_simulation(*QUICK, *DEATHLESS, *CHILDLESS, f'learning.policy="{policy}"', *settings, seeds=seeds)
    simulation.run(30)
    return simulation.worlds[0]


def test_random_actions_are_standard_normals():
    simulation = make_simulation(*QUICK, *DEATHLESS, *CHILDLESS, 'learning.policy="random"')
    drawn = []
    for _ in range(100):
        simulation.run(1)
        world = simulation.worlds[0]
        drawn.append(world.view("action")[world.living])
    drawn = np.concatenate(drawn)
    assert drawn.shape == (5000, 2)
    assert abs(drawn.mean()) < 5 / np.sqrt(drawn.size)
    assert abs(drawn.std() - 1) < 5 / np.sqrt(2 * drawn.size)
    assert abs(np.corrcoef(drawn.T)[0, 1]) < 5 / np.sqrt(len(drawn))


def test_the_motors_of_idle_agents_never_run():
    world = lone("idle")
    agents = world.agents()
    for name in ("force_left", "force_right", "distance"):
        assert (agents[name] == 0).all()
    assert world.counters["energy_action"] == 0.0


def test_an_external_policy_without_actions_acts_like_the_mean_of_a_new_network():
    agents = lone("external").agents()
    half = (-20.0 + 80.0) / 2
    np.testing.assert_allclose(agents["force_left"], 30 * half, rtol=1e-6)
    np.testing.assert_allclose(agents["force_right"], 30 * half, rtol=1e-6)


@pytest.mark.parametrize("policy", ["random", "idle", "external"])
def test_agents_that_do_not_learn_have_no_network(policy):
    simulation = make_simulation(*LIVELY, f'learning.policy="{policy}"')
    simulation.run(200)
    world = simulation.worlds[0]
    assert world.counters["learners"] == 0
    assert world.view("params").size == 0
    assert world.view("observation").shape[1] == 2  # the current one, and the one after a window
    assert not {"params", "updates", "observation", "reward"} & set(simulation.engine.save(0))


def test_only_the_learners_of_a_mixed_world_learn():
    simulation = make_simulation(*BOTH)
    simulation.run(128)
    world = simulation.worlds[0]
    wise, fool = world.counters_of(0), world.counters_of(1)
    assert wise["learners"] > 0 == fool["learners"]
    species = world.agents()["species"]
    saved = simulation.engine.save(0)
    assert len(saved["params"]) == (species == 0).sum() < len(species)
    assert (world.view("updates")[world.living][species == 1] == 0).all()


@pytest.mark.parametrize("settings", [BOTH, *((*LIVELY, f'learning.policy="{p}"') for p in ("random", "external"))])
@pytest.mark.parametrize("saved_at", [64, 90])
def test_threads_and_checkpoints_change_nothing(settings, saved_at):
    once = make_simulation(*settings, seeds=(3,))
    once.run(200)
    first, second = (make_simulation(*settings, seeds=(3,), threads=threads) for threads in (2, 1))
    first.run(saved_at)
    second.run(5)  # restoring replaces this state
    second.engine.restore(0, first.engine.save(0))
    assert first.worlds[0].digest() == second.worlds[0].digest()
    second.run(200 - saved_at)
    assert second.worlds[0].digest() == once.worlds[0].digest()
    assert once.worlds[0].counters["births"] > 0 < once.worlds[0].counters["deaths"]


def test_late_inheritance_works_without_networks():
    settings = (*BOTH, 'world.inheritance="at_window_end"', 'world.parents="resident_slots"')
    once, other = (make_simulation(*settings, seeds=(3,)) for _ in range(2))
    once.run(90)
    other.engine.restore(0, once.engine.save(0))
    for simulation in (once, other):
        simulation.run(100)
    assert once.worlds[0].digest() == other.worlds[0].digest()


def test_a_run_refuses_the_external_policy(tmp_path):
    config = load_config("baseline", overrides=['learning.policy="external"'])
    with pytest.raises(ArgumentError, match=r"learning\.policy: \"external\" takes actions from a program"):
        RunPlan(config, seeds=(1,), steps=10, out=tmp_path / "run")
