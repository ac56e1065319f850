"""A saved and restored world continues as if nothing had happened, bit for bit."""

import numpy as np
import pytest
from worlds import QUICK, RELEASED, make_engine, make_simulation

LIVELY = (*QUICK, "birth.kappa=0.02", "hazard.kappa=0.2")
WINDOW = 64

# How each array of the state gets into a checkpoint. An array that is neither saved nor listed here would be lost.
DERIVED = {"alive", "living", "free", "free_count", "folded_bias", "packed_weights"}
TAKEN_BY_READER = {"death_log", "death_log_species", "death_log_cause", "death_log_eaten", "death_log_genome"}
FROM_CONFIG = {"physics.walls"}
IMPULSES = {"physics.neighbors", "physics.body_grid", "physics.circle_grid"}
SAVED_AS = {
    "physics.bodies": "body",
    "physics.circles": "food",
    "fault": None,
}


def continued(pieces, *, saved_at, preset="baseline", threads=1, slot_order=(), settings=()):
    """A world that was moved into a new simulation after `saved_at` steps and then continued."""
    first = make_simulation(*LIVELY, *settings, preset=preset, seeds=(3,), threads=threads)
    first.run(saved_at)
    second = make_simulation(*LIVELY, *settings, preset=preset, seeds=(3,), threads=threads)
    second.run(5)  # restoring replaces this state
    second.engine.restore(0, first.engine.save(0))
    assert second.worlds[0].digest() == first.worlds[0].digest()
    for steps in pieces:
        second.run(steps)
    return second.worlds[0]


def left_alone(steps, preset="baseline", settings=()):
    simulation = make_simulation(*LIVELY, *settings, preset=preset, seeds=(3,))
    simulation.run(steps)
    return simulation.worlds[0]


@pytest.mark.parametrize("weights", ["float32", "bfloat16"])
def test_weights_for_acting_are_derived_from_what_is_restored(weights):
    other = "float32" if weights == "bfloat16" else "bfloat16"
    first = make_simulation(*LIVELY, f'learning.acting_weights="{other}"', seeds=(3,))
    first.run(100)
    lives = [make_simulation(*LIVELY, f'learning.acting_weights="{weights}"', seeds=(3,)) for _ in range(2)]
    lives[1].run(5)  # restoring replaces this state
    for life in lives:
        life.engine.restore(0, first.engine.save(0))
        life.run(50)
    first.run(50)
    ends = [life.worlds[0].digest() for life in lives]
    assert ends[0] == ends[1] != first.worlds[0].digest()


@pytest.mark.parametrize(
    ("saved_at", "preset"),
    [
        *((step, "baseline") for step in (0, 1, WINDOW - 1, WINDOW, WINDOW + 1, 3 * WINDOW)),
        *((200, preset) for preset in ("poison", "relocation")),
    ],
)
def test_a_restored_world_has_the_same_future(saved_at, preset):
    world, other = continued([150], saved_at=saved_at, preset=preset), left_alone(saved_at + 150, preset)
    assert world.digest() == other.digest()
    assert world.counters == other.counters
    for name, values in world.agents().items():
        np.testing.assert_array_equal(values, other.agents()[name])


@pytest.mark.parametrize("saved_at", [0, 1, WINDOW - 1, WINDOW, 2 * WINDOW + 30])
def test_the_released_program_has_the_same_future(saved_at):
    """Waiting newborns, what the dead left in free slots, and eaten food that is still seen are state, too."""
    world = continued([150], saved_at=saved_at, settings=RELEASED, threads=2)
    assert world.digest() == left_alone(saved_at + 150, settings=RELEASED).digest()


@pytest.mark.parametrize("settings", [(), RELEASED], ids=["corrected", "released"])
def test_a_world_may_be_saved_at_every_step(settings):
    few = (*LIVELY, *settings, "population.capacity=40", "population.initial_count=30")
    simulation, other = (make_simulation(*few, seeds=(3,)) for _ in range(2))
    for _ in range(2 * WINDOW + 5):
        simulation.engine.restore(0, simulation.engine.save(0))
        simulation.run(1)
        other.run(1)
        assert simulation.worlds[0].digest() == other.worlds[0].digest()


