"""The cost of an agent's rays: the kernel that casts them, on the circles around agents of a world."""

import numpy as np
from numpy.typing import NDArray

from benchmarks.check import require
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, interleave, median, spread
from benchmarks.plan import Plan
from benchmarks.scene import peopled
from hedon import _engine
from hedon.config.schema.arena import walls
from hedon.config.schema.species import ONLY
from hedon.experiment.world import World

AGENTS = 8
CASTS = 500
"""Repeats for each agent in one timed call."""
ALIKE = 0.98
"""Share of readings that must equal the world's own; a ray that touches a circle's edge may round to hit or miss."""


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row per instruction set: the rays of some agents of a world, among all that they can hit."""
    world = peopled(plan)
    chosen = np.linspace(0, world.alive - 1, AGENTS).astype(int)
    views = [_view_of(world, index) for index in chosen]
    casts = 10 if plan.quick else CASTS
    for kernel in plan.kernels:
        _check(plan, world, chosen, [_engine.kernel.cast_rays(kernel, *view) for view in views], kernel)

    def cast(kernel: str) -> None:
        for view in views:
            _engine.kernel.cast_rays(kernel, *view, casts)

    times = interleave({kernel: lambda k=kernel: cast(k) for kernel in plan.kernels}, plan.repeats)
    circles = float(np.mean([len(view[0]) for view in views]))
    return [
        {
            "kernel": kernel,
            "threads": 1,
            "rays": world.config.species[ONLY].sensor.ray_count,
            "circles": circles,
            "walls": len(views[0][2]),
            "agent_seconds": [t / (AGENTS * casts) for t in times[kernel]],
        }
        for kernel in plan.kernels
    ]


def _view_of(world: World, index: int) -> tuple[NDArray, NDArray, NDArray, int, NDArray, float, float]:
    """Arguments of `cast_rays` for one agent: circles that its rays may hit, walls, directions, and ray length."""
    config, agents, foods = world.config, world.agents(), world.foods()
    species_config = config.species[ONLY]
    x, y, heading = (agents[name][index] for name in ("x", "y", "angle"))
    others = np.delete(np.arange(world.alive), index)
    sizes = [np.full(len(others), species_config.body.radius), np.full(len(foods["x"]), config.world.food_radius)]
    circles = np.column_stack(
        [
            np.concatenate([agents["x"][others], foods["x"]]) - x,
            np.concatenate([agents["y"][others], foods["y"]]) - y,
            np.concatenate(sizes),
        ]
    ).astype(np.float32)
    types = np.concatenate([np.zeros(len(others)), 1 + foods["kind"]]).astype(np.int32)

    spread_angle = np.radians(species_config.sensor.ray_spread)
    distance = np.hypot(circles[:, 0], circles[:, 1])
    aside = np.arctan2(-circles[:, 0], circles[:, 1]) - heading
    aside = np.abs((aside + np.pi) % (2 * np.pi) - np.pi)
    width = np.arcsin(np.minimum(circles[:, 2] / distance, 1))
    near = distance < species_config.body.radius + species_config.sensor.ray_length + circles[:, 2]
    sighted = near & (aside <= spread_angle + width)

    angles = heading + np.linspace(-spread_angle, spread_angle, species_config.sensor.ray_count)
    directions = np.column_stack([-np.sin(angles), np.cos(angles)]).astype(np.float32)
    segments = walls(config.arena) - np.array([x, y, x, y], np.float32)
    wall_type = 1 + len(config.food)
    reach = species_config.body.radius, species_config.sensor.ray_length
    return circles[sighted], types[sighted], segments, wall_type, directions, *reach


def _check(plan: Plan, world: World, chosen: NDArray, results: list[tuple], kernel: str) -> None:
    """Raises an error if the rays hit nothing, or if their readings differ from the world's own."""
    sensed = world.rays()[chosen]
    cast = np.full_like(sensed, -1)
    for i, (reading, hit) in enumerate(results):
        rays = np.flatnonzero(reading)
        cast[i, rays, hit[rays]] = reading[rays] - 1
    require(bool((cast > -1).any()), f"rays, {kernel}: no ray of {len(chosen)} agents hits anything")
    alike = np.isclose(cast, sensed, atol=1e-3).mean()
    require(alike >= ALIKE, f"rays, {kernel}: only {alike:.1%} of the readings are equal to the world's own")


def table(rows: list[Row], _: Calibration) -> Table:
    """Microseconds per agent."""
    first = rows[0]
    title = f"rays: {first['rays']} rays of one agent among {first['circles']:.0f} circles and {first['walls']} walls"
    lines = [
        (
            row["kernel"],
            spread(row["agent_seconds"], 3, 1e6),
            f"{median(row['agent_seconds']) / row['rays'] * 1e9:.1f}",
        )
        for row in rows
    ]
    return Table(title, ("kernel", "agent [us]", "ray [ns]"), lines)
