"""Rigid bodies alone: one physics step of a populated arena, on one and more threads."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.check import require, require_finite
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, seconds_of, spread
from benchmarks.plan import Plan
from benchmarks.scene import peopled, scene_of
from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_config
from hedon.config.schema.arena import walls
from hedon.config.schema.species import ONLY

PIECE_STEPS = 20
"""Steps after which motor forces change."""
PIECES = 100
FIELDS = ("x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity")
KINDS = ("body", "circle", "wall")


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row per number of threads: the bodies and foods of a populated world under random motor forces."""
    config = plan.config()
    scenes = {threads: make_scene(plan) for threads in plan.threads}
    pieces = 3 if plan.quick else PIECES
    bodies = len(scenes[plan.threads[0]].array("x"))
    motor = config.species[ONLY].motor
    all_forces = np.random.default_rng(1).uniform(motor.min_force, motor.max_force, (pieces, 2, bodies))
    times: dict[int, list[float]] = {threads: [] for threads in plan.threads}
    for forces in all_forces:
        for threads, scene in scenes.items():
            drive(config, scene, *forces)
            times[threads].append(seconds_of(lambda s=scene, n=threads: s.step(PIECE_STEPS, n, record=False)))
    states = {threads: np.array([scene.array(name) for name in FIELDS]) for threads, scene in scenes.items()}
    for threads, state in states.items():
        _check(config, threads, state, states[plan.threads[0]])
    return [
        {
            "threads": threads,
            "bodies": bodies,
            "circles": len(scene.array("circle_x")),
            "listed_pairs": sum(len(scene.pairs(kind)) for kind in KINDS),
            "rebuilds_per_step": scene.counters()["builds"] / (PIECE_STEPS * pieces),
            "step_seconds": [t / PIECE_STEPS for t in times[threads]],
        }
        for threads, scene in scenes.items()
    ]


def make_scene(plan: Plan) -> Any:
    """The bodies and foods of the populated world, at rest."""
    config, start = plan.config(), scene_of(peopled(plan))
    arena, body = config.arena, config.species[ONLY].body
    scene = _engine.physics.Scene(
        engine_config(config)["physics"],
        arena.width,
        arena.height,
        body.radius,
        body.density,
        config.world.food_radius,
        len(start.x),
        len(start.food_x),
        walls(arena).tolist(),
    )
    for name, values in (("x", start.x), ("y", start.y), ("angle", start.angle)):
        scene.array(name)[:] = values
    scene.array("circle_x")[:], scene.array("circle_y")[:] = start.food_x, start.food_y
    scene.array("circle_present")[:] = 1
    scene.set_order(list(range(len(start.x))))
    return scene


def drive(config: Config, scene: Any, left: NDArray, right: NDArray) -> None:
    """Sets force and torque from the two motors of each body."""
    angle = scene.array("angle")
    scene.array("force_x")[:] = -np.sin(angle) * (left + right)
    scene.array("force_y")[:] = np.cos(angle) * (left + right)
    species_config = config.species[ONLY]
    arm = species_config.body.radius * math.sin(math.radians(species_config.motor.angle))
    scene.array("force_torque")[:] = (right - left) * arm


def _check(config: Config, threads: int, state: NDArray, first: NDArray) -> None:
    require_finite(f"physics, {threads} threads", state)
    x, y = state[:2]
    inside = (x > 0) & (x < config.arena.width) & (y > 0) & (y < config.arena.height)
    require(bool(inside.all()), f"physics, {threads} threads: {np.sum(~inside)} bodies are outside the walls")
    require(np.array_equal(state, first), f"physics: the state at the end differs between {threads} threads and one")


def table(rows: list[Row], _: Calibration) -> Table:
    """Milliseconds per step."""
    first = rows[0]
    title = f"physics: one step of {first['bodies']} bodies and {first['circles']} foods"
    lines = [
        (
            str(row["threads"]),
            spread(row["step_seconds"], 4, 1e3),
            f"{min(row['step_seconds']) * 1e3:.4f}",
            str(row["listed_pairs"]),
            f"{row['rebuilds_per_step']:.2f}",
        )
        for row in rows
    ]
    return Table(title, ("threads", "step [ms]", "best [ms]", "listed pairs", "rebuilds per step"), lines)
