"""A checkpoint may come from anywhere: impossible ones are refused, and accepted ones do not harm the engine.

HEDON_SPOILED=N spoils N worlds of many mechanisms 100 times each instead of 12 worlds 20 times each.
"""

import contextlib
import os
import random
from itertools import islice

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mechanism import Mixture, worlds
from mechanism_data import begin
from worlds import QUICK, RELEASED, make_simulation

from hedon.error import EngineError

WORLDS = int(os.environ.get("HEDON_SPOILED", "12"))
SPOILED = 100 if "HEDON_SPOILED" in os.environ else 20
"""Number of spoiled checkpoints per world."""
CROWD = ("arena.width=220", "arena.height=180", "motor.min_force=20", "food.normal.initial_count=12")
LIVELY = (
    *RELEASED,
    *QUICK,
    *CROWD,
    "birth.kappa=0.1",
    "hazard.kappa=0.2",
    "population.capacity=60",
    "population.initial_count=35",
)
BOUNDED = {  # array: a value that no world has
    "head.step": -1,
    "head.living_count": 61,
    "head.next_agent_id": 0,
    "head.extinct_step": 3,
    "head.births_in_window": -1,
    "head.births_before": -1,
    "head.eaten_food_count": -1,
    "eaten_food.kind": 1,
    "counters.births": 2**54,
    "counters.agent_steps": 2**62,
    "newborn.agent_id": 0,
    "newborn.parent": 30_000,
    "food.slot": 10_000,
    "food.x": -1.0,
    "food_stock.center": 1,
    "food_stock.present": 0,
    "food_stock.number": 1e9,
    "food_stock.eaten": -1,
    "life.agent_id": -1,
    "life.birth_step": 1_000_000,
    "life.death_step": 5,
    "life.parent_id": 2**30,
    "life.generation": 2**30,
    "life.energy": -1.0,
    "touch": 2**63,
    "updates": -1,
    "second_moment": -1.0,
    "body.x": 1e6,
    "body.y": -0.1,
    "body.angle": 1e30,
    "observation": 255,
    "pair.body": 60,
    "pair.circle": -1,
    "pair.wall": 1000,
    "impulse.body": -1.0,
}
PLACE = {"observation": 128, "impulse.body": 0}
"""Where the value goes, if not at the end: the channel of a ray, the normal impulse of a pair."""


@pytest.fixture(scope="module")
def saved():
    simulation = make_simulation(*LIVELY)
    simulation.run(80)  # in the middle of a window, so that there are rollouts
    while simulation.worlds[0].step < 127:
        simulation.run(1)
        arrays = simulation.engine.save(0)
        if all(len(arrays.get(name, ())) for name in BOUNDED):
            return arrays
    raise AssertionError("nothing to spoil")


@pytest.fixture(scope="module")
def target():
    simulation = make_simulation(*LIVELY)
    simulation.run(3)
    return simulation


def refused(target, arrays, words):
    before = target.worlds[0].digest()
    with pytest.raises(ValueError, match=words):
        target.engine.restore(0, arrays)
    assert target.worlds[0].digest() == before, "a refused checkpoint changed the world"


@pytest.mark.parametrize("name", BOUNDED)
def test_a_value_out_of_bounds_is_refused(saved, target, name):
    spoiled = saved[name].copy()
    spoiled.flat[PLACE.get(name, -1)] = BOUNDED[name]
    refused(target, saved | {name: spoiled}, name.replace("impulse", "pair"))


def test_sums_of_the_largest_counts_do_not_overflow(saved, target):
    """The sanitizer for undefined behavior would end the process."""
    counts = {name: np.full_like(saved[name], 2**53) for name in ("counters.births", "counters.agent_steps")}
    target.engine.restore(0, saved | counts)
    with pytest.raises(EngineError, match="counts_inconsistent"):
        target.run(48)  # past the audit at the end of the window
    target.engine.restore(0, saved)


@pytest.mark.parametrize("name", ["first_moment", "second_moment"])
def test_an_unused_optimizer_must_be_empty(saved, target, name):
    """The next agent in the slot starts with what is there."""
    new = int(np.flatnonzero(saved["updates"] == 0)[-1])
    spoiled = saved[name].copy()
    spoiled[new, 3] = 1e-9
    refused(target, saved | {name: spoiled}, f"{name} is not 0 for an agent whose updates are")