def test_a_jam_continues_under_either_solver():
    """Impulses are state: the same world without them has a different future."""
    for solver in ("sequential", "jacobi"):
        jam = (f'physics.solver="{solver}"', "population.initial_count=150")
        world = continued([100], saved_at=200, settings=jam, threads=2)
        assert world.digest() == left_alone(300, settings=jam).digest()


def test_impulses_of_the_jacobi_solver_are_saved():
    jam = (*LIVELY, 'physics.solver="jacobi"', "population.initial_count=150")
    lives = [make_simulation(*jam, seeds=(3,)) for _ in range(2)]
    lives[0].run(200)
    saved = lives[0].engine.save(0)
    assert len(saved["pair.body"]) > 5
    saved["pair.body"], saved["impulse.body"] = saved["pair.body"][:0], saved["impulse.body"][:0]
    lives[1].engine.restore(0, saved)
    for life in lives:
        life.run(1)
    assert lives[0].worlds[0].digest() != lives[1].worlds[0].digest()


def test_threads_may_change_in_between():
    assert continued([100, 100], saved_at=100, threads=2).digest() == left_alone(300).digest()


def test_a_pushing_crowd_keeps_pushing():
    crowd = ("population.capacity=300", "population.initial_count=200", "motor.min_force=20", *LIVELY)
    first, second, third = (make_simulation(*crowd) for _ in range(3))
    first.run(150)
    saved = first.engine.save(0)
    assert len(saved["pair.body"]) > 10
    assert len(saved["pair.wall"]) > 3
    assert (saved["impulse.body"][:, 0] > 0).any()
    second.engine.restore(0, saved)
    third.engine.restore(0, saved | {name: saved[name][:0] for name in ("pair.body", "impulse.body")})
    for simulation in (first, second, third):
        simulation.run(150)
    assert first.worlds[0].digest() == second.worlds[0].digest()
    assert first.worlds[0].digest() != third.worlds[0].digest(), "impulses made no difference"


@pytest.mark.parametrize("settings", [(), RELEASED], ids=["corrected", "released"])
def test_slots_and_reads_do_not_affect_a_digest(settings):
    plain = make_engine(*LIVELY, *settings)
    shuffled = make_engine(*LIVELY, *settings, slot_order=np.random.default_rng(1).permutation(200).tolist())
    for _ in range(4):
        plain.run(50)
        shuffled.run(50)
        shuffled.take_rows(0)
    assert plain.head(0)["death_log_count"] > shuffled.head(0)["death_log_count"]
    assert plain.digest(0) == shuffled.digest(0)


def test_a_dead_world_stays_dead():
    lethal = ("hazard.kappa=1", "energy.initial=0", "birth.kappa=0", *QUICK)
    first, second = (make_simulation(*lethal) for _ in range(2))
    first.run(5000)
    assert first.worlds[0].extinct
    second.engine.restore(0, first.engine.save(0))
    second.run(100)
    assert second.worlds[0].extinct_step == first.worlds[0].extinct_step
    assert second.worlds[0].digest() == first.worlds[0].digest()


def test_every_array_of_the_state_is_saved_or_derived_from_others():
    engine = make_engine(*LIVELY, *RELEASED)
    engine.run(WINDOW + 1)
    saved = set(engine.save(0))
    for path in engine.view_names():
        if engine.view(0, path).size == 0:  # of a rule that this world does not use
            continue
        if path.split(".")[0] in DERIVED | TAKEN_BY_READER or path.startswith(tuple(FROM_CONFIG | IMPULSES)):
            continue
        for prefix, name in SAVED_AS.items():
            if path.startswith(prefix):
                path = None if name is None else path.replace(prefix, name)
                break
        derived = path in (None, "head.death_log_count", "head.death_log_lost", "food.present")
        assert derived or path in saved, path
