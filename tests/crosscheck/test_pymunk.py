"""The same scenes in pymunk (Chipmunk 7), an independent engine of the same family.

pymunk moves bodies before it looks for contacts, and bounces without a threshold; scenes are set so that both
engines see the same contacts. Single collisions agree up to the difference of the arms (see there); states of rest
agree up to the effect of the different position corrections.
"""

import math

import numpy as np
import pymunk
import pytest
from physics_scene import (
    CIRCLE_RADIUS,
    CONFIG,
    INERTIA,
    MASS,
    RADIUS,
    arena_walls,
    make_scene,
    positions,
    scatter,
    velocities,
)

DT = CONFIG["dt"]


class Rival:
    """A pymunk space with our bodies, circles and walls."""

    def __init__(self, bodies, circles=(), walls=(), restitution=0.4, friction=0.2, damping=False):
        self.coefficients = math.sqrt(friction), math.sqrt(restitution)  # pymunk multiplies the coefficients of a pair
        self.space = pymunk.Space()
        self.space.iterations = 60
        self.space.collision_slop = 0.005
        self.bodies = []

        def damp(body, gravity, _, dt):
            pymunk.Body.update_velocity(body, gravity, 1.0, dt)
            body.velocity = body.velocity * math.exp(-CONFIG["linear_damping"] * dt)
            body.angular_velocity *= math.exp(-CONFIG["angular_damping"] * dt)

        for place in bodies:
            body = pymunk.Body(MASS, INERTIA)
            body.position = float(place[0]), float(place[1])
            if damping:
                body.velocity_func = damp
            self.add(body, pymunk.Circle(body, RADIUS))
            self.bodies.append(body)
        for place in circles:
            shape = pymunk.Circle(self.space.static_body, CIRCLE_RADIUS, (float(place[0]), float(place[1])))
            self.add(None, shape)
        for wall in walls:
            shape = pymunk.Segment(self.space.static_body, tuple(wall[:2]), tuple(wall[2:]), 0.0)
            self.add(None, shape)

    def add(self, body, shape):
        shape.friction, shape.elasticity = self.coefficients
        self.space.add(*([body] if body else []), shape)

    def set_velocity(self, velocity, spin):
        for body, v, w in zip(self.bodies, velocity, spin, strict=True):
            body.velocity, body.angular_velocity = tuple(map(float, v)), float(w)

    def step(self, forces=None):
        for i, body in enumerate(self.bodies):
            body.force = tuple(map(float, forces[i])) if forces is not None else (0.0, 0.0)
        self.space.step(DT)

    def velocities(self):
        return np.array([body.velocity for body in self.bodies])

    def spins(self):
        return np.array([body.angular_velocity for body in self.bodies])

    def positions(self):
        return np.array([body.position for body in self.bodies])


def free(**settings):
    """Settings with which one substep is one step of pymunk."""
    return {"substeps": 1, "linear_damping": 0.0, "angular_damping": 0.0, "velocity_passes": 60} | settings


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize(("restitution", "friction"), [(0.4, 0.0), (0.0, 0.2)])
def test_single_collisions_agree(seed, restitution, friction):
    """A pair, or a body and a circle or wall, that approach fast: equal velocities and spins afterwards.

    Not both coefficients at once: in pymunk, the bounce also increases friction, but not in our order (restitution
    last, as in Box2D).
    """
    rng = np.random.default_rng(seed)
    turn = rng.uniform(0, 2 * np.pi)
    along = np.array([np.cos(turn), np.sin(turn)])
    center = np.array([200.0, 150.0])
    kind = ("pair", "circle", "wall")[seed % 3]
    bodies = np.array([center, center + 19.995 * along]) if kind == "pair" else center[None]
    circles = [center + 13.995 * along] if kind == "circle" else []
    foot = center + 9.995 * along
    side = 60.0 * np.array([-along[1], along[0]])
    walls = [[*(foot - side), *(foot + side)]] if kind == "wall" else []
    velocity = rng.uniform(-1.5, 1.5, (len(bodies), 2))
    velocity[0] += 4.0 * along  # always approaching, above the threshold
    spin = rng.uniform(-0.5, 0.5, len(bodies))

    ours = make_scene(bodies, circles, walls, **free(restitution=restitution, friction=friction))
    ours.array("velocity_x")[:], ours.array("velocity_y")[:] = velocity.T
    ours.array("angular_velocity")[:] = spin
    ours.step()
    theirs = Rival(bodies - DT * velocity, circles, walls, restitution, friction)
    theirs.set_velocity(velocity, spin)
    theirs.step()

    assert np.abs(theirs.velocities() - velocity).max() > 1.0
    # pymunk's arm reaches to each surface, ours to the middle of the overlap of 0.005 u: 2.5e-4 of the arm.
    np.testing.assert_allclose(velocities(ours), theirs.velocities(), atol=1e-3)
    np.testing.assert_allclose(ours.array("angular_velocity"), theirs.spins(), atol=2e-4)


