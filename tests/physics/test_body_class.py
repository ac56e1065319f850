"""Bodies of several sizes: closed forms for two unequal discs, and invariants of all scenes."""

import numpy as np
import pytest
from physics_scene import DENSITY, MASS, RADIUS, make_scene, positions, velocities

LARGE = 14.0
LARGE_MASS = DENSITY * np.pi * LARGE**2
FREE = {"linear_damping": 0.0, "angular_damping": 0.0, "max_speed": 1e4}
CLASSES = [(1, LARGE, DENSITY)]
SOLVERS = ("sequential", "jacobi")


def pair(gap, **settings):
    """A small body and, on its right, a large one, `gap` apart."""
    between = RADIUS + LARGE + gap
    return make_scene([[100.0, 100.0], [100.0 + between, 100.0]], classes=CLASSES, substeps=1, **FREE, **settings)


def test_a_fast_pair_bounces_as_unequal_masses_do():
    scene = pair(-0.01)
    scene.array("velocity_x")[:] = [2.0, -1.0]
    scene.step()
    common = (MASS * 2.0 - LARGE_MASS) / (MASS + LARGE_MASS)
    want = [common - 0.4 * 3.0 * LARGE_MASS / (MASS + LARGE_MASS), common + 0.4 * 3.0 * MASS / (MASS + LARGE_MASS)]
    np.testing.assert_allclose(velocities(scene)[:, 0], want, atol=2e-6)


def test_they_touch_at_the_sum_of_their_radii():
    assert len(pair(-1e-3).pairs("body")) == 0  # no list before the first step
    for gap, touching in ((-1e-2, 2), (1e-2, 0)):
        scene = pair(gap)
        scene.step()
        assert len(scene.contacts()) == touching


def test_the_lighter_one_gives_way():
    scene = pair(-4.0)
    scene.step(20)
    moved = np.abs(positions(scene)[:, 0] - [100.0, 100.0 + RADIUS + LARGE - 4.0])
    assert moved.sum() == pytest.approx(4.0, abs=0.1)
    assert moved[0] / moved[1] == pytest.approx(LARGE_MASS / MASS, rel=1e-3)


def test_a_body_keeps_its_own_distance_from_walls():
    wall = [[0.0, 100.0, 200.0, 100.0]]
    scene = make_scene([[60.0, 112.0], [140.0, 116.0]], walls=wall, classes=CLASSES)
    scene.array("force_y")[:] = [-160.0, -160.0]
    scene.step(100)
    np.testing.assert_allclose(scene.array("y") - 100.0, [RADIUS, LARGE], atol=0.1)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_crowd_keeps_its_momentum(solver):
    rng = np.random.default_rng(3)
    lattice = np.stack(np.meshgrid(np.arange(5), np.arange(4)), -1).reshape(-1, 2)
    places = 150.0 + 23.0 * lattice + rng.uniform(-0.3, 0.3, lattice.shape)
    scene = make_scene(places, classes=[(10, LARGE, DENSITY)], solver=solver, **FREE)
    scene.array("velocity_x")[:], scene.array("velocity_y")[:] = rng.uniform(-3, 3, lattice.shape).T
    mass = np.where(np.arange(20) < 10, MASS, LARGE_MASS)[:, None]
    before = (mass * velocities(scene)).sum(0)
    scene.step(4)
    assert len(scene.contacts()) > 20
    np.testing.assert_allclose((mass * velocities(scene)).sum(0), before, atol=LARGE_MASS * 20 * 1e-5)


@pytest.mark.parametrize("solver", SOLVERS)
def test_classes_of_one_size_move_as_one_class(solver):
    """The general contact compared with the one for equal bodies: the same motion, up to rounding."""
    rng = np.random.default_rng(5)
    lattice = np.stack(np.meshgrid(np.arange(4), np.arange(3)), -1).reshape(-1, 2)
    places, velocity = 150.0 + 19.7 * lattice, rng.uniform(-2, 2, lattice.shape)
    ends = []
    for classes in ([], [(6, RADIUS, DENSITY)]):
        scene = make_scene(places, classes=classes, solver=solver)
        scene.array("velocity_x")[:], scene.array("velocity_y")[:] = velocity.T
        scene.step(3)
        ends.append(positions(scene))
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-3)
