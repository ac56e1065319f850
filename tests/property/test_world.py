"""Invariants of every world at any time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import QUICK, make_simulation

LIVELY = (*QUICK, "birth.kappa=0.02", "hazard.kappa=0.2")


def ledger_gap(simulation):
    """The energy that living agents hold, minus what the ledger says they hold."""
    held = simulation.worlds[0].agents()["energy"].sum()
    c = simulation.worlds[0].counters
    income = c["energy_initial"] + c["energy_eaten"] + c["energy_forgiven"]
    return held - (income - c["energy_basic"] - c["energy_action"] - c["energy_capped"] - c["energy_lost"])


@settings(max_examples=12, deadline=None)
@given(
    seed=st.integers(0, 2**64 - 1),
    preset=st.sampled_from(["baseline", "small", "centered", "relocation", "poor", "poison"]),
    initial=st.sampled_from([0.01, 1.0, 40.0, 399.9]),
    starvation=st.sampled_from(["floor", "death"]),
)
def test_the_energy_ledger_closes(seed, preset, initial, starvation):
    overrides = (
        *LIVELY,
        f"energy.initial={initial}",
        f'energy.at_zero="{starvation}"',
        "energy.basic_cost=0.01",
    )
    simulation = make_simulation(*overrides, preset=preset, seeds=(seed,))
    simulation.run(150)
    assert abs(ledger_gap(simulation)) < 1e-7


@pytest.mark.parametrize("preset", ["baseline", "small", "poison"])
def test_ids_are_unique_and_genealogy_has_no_gap(preset):
    simulation = make_simulation(*LIVELY, preset=preset, seeds=(4,))
    dead = []
    for _ in range(10):
        simulation.run(64)
        dead.append(simulation.engine.take_rows(0))
    living = simulation.worlds[0].agents()
    every = {
        name: np.concatenate([*(rows[name] for rows in dead), living[name]]) for name in dead[0].keys() & living.keys()
    }
    order = np.argsort(every["agent_id"])
    every = {name: values[order] for name, values in every.items()}
    counters = simulation.worlds[0].counters
    assert every["agent_id"].tolist() == list(range(50 + counters["births"]))
    assert counters["deaths"] == sum(len(rows["agent_id"]) for rows in dead) > 50
    born = every["parent_id"] >= 0
    parent = every["parent_id"][born]
    assert np.all(parent < every["agent_id"][born])
    assert np.all(every["generation"][born] == every["generation"][parent] + 1)
    assert np.all(every["birth_step"][born] >= every["birth_step"][parent])
    alive = every["death_step"][parent] < 0
    assert np.all(alive | (every["death_step"][parent] >= every["birth_step"][born]))
    np.testing.assert_array_equal(np.bincount(parent, minlength=len(born)), every["children"])
    dead_rows = every["death_step"] >= 0
    assert np.all(every["death_step"][dead_rows] > every["birth_step"][dead_rows])


def test_bodies_stay_inside_and_numbers_finite_in_a_crowd():
    crowd = ("population.initial_count=120", "birth.kappa=0.02", *QUICK, "hazard.kappa=0.002")
    simulation = make_simulation(*crowd, preset="small")
    for _ in range(8):
        simulation.run(64)
        agents = simulation.worlds[0].agents()
        for axis in ("x", "y"):
            assert np.all((agents[axis] > 8) & (agents[axis] < 352))
        assert np.all((agents["angle"] >= 0) & (agents["angle"] < 2 * np.pi))
        for name in ("params", "first_moment", "second_moment", "genome"):
            assert np.all(np.isfinite(simulation.worlds[0].view(name)))
    assert simulation.worlds[0].alive > 150


def test_agents_steps_add_up():
    simulation = make_simulation(*LIVELY, seeds=(9,))
    simulation.run(500)
    dead, living = simulation.engine.take_rows(0), simulation.worlds[0].agents()
    lived = (dead["death_step"] - dead["birth_step"]).sum() + living["age"].sum()
    assert simulation.worlds[0].counters["agent_steps"] == lived


@pytest.mark.parametrize("noise", ["independent", "tabulated"])
def test_mutation_noise_is_cauchy_and_frozen_noise_repeats_by_number_of_birth(noise):
    breeding = (
        *QUICK,
        "birth.kappa=0.05",
        "hazard.kappa=0",
        "genome.weight_limit=1000",
        f'world.mutation_noise="{noise}"',
    )
    simulation = make_simulation(
        *breeding, "population.capacity=600", "arena.width=1500", "arena.height=1500", seeds=(2,)
    )
    tables = []
    for _ in range(2):
        # Frozen noise depends on the number of births in the previous window, so make that equal.
        arrays = simulation.engine.save(0)
        arrays["head.births_before"][:] = 5
        simulation.engine.restore(0, arrays)
        first = simulation.worlds[0].counters["births"]
        simulation.run(64)
        agents = simulation.worlds[0].agents()
        genome = dict(zip(agents["agent_id"].tolist(), agents["genome"], strict=True))
        born = list(range(50 + first, 50 + simulation.worlds[0].counters["births"]))
        tables.append(np.array([genome[i] - genome[agents["parent_id"][i]] for i in born]))
    count = min(len(table) for table in tables)
    assert count > 50
    same = np.isclose(tables[0][:count], tables[1][:count], atol=1e-4).mean()
    assert same > 0.99 if noise == "tabulated" else same < 0.05
    if noise == "independent":
        from scipy import stats

        noises = np.concatenate(tables).ravel() / 0.02
        assert stats.kstest(noises, "cauchy").pvalue > 1e-3
