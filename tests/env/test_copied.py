"""Copies of environments of every kind continue as the original would, and change nothing in it."""

import copy
import importlib.util
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, Simulation, env, load_config, make
from hedon.env.group import Group, Held

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=12", "population.initial_count=8")
CONFIG = load_config("baseline", overrides=LIVELY)
STEPS = 12


def _agent() -> tuple[Any, Callable[[Any], Any]]:
    made = env.AgentEnv(CONFIG, seed=3)
    seen = [made.reset(seed=3)[0]]

    def go_on(of: Any) -> Any:
        told = [of.step(np.array([0.3, -0.2], np.float32))]
        if told[0][2]:
            seen[:] = [of.reset()[0]]
            told.append(seen[0])
        return told, of.simulation.worlds[0].digest()

    return made, go_on


def _parallel(slots: bool) -> tuple[Any, Callable[[Any], Any]]:
    made = env.ParallelEnv(CONFIG, seed=3, slots=slots)
    made.reset(seed=3)

    def go_on(of: Any) -> Any:
        actions = {name: np.array([0.3, -0.2], np.float32) for name in of.agents}
        return of.step(actions), list(of.agents), of.simulation.worlds[0].digest()

    return made, go_on


def _vector() -> tuple[Any, Callable[[Any], Any]]:
    made = make(CONFIG, 2, seed=3)
    made.reset()

    def go_on(of: Any) -> Any:
        of.actions[...] = 0.3
        return copy.deepcopy(of.step(of.actions)), [world.digest() for world in of.simulation.worlds]

    return made, go_on


def _slot() -> tuple[Any, Callable[[Any], Any]]:
    made = env.SlotVecEnv(make(CONFIG, 2, seed=3))
    made.reset()

    def go_on(of: Any) -> Any:
        return of.step(np.full((24, 2), 0.3, np.float32))[:3], [world.digest() for world in of.worlds.simulation.worlds]

    return made, go_on


def _jax() -> tuple[Any, Callable[[Any], Any]]:
    import jax

    made = env.JaxEnv(CONFIG, 2, threads=1)
    keys = jax.random.split(jax.random.key(0), 2)
    states = {}
    states[id(made)] = start = jax.vmap(made.reset)(keys)[1]

    def go_on(of: Any) -> Any:
        state = states.get(id(of), start)
        seen, states[id(of)], paid, *_ = jax.vmap(of.step)(keys, state, jax.numpy.full((2, 12, 2), 0.3))
        return np.asarray(seen), np.asarray(paid), [world.digest() for world in of.simulation.worlds]

    return made, go_on


KINDS = {
    "vector": _vector,
    "agent": _agent,
    "parallel": lambda: _parallel(slots=False),
    "slots": lambda: _parallel(slots=True),
    "slot": _slot,
    "jax": _jax,
}
NEEDS = {"slot": "stable_baselines3", "jax": "jax"}
WAYS = {
    "clone": lambda made: made.clone(),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda made: pickle.loads(pickle.dumps(made)),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_copy_continues_as_the_original_would(kind, way):
    if kind in NEEDS and importlib.util.find_spec(NEEDS[kind]) is None:
        pytest.skip(f"needs {NEEDS[kind]}")
    made, go_on = KINDS[kind]()
    if kind != "jax":  # whose states form one line: the copy's states start where the original's are
        for _ in range(3):
            go_on(made)
    made_too = WAYS[way](made)
    told = [go_on(made) for _ in range(STEPS)]
    np.testing.assert_equal([go_on(made_too) for _ in range(STEPS)], told)
    for of in (made, made_too):
        simulation = of.worlds.simulation if kind == "slot" else of.simulation
        assert simulation._driven, "nothing else may step it"


class _Named(Simulation):
    note = "none"


@pytest.mark.parametrize("way", WAYS)
def test_copies_take_over_what_users_add(way):
    simulation, worlds = _Named(CONFIG, [1]), make(CONFIG, seed=1)
    for of in (simulation, worlds):
        vars(of)["note"] = ["mine"]
        copied: Any = WAYS[way](of)
        assert (type(copied), copied.note) == (type(of), ["mine"])
        assert copied.note is not vars(of)["note"]


def test_a_world_is_copied_with_its_simulation():
    world = Simulation(CONFIG, [1]).worlds[0]
    for way in (copy.copy, copy.deepcopy, pickle.dumps):
        for of in (world, world.state) if way is not copy.copy else (world,):
            with pytest.raises(ArgumentError, match="copy or pickle the simulation"):
                way(of)


ARRAYS = sorted(name for name in vars(Group) if isinstance(vars(Group)[name], Held))


@pytest.mark.parametrize("name", ARRAYS)
@pytest.mark.parametrize("change", ["shape", "dtype"])
def test_arrays_in_another_form_are_refused(name, change):
    worlds = make(CONFIG, 2, seed=1)
    worlds.reset()
    array = getattr(worlds.groups["agent"], name)
    if change == "shape":
        array.shape = (-1,) if array.ndim > 1 else (2, 1)
    else:
        array.dtype = f"V{array.dtype.itemsize}"
    for call in (worlds.reset, lambda: worlds.step(np.zeros((2, 12, 2), np.float32))):
        with pytest.raises(ArgumentError, match=f"{name}: must be as it was made"):
            call()
