"""Scenes for the physics tests: the model's settings and arena, crowds without overlap, and motors."""

import math
from typing import Any

import numpy as np

from hedon import _engine

RADIUS, CIRCLE_RADIUS, DENSITY = 10.0, 4.0, 0.1
MASS = DENSITY * math.pi * RADIUS**2
INERTIA = 0.5 * MASS * RADIUS**2
CONFIG = {
    "dt": 0.1,
    "substeps": 5,
    "solver": "sequential",
    "velocity_passes": 6,
    "position_passes": 2,
    "linear_damping": 0.8,
    "angular_damping": 0.6,
    "max_speed": 10.0,
    "max_angular_speed": math.pi,
    "friction": 0.2,
    "restitution": 0.4,
    "restitution_threshold": 1.0,
    "correction_rate": 0.2,
    "slop": 0.005,
    "max_correction": 0.2,
    "neighbor_skin": 4.0,
}
FIELDS = ("x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity")


def arena_walls(width=480.0, height=360.0, corner=19.0, chords=4):
    """Segments of a rectangle with rounded corners, clockwise, (walls, 4)."""
    points = []
    for i, (cx, cy) in enumerate([(1, 1), (0, 1), (0, 0), (1, 0)]):
        center = np.array([width - corner if cx else corner, height - corner if cy else corner])
        turn = np.linspace(i * np.pi / 2, (i + 1) * np.pi / 2, chords + 1)
        points.append(center + corner * np.column_stack([np.cos(turn), np.sin(turn)]))
    points = np.concatenate(points)[::-1]
    return np.hstack([points, np.roll(points, -1, axis=0)])


def make_scene(bodies=(), circles=(), walls=(), slots=None, capacity=None, size=(480.0, 360.0), **settings):
    """A scene with bodies at places (n, 2), circles at places (m, 2) and walls (k, 4).

    `slots[i]` is the slot of body i; `settings` override `CONFIG`, or give `pair_limit`, `outer_walls`, and `classes`:
    first slot, radius and density of each additional class of bodies.
    """
    bodies = np.asarray(bodies, dtype=np.float32).reshape(-1, 2)
    circles = np.asarray(circles, dtype=np.float32).reshape(-1, 2)
    limit = settings.pop("pair_limit", 0)
    ring = settings.pop("outer_walls", 0)
    classes = settings.pop("classes", [])
    slots = np.arange(len(bodies)) if slots is None else np.asarray(slots)
    scene = _engine.physics.Scene(
        CONFIG | settings,
        size[0],
        size[1],
        RADIUS,
        DENSITY,
        CIRCLE_RADIUS,
        max(capacity or 0, len(bodies)),
        len(circles),
        [tuple(map(float, wall)) for wall in walls],
        limit,
        ring,
        classes,
    )
    scene.array("x")[slots], scene.array("y")[slots] = bodies.T
    scene.array("circle_x")[:], scene.array("circle_y")[:] = circles.T
    scene.array("circle_present")[:] = 1
    scene.set_order([int(slot) for slot in slots])
    return scene


def read(scene, slots: Any = slice(None)):
    """Copies of all body fields, (6, bodies)."""
    return np.array([scene.array(name)[slots] for name in FIELDS])


def positions(scene):
    """Centers, (bodies, 2), float64."""
    return np.column_stack([scene.array("x"), scene.array("y")]).astype(float)


def velocities(scene):
    """Velocities, (bodies, 2), float64."""
    return np.column_stack([scene.array("velocity_x"), scene.array("velocity_y")]).astype(float)


def drive(scene, left, right, slots: Any = slice(None)):
    """Sets force and torque from two motors 135° to either side of the heading (model, section 4)."""
    angle = scene.array("angle")[slots]
    total = np.asarray(left) + np.asarray(right)
    scene.array("force_x")[slots] = -np.sin(angle) * total
    scene.array("force_y")[slots] = np.cos(angle) * total
    arm = RADIUS * math.sin(math.radians(135.0))
    scene.array("force_torque")[slots] = (np.asarray(right) - np.asarray(left)) * arm


def random_drive(scene, steps, seed, slots, period=20):
    """Yields 0, 1, …, steps - 1, each time with motor forces set; they are redrawn every `period` steps."""
    rng = np.random.default_rng(seed)
    for start in range(0, steps, period):
        forces = rng.uniform(-20.0, 80.0, (2, len(slots)))
        for step in range(start, min(start + period, steps)):
            drive(scene, forces[0], forces[1], slots)
            yield step


def scatter(rng, bodies, circles, width=480.0, height=360.0, margin=12.0):
    """Places of bodies and circles that do not overlap one another."""
    found = []
    sizes = [RADIUS] * bodies + [CIRCLE_RADIUS] * circles
    for radius in sizes:
        for _ in range(20000):
            place = rng.uniform([margin, margin], [width - margin, height - margin])
            if all(np.hypot(*(place - other)) > radius + size for other, size in found):
                found.append((place, radius))
                break
        else:
            raise RuntimeError("no room")
    places = np.array([place for place, _ in found])
    return places[:bodies], places[bodies:]


def crowd(seed, bodies=200, circles=60, slots=None, **settings):
    """A full arena with random headings."""
    rng = np.random.default_rng(seed)
    places, foods = scatter(rng, bodies, circles)
    walls = arena_walls()
    scene = make_scene(places, foods, walls, slots, outer_walls=len(walls), **settings)
    slots = np.arange(bodies) if slots is None else slots
    scene.array("angle")[slots] = rng.uniform(0, 2 * np.pi, bodies)
    return scene
