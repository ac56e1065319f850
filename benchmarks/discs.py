"""Crowds of driven discs without food, in arenas of different sizes."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.check import require, require_finite
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, seconds_of, spread
from benchmarks.physics import FIELDS, drive
from benchmarks.plan import Plan
from hedon import _engine
from hedon.config.engine import engine_config
from hedon.config.schema.species import ONLY

SIZES = (150, 2_000, 20_000)
"""Numbers of discs: as many as agents in the baseline, and 13 and 130 times as many."""
AREA = 700.0
"""Area per disc [u²]: discs of the usual radius cover 45 % of it."""
PIECE_STEPS = 20
"""Steps after which motor forces change."""
PIECES = 20


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row per number of discs and threads; all numbers of threads must give the same bits.

    A list of neighbors lasts for two steps if motors are strong, as in the preset `appetite`, and for three in the
    baseline, in which slow discs stay within the usual skin.
    """
    sizes = (SIZES[0],) if plan.quick else (plan.slots or SIZES)
    pieces = 3 if plan.quick else PIECES
    return [row for discs in sizes for row in _rows(plan, discs, pieces)]


def _rows(plan: Plan, discs: int, pieces: int) -> list[Row]:
    config = plan.config()
    motor = config.species[ONLY].motor
    scenes = {threads: make_scene(plan, discs) for threads in plan.threads}
    times: dict[int, list[float]] = {threads: [] for threads in plan.threads}
    rng = np.random.default_rng(1)
    for _ in range(pieces):
        forces = rng.uniform(motor.min_force, motor.max_force, (2, discs))
        for threads, scene in scenes.items():
            drive(config, scene, *forces)
            times[threads].append(seconds_of(lambda s=scene, n=threads: s.step(PIECE_STEPS, n, record=False)))
    states = {threads: _state(scene) for threads, scene in scenes.items()}
    for threads, state in states.items():
        require_finite(f"{discs} discs, {threads} threads", state)
        same = np.array_equal(state, states[plan.threads[0]])
        side = side_of(discs, config.species[ONLY].body.radius)
        require(bool(((state[:2] > 0) & (state[:2] < side)).all()), f"{discs} discs: some are outside the walls")
        require(same, f"{discs} discs: the state at the end differs between {threads} threads and {plan.threads[0]}")
    return [
        {
            "discs": discs,
            "threads": threads,
            "contacts": sum(normal > 0 for _, _, normal, _, _ in scene.pairs("body")),
            "rebuilds_per_step": scene.counters()["builds"] / (PIECE_STEPS * pieces),
            "step_seconds": [t / PIECE_STEPS for t in times[threads]],
        }
        for threads, scene in scenes.items()
    ]


def side_of(discs: int, radius: float) -> float:
    """Side of the square arena [u], at least wide enough for a few discs."""
    return max(math.sqrt(discs * AREA), 8 * radius)


def make_scene(plan: Plan, discs: int) -> Any:
    """Discs at rest at random places of a grid, with random headings."""
    config = plan.config()
    body = config.species[ONLY].body
    side = side_of(discs, body.radius)
    across = math.ceil(math.sqrt(1.2 * discs))
    places = np.linspace(3 * body.radius, side - 3 * body.radius, across)
    rng = np.random.default_rng(2)
    chosen = rng.permutation(across * across)[:discs]
    corners = [(0.0, 0.0), (0.0, side), (side, side), (side, 0.0)]
    walls = [(*first, *second) for first, second in zip(corners, corners[1:] + corners[:1], strict=True)]
    scene = _engine.physics.Scene(
        engine_config(config)["physics"],
        side,
        side,
        body.radius,
        body.density,
        config.world.food_radius,
        discs,
        0,
        walls,
        outer_walls=len(walls),
    )
    scene.array("x")[:], scene.array("y")[:] = places[chosen % across], places[chosen // across]
    scene.array("angle")[:] = rng.uniform(0, 2 * math.pi, discs)
    scene.set_order(list(range(discs)))
    return scene


def _state(scene: Any) -> NDArray:
    return np.array([scene.array(name) for name in FIELDS])


def table(rows: list[Row], _: Calibration) -> Table:
    """Nanoseconds per disc and step."""
    lines = [
        (
            f"{row['discs']:,}",
            str(row["threads"]),
            spread(row["step_seconds"], 0, 1e9 / row["discs"]),
            str(row["contacts"]),
            f"{row['rebuilds_per_step']:.2f}",
        )
        for row in rows
    ]
    headings = ("discs", "threads", "ns per disc and step", "contacts", "rebuilds per step")
    return Table("discs: one step of a crowd of driven discs", headings, lines)