def test_every_array_is_checked_for_presence_type_shape_and_finite_numbers(saved, target):
    for name, array in saved.items():
        refused(target, {key: value for key, value in saved.items() if key != name}, name)
        refused(target, saved | {name: array.astype(np.complex64)}, name)
        refused(target, saved | {name: array.astype(np.int16)}, name)
        refused(target, saved | {name: np.concatenate([array, array])}, r"\w")
        if array.dtype.kind == "f" and array.size:
            for value in (np.nan, np.inf):
                spoiled = array.copy()
                spoiled.flat[array.size // 2] = value
                refused(target, saved | {name: spoiled}, r"\w")
    refused(target, saved | {"more": np.zeros(3)}, "an unknown array")
    refused(target, saved | {"params": np.array(["x"])}, "params")
    refused(target, saved | {"params": saved["params"].T}, "params")


@pytest.mark.parametrize("name", ["life.agent_id", "life.birth_step", "food.slot", "pair.circle"])
def test_an_array_out_of_order_is_refused(saved, target, name):
    assert len(saved[name]) > 1
    refused(target, saved | {name: np.ascontiguousarray(saved[name][::-1])}, name)


def test_a_checkpoint_of_another_shape_says_so(saved):
    for setting, array in (
        ("sensor.ray_count=12", "params"),
        ("genome.neutral_count=3", "genome"),
        ("population.capacity=20", "head.living_count"),
        ("food.normal.capacity=20", "food.slot|food_stock.number"),
    ):
        other = make_simulation(*LIVELY, "population.initial_count=20", "food.normal.initial_count=5", setting)
        refused(other, saved, array)


def spoil(saved, draw):
    """A checkpoint with some numbers replaced by random bytes or by a small or extreme value."""
    spoiled = dict(saved)
    names = sorted(name for name, array in saved.items() if array.size)
    for name in draw.choices(names, k=draw.randint(1, 3)):
        array = spoiled[name].copy()
        at = draw.randrange(array.size)
        number = draw.choice(EDGES)
        with np.errstate(over="ignore", invalid="ignore"):
            edge = np.array([number]).astype(array.dtype)[0]
        noise = np.frombuffer(draw.randbytes(array.itemsize), array.dtype)[0]
        array.reshape(-1)[at] = draw.choice((edge, noise))
        spoiled[name] = array
    return spoiled


EDGES = (-1, 0, 1, 2, 3, 7, 63, 64, 255, 10_000, 2**31 - 1, -(2**31), 1e-30, -0.5, 1e6, 3e38)
CALM = ("curious", "swamp", "uncrowded")
"""Mechanisms left out, since compiling their rules for each world takes longer than the simulation."""


def mixtures(count):
    """Worlds of many mechanisms, different from those in the test of combinations."""
    for world, _ in islice(worlds(3, 18), count):
        kept = tuple(part for part in world.parts if part.mechanism.name not in CALM)
        yield Mixture(world.species, kept)


@pytest.mark.repeated
@pytest.mark.parametrize("number", range(WORLDS))
def test_spoiled_worlds_of_every_mechanism_are_refused_or_do_no_harm(number, tmp_path):
    """Accepted worlds are simulated past the learning of their window. A signal ends the test with its number shown."""
    world = next(islice(mixtures(WORLDS), number, None))
    config, draw = world.config(tmp_path), random.Random(number)
    simulation = begin(world, config, (5,), 1)
    target = begin(world, config, (5,), 1)
    taken: list[bool] = []
    for _ in range(SPOILED // 10):
        simulation.run(draw.randrange(1, 20))
        saved = simulation.engine.save(0)
        for _ in range(10):
            taken.append(False)
            with contextlib.suppress(ValueError, EngineError):
                target.engine.restore(0, spoil(saved, draw))
                taken[-1] = True
                target.run(draw.choice((3, 40)))
            for species in range(len(config.species)):
                target.worlds[0].observations(species)
    assert 0 < sum(taken) < len(taken)


def test_random_numbers_are_refused_or_do_no_harm(saved):
    """One to three numbers of any arrays get random bytes; accepted worlds are then simulated."""
    passed = []

    @settings(max_examples=150, deadline=None)
    @given(data=st.data())
    def trial(data: st.DataObject) -> None:
        passed.append(passes(saved, data))

    trial()
    assert 0.1 < sum(passed) / len(passed) < 0.9


def passes(saved, data: st.DataObject) -> bool:
    """Whether the engine accepts the arrays with some numbers replaced; simulates the world if so."""
    spoiled = dict(saved)
    for _ in range(data.draw(st.integers(1, 3))):
        name = data.draw(st.sampled_from(sorted(name for name, array in saved.items() if array.size)))
        array = saved[name].copy()
        at = data.draw(st.integers(0, array.size - 1))
        raw = data.draw(st.binary(min_size=array.itemsize, max_size=array.itemsize))
        array.reshape(-1)[at] = np.frombuffer(raw, array.dtype)[0]
        spoiled[name] = array
    simulation = make_simulation(*LIVELY)
    taken = False
    with contextlib.suppress(ValueError, EngineError):
        simulation.engine.restore(0, spoiled)
        taken = True
        simulation.run(48)  # from step 81 or later past the learning at step 128
    simulation.worlds[0].observations()
    return taken
