"""A seed gives the same life, bit for bit, however it is computed."""

import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from worlds import QUICK, RELEASED, make_engine, make_simulation

from hedon.error import EngineError

STEPS = 200  # three windows of 64 steps and a remainder
LIVELY = (*QUICK, "birth.kappa=0.02", "hazard.kappa=0.2")
"""Births and deaths every few steps, so slots are reused."""


def _digests(seeds=(7,), threads=1, pieces=(STEPS,), preset="baseline", settings=()):
    simulation = make_simulation(*LIVELY, *settings, preset=preset, seeds=seeds, threads=threads)
    for steps in pieces:
        simulation.run(steps)
    assert simulation.worlds[0].counters["births"] > 20
    return dict(zip(seeds, (world.digest() for world in simulation.worlds), strict=True))


def test_the_same_seed_repeats_a_life_and_another_does_not():
    first, second = _digests((7, 8)), _digests((7, 8))
    assert first == second
    assert first[7] != first[8]


@pytest.mark.parametrize("threads", [2, 3, 5])
def test_threads_change_nothing(threads):
    assert _digests(threads=threads) == _digests()


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_other_worlds_change_nothing(threads):
    together = _digests((7, 3, 11, 4, 5), threads)
    for seed in (7, 4):
        assert together[seed] == _digests((seed,))[seed]


@pytest.mark.parametrize("pieces", [(1,) * STEPS, (63, 1, 1, 135), (64, 64, 72)])
def test_the_size_of_the_pieces_changes_nothing(pieces):
    assert _digests(pieces=pieces) == _digests()


@pytest.mark.parametrize("preset", ["relocation", "poison"])
def test_other_presets_repeat_themselves_on_any_threads(preset):
    assert _digests(preset=preset, threads=2) == _digests(preset=preset)


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_the_released_program_repeats_itself(threads):
    together = _digests((7, 3, 11), threads, pieces=(63, 1, 1, 135), settings=RELEASED)
    assert together[7] == _digests((7,), settings=RELEASED)[7]


@pytest.mark.parametrize("settings", [(), RELEASED], ids=["corrected", "released"])
def test_which_slot_an_agent_gets_changes_nothing(settings):
    plain = make_engine(*LIVELY, *settings)
    shuffled = make_engine(*LIVELY, *settings, slot_order=np.random.default_rng(0).permutation(200).tolist())
    for engine in (plain, shuffled):
        engine.run(STEPS)
    a, b = plain.living_rows(0), shuffled.living_rows(0)
    assert len(a["agent_id"]) > 20
    for name in a:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)
    np.testing.assert_array_equal(plain.observations(0), shuffled.observations(0))
    slots = [engine.view(0, "living")[: len(a["agent_id"])] for engine in (plain, shuffled)]
    assert not np.array_equal(*slots)
    for name in ("physics.bodies.x", "physics.bodies.angular_velocity", "params", "second_moment"):
        np.testing.assert_array_equal(plain.view(0, name)[slots[0]], shuffled.view(0, name)[slots[1]], err_msg=name)
    assert plain.counters(0) == shuffled.counters(0)


def test_a_second_caller_is_refused_while_the_engine_runs():
    simulation = make_simulation()
    thread = threading.Thread(target=simulation.run, args=(4000,))
    thread.start()
    time.sleep(0.2)  # let it start; it then runs for several seconds
    with pytest.raises(EngineError, match="busy"):
        simulation.run(1)
    thread.join()
    assert simulation.worlds[0].step == 4000


def test_other_busy_processes_neither_stop_a_team_nor_change_anything():
    # With as many busy processes as processors, the team switches between stepping together and alone.
    # They exit by themselves if this process crashes.
    hog = [sys.executable, "-c", "import time; end = time.time() + 120\nwhile time.time() < end: pass"]
    hogs = [subprocess.Popen(hog) for _ in range(os.cpu_count() or 1)]
    try:
        simulation = make_simulation(*LIVELY, seeds=(7,), threads=2)
        thread = threading.Thread(target=simulation.run, args=(1000,), daemon=True)
        thread.start()
        thread.join(timeout=120)
        assert not thread.is_alive(), "the members of the team are waiting for one another"
    finally:
        for process in hogs:
            process.kill()
    assert simulation.worlds[0].digest() == _digests(pieces=(1000,))[7]
