"""All steps from a world to its readings (cells, fans, arcs, culled walls), compared with rays cast at everything."""

from __future__ import annotations

import math

import numpy as np
import pytest
from learning_case import KERNELS
from ray_reference import Scene, cast, is_delicate
from worlds import make_simulation, set_scene

from hedon.config.schema.arena import walls
from hedon.experiment.simulation import Simulation

ROOM = ("population.capacity=300", "food.normal.capacity=300")
CASES = {
    "baseline": (),
    "an arena much larger than rays reach": ("arena.width=4000", "arena.height=3000"),
    "an arena smaller than a fan": (
        "arena.width=150",
        "arena.height=120",
        "population.initial_count=5",
        "food.normal.initial_count=5",
    ),
    "an empty plain": ("arena.width=60000", "arena.height=50000"),
    "a long corridor": ("arena.width=5000", "arena.height=80"),
    "short rays": ("sensor.ray_length=15", "arena.width=900"),
    "long rays": ("sensor.ray_length=1500", "arena.width=2500", "arena.height=2500"),
    "one ray": ("sensor.ray_count=1",),
    "one arc, full": ("sensor.ray_count=16",),
    "two arcs, one ray in the second": ("sensor.ray_count=17", "sensor.ray_spread=89"),
    "half a turn": ("sensor.ray_count=32", "sensor.ray_spread=90"),
    "all around": ("sensor.ray_count=32", "sensor.ray_spread=175"),
    "all around with one arc": ("sensor.ray_count=16", "sensor.ray_spread=175"),
    "foods larger than agents": ("body.radius=4", "world.food_radius=15"),
    "inner walls": ("arena.inner_walls=[[100, 100, 300, 120], [240, 20, 200, 340], [400, 50, 401, 51]]",),
    "many inner walls": (f"arena.inner_walls={[[20 + 9 * i, 60, 24 + 9 * i, 300] for i in range(45)]}",),
}


def reference(simulation: Simulation, agents: np.ndarray, foods: np.ndarray, self: int) -> Scene:
    """What surrounds one agent, relative to it, as plain arrays."""
    config = simulation.config
    center, heading = agents[self, :2], agents[self, 2]
    others = np.delete(agents, self, 0)[:, :2]
    own = config.species["agent"]
    radius = np.r_[np.full(len(others), own.body.radius), np.full(len(foods), config.world.food_radius)]
    place = np.vstack([others, foods]).reshape(-1, 2) - center
    spread, rays = math.radians(own.sensor.ray_spread), own.sensor.ray_count
    angle = heading + (np.linspace(-spread, spread, rays) if rays > 1 else np.zeros(1))
    segments = np.asarray(walls(config.arena)).reshape(-1, 4) - np.tile(center, 2)
    return Scene(
        np.column_stack([place, radius]),
        np.r_[np.zeros(len(others), int), np.ones(len(foods), int)],
        segments,
        np.stack([-np.sin(angle), np.cos(angle)], 1),
        start=own.body.radius,
        length=own.sensor.ray_length,
    )


def readings(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Reading + 1 and type of each ray of each agent, (agents, rays)."""
    rays = simulation.worlds[0].rays()
    kind = rays.argmax(2)
    best = rays.max(2) + 1.0
    return best, np.where(best > 0.0, kind, 0)


def random_place(simulation: Simulation, rng: np.random.Generator, count: int) -> np.ndarray:
    """Places anywhere in the arena, a quarter of them at its rim, where cells end."""
    size = np.array([simulation.config.arena.width, simulation.config.arena.height])
    place = rng.uniform(0.0, size, (count, 2))
    rim = rng.random(count) < 0.25
    place[rim] = np.where(rng.random((rim.sum(), 2)) < 0.5, rng.uniform(0, 3, (rim.sum(), 2)), place[rim])
    return place.astype(np.float32)


def compare(simulation: Simulation, agents: np.ndarray, foods: np.ndarray, watched: int = 12) -> tuple[int, int]:
    """Checks the readings of some agents; returns how many rays were compared, and how many hit something."""
    set_scene(simulation, agents, foods)
    got, got_kind = readings(simulation)
    compared = hits = 0
    for self in range(min(watched, len(agents))):
        case = reference(simulation, agents.astype(np.float64), foods.astype(np.float64), self)
        expected, kind = cast(case)
        clear = ~is_delicate(case)
        # Near ten thousand u, float coordinates are a thousandth apart.
        np.testing.assert_allclose(got[self, clear], expected[clear], rtol=0, atol=5e-4)
        # If a ray starts inside two bodies, both are at distance 0, and either may be reported.
        told = clear & (np.abs(got[self] - expected) < 1e-5) & (expected > 0) & (expected < 2)
        np.testing.assert_array_equal(got_kind[self, told], kind[told])
        compared, hits = compared + int(clear.sum()), hits + int((expected[clear] > 0).sum())
    return compared, hits


@pytest.mark.parametrize("name", CASES)
def test_random_scenes_are_seen_as_they_are(name: str):
    simulation = make_simulation(*ROOM, *CASES[name])
    rng = np.random.default_rng(7)
    compared = hits = 0
    for agents, foods in ((150, 100), (40, 200), (250, 0), (2, 1)):
        body = np.column_stack([random_place(simulation, rng, agents), rng.uniform(0, 2 * math.pi, agents)])
        counts = compare(simulation, body.astype(np.float32), random_place(simulation, rng, foods))
        compared, hits = compared + counts[0], hits + counts[1]
    assert compared > 20 * simulation.config.species["agent"].sensor.ray_count
    assert hits > 0 or name == "an empty plain"


@pytest.mark.parametrize("kernel", KERNELS)
def test_each_kernel_sees_a_full_arena(kernel: str):
    simulation = make_simulation(*ROOM, backend=kernel)
    rng = np.random.default_rng(3)
    body = np.column_stack([random_place(simulation, rng, 300), rng.uniform(0, 2 * math.pi, 300)])
    _, hits = compare(simulation, body.astype(np.float32), random_place(simulation, rng, 300), watched=40)
    assert hits > 500


def test_a_lone_agent_sees_only_walls():
    simulation = make_simulation(*ROOM)
    agents = np.array([[30.0, 30.0, 0.3]], np.float32)
    _, hits = compare(simulation, agents, np.zeros((0, 2), np.float32))
    assert hits > 5
    assert (readings(simulation)[1][readings(simulation)[0] > 0] == 2).all()


def test_an_agent_on_top_of_another_sees_it_but_not_itself():
    simulation = make_simulation(*ROOM)
    set_scene(simulation, [(240, 180, 0.0), (240, 180, 1.0), (240, 260, 0.0)])
    reading, kind = readings(simulation)
    # The rays of each start on the rim of the other, which is in the same place: distance 0.
    assert (reading[:2] == 2.0).all()
    assert (kind[:2] == 0).all()
