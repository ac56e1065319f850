"""Simulations for tests: small and fast, with the same configs that users have."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hedon import _engine
from hedon.config.dump import diff
from hedon.config.engine import engine_input
from hedon.config.load import load_config
from hedon.experiment.simulation import Simulation

QUICK = ("world.rollout_steps=64", "learning.minibatch_size=32", "learning.update_epochs=2")
"""Short windows, so that a test covers several."""
STILL = ("motor.min_force=-1e-6", "motor.max_force=1e-6")
"""Motors too weak to move an agent."""
DEATHLESS = ("hazard.kappa=0", "hazard.alpha_age=0")
CHILDLESS = ("birth.kappa=0",)
RELEASED = tuple(
    f"{path}={value}" for path, _, value in diff(load_config("baseline"), load_config("baseline", "released"))
)
"""The settings that differ in the paper's program, with one kind of food."""


def make_simulation(
    *overrides: str, preset: str = "baseline", seeds: Sequence[int] = (1,), threads: int = 1, backend: str = ""
) -> Simulation:
    """A simulation of a preset with overrides, on one thread by default."""
    return Simulation(load_config(preset, overrides=overrides), seeds, threads, backend)


def make_engine(
    *overrides: str, slot_order: Sequence[int] = (), seeds: Sequence[int] = (1,), flush_denormals: bool = True
) -> Any:
    """The bare engine, for features that the Python class does not offer."""
    given = engine_input(load_config("baseline", overrides=overrides))
    return _engine.Simulation(
        given.settings, given.walls, given.outer_walls, list(seeds), 1, "", list(slot_order), flush_denormals
    )


def set_scene(
    simulation: Simulation,
    agents: ArrayLike,
    foods: ArrayLike = (),
    kinds: ArrayLike | None = None,
    energy: float = 40.0,
    species: ArrayLike | None = None,
) -> None:
    """Replaces world 0 with agents (x, y, angle) and foods (x, y), by default of the first species and of kind 0."""
    body = np.asarray(agents, np.float32).reshape(-1, 3)
    food = np.asarray(foods, np.float32).reshape(-1, 2)
    kind = np.zeros(len(food), np.int32) if kinds is None else np.asarray(kinds, np.int32)
    x, y, angle = (np.ascontiguousarray(column) for column in body.T)
    food_x, food_y = (np.ascontiguousarray(column) for column in food.T)
    of = np.zeros(len(body), np.int32) if species is None else np.asarray(species, np.int32)
    simulation.engine.set_scene(0, x, y, angle, np.full(len(body), energy, np.float32), of, food_x, food_y, kind)