def test_pushed_row_transmits_the_same_impulses():
    """Four bodies pushed along a row against a wall: contact k carries the pushes of all behind it."""
    bodies = [[290.0 - 19.98 * i, 100.0] for i in range(4)]
    wall = [[300.0, 0.0, 300.0, 200.0]]
    push = 60.0
    ours = make_scene(bodies, walls=wall, substeps=1)
    ours.array("force_x")[:] = push
    theirs = Rival(bodies, walls=wall, damping=True)
    for _ in range(400):
        ours.step()
        theirs.step(np.tile([push, 0.0], (4, 1)))
    decay = math.exp(-CONFIG["linear_damping"] * DT)
    want = push * DT * decay
    wall_impulse = ours.pairs("wall")[0][2]
    chain = {row[:2]: row[2] for row in ours.pairs("body")}
    np.testing.assert_allclose(wall_impulse, 4 * want, rtol=5e-3)
    np.testing.assert_allclose([chain[0, 1], chain[1, 2], chain[2, 3]], [3 * want, 2 * want, want], rtol=5e-3)

    found = {}
    for i, body in enumerate(theirs.bodies):

        def note(arbiter, i=i):
            found[i, round(arbiter.normal.x)] = abs(arbiter.total_impulse.x)

        body.each_arbiter(note)
    rival = sorted(set(np.round(list(found.values()), 2)))
    np.testing.assert_allclose(rival, [push * DT * decay * k for k in (1, 2, 3, 4)], rtol=5e-3)
    np.testing.assert_allclose(positions(ours), theirs.positions(), atol=0.05)


@pytest.mark.parametrize("side", [10.0, 40.0, 90.0])
def test_pressed_body_rolls_or_slides_at_the_same_speed(side):
    """A body pressed against a wall and pulled along it rolls if friction suffices; otherwise, it slides."""
    wall = [[0.0, 100.0, 480.0, 100.0]]
    ours = make_scene([[60.0, 110.0]], walls=wall, substeps=1)
    ours.array("force_x")[0], ours.array("force_y")[0] = side, -100.0
    theirs = Rival([[60.0, 110.0]], walls=wall, damping=True)
    for _ in range(150):
        ours.step()
        theirs.step([[side, -100.0]])
    slip = velocities(ours)[0, 0] + RADIUS * ours.array("angular_velocity")[0]
    assert (abs(slip) < 0.01) == (side < 60.0)
    np.testing.assert_allclose(velocities(ours)[0], theirs.velocities()[0], rtol=5e-3, atol=5e-3)
    np.testing.assert_allclose(ours.array("angular_velocity"), theirs.spins(), rtol=5e-3, atol=5e-4)


def test_pile_comes_to_rest_in_the_same_place():
    """Ten bodies fall into a box as a triangle of rows 4-3-2-1 and stay there."""
    rows = [(n, row) for row, n in enumerate((4, 3, 2, 1))]
    places = [[110.0 + 10.0 * row + 20.0 * i, 110.5 + 17.6 * row] for n, row in rows for i in range(n)]
    box = [[100.0, 100.0, 180.0, 100.0], [100.0, 100.0, 100.0, 300.0], [180.0, 100.0, 180.0, 300.0]]
    ours = make_scene(places, walls=box, substeps=1)
    weight = -20.0
    ours.array("force_y")[:] = weight
    theirs = Rival(places, walls=box, damping=True)
    for _ in range(600):
        ours.step()
        theirs.step(np.tile([0.0, weight], (10, 1)))
    assert np.abs(velocities(ours)).max() < 0.01
    np.testing.assert_allclose(positions(ours), theirs.positions(), atol=0.1)
    floor = sum(row[2] for row in ours.pairs("wall") if row[1] == 0)
    wall_friction = sum(abs(row[3]) for row in ours.pairs("wall") if row[1] > 0)
    want = 10 * -weight * DT * math.exp(-0.08)
    assert abs(floor - want) <= wall_friction + 0.02 * want


def test_cooling_crowd_loses_energy_at_the_same_rate():
    """60 bodies among 40 circles, no damping: only bounces decide the kinetic energy after 20 s."""
    ratios = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        places, circles = scatter(rng, 60, 40)
        velocity = rng.uniform(-5, 5, (60, 2))
        ours = make_scene(places, circles, arena_walls(), **free(restitution_threshold=0.0, velocity_passes=6))
        ours.array("velocity_x")[:], ours.array("velocity_y")[:] = velocity.T
        theirs = Rival(places, circles, arena_walls())
        theirs.set_velocity(velocity, np.zeros(60))
        for _ in range(200):
            ours.step()
            theirs.step()
        mine, rival = (velocities(ours) ** 2).sum(), (theirs.velocities() ** 2).sum()
        assert mine < 0.5 * (velocity**2).sum()
        ratios.append(math.log(mine / rival))
    assert abs(np.mean(ratios)) < 3 * np.std(ratios) / math.sqrt(6) + 0.05, ratios
