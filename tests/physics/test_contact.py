"""Contacts of a few bodies compared with closed forms, and the calls of the contact visitor."""

import math

import numpy as np
import pytest
from physics_scene import INERTIA, MASS, RADIUS, arena_walls, crowd, make_scene, positions, read, velocities

DECAY = math.exp(-0.08)
WALL = [[0.0, 100.0, 200.0, 100.0]]


def head_on(speed, **settings):
    """Two bodies that just touch and approach along x at `speed` each; state after one substep."""
    scene = make_scene([[100.0, 100.0], [119.99, 100.0]], substeps=1, **settings)
    scene.array("velocity_x")[:] = [speed, -speed]
    scene.step()
    return scene


def test_fast_pair_bounces_with_the_restitution():
    scene = head_on(1.0)
    want = 0.4 * 1.0 * DECAY
    np.testing.assert_allclose(velocities(scene), [[-want, 0.0], [want, 0.0]], atol=1e-6)


def test_slow_pair_does_not_bounce():
    scene = head_on(0.5)
    np.testing.assert_allclose(velocities(scene), 0.0, atol=1e-7)


def test_threshold_is_compared_with_the_approach_speed_after_damping():
    at = 0.5 / DECAY
    assert velocities(head_on(at * 1.001))[1, 0] > 0.19
    assert abs(velocities(head_on(at * 0.999))[1, 0]) < 1e-6


@pytest.mark.parametrize(("speed", "want"), [(2.0, 0.4 * 2.0 * DECAY), (0.9, 0.0)])
def test_wall_and_circle_bounce_like_a_pair(speed, want):
    against_wall = make_scene([[100.0, 109.99]], walls=WALL, substeps=1)
    against_circle = make_scene([[100.0, 109.99]], circles=[[100.0, 96.0]], substeps=1)
    for scene in (against_wall, against_circle):
        scene.array("velocity_y")[0] = -speed
        scene.step()
        np.testing.assert_allclose(velocities(scene)[0], [0.0, want], atol=1e-6)


def test_walls_are_solid_from_both_sides():
    scene = make_scene([[60.0, 111.0], [140.0, 89.0]], walls=WALL)
    scene.array("force_y")[:] = [-160.0, 160.0]
    scene.step(100)
    y = scene.array("y")
    assert 109.9 < y[0] < 110.0
    assert 90.0 < y[1] < 90.1


def test_end_of_a_wall_pushes_away_from_the_point():
    scene = make_scene([[207.0, 107.0]], walls=WALL, substeps=1)
    scene.step()
    contact = scene.contacts()[0]
    np.testing.assert_allclose(contact[3:5], [-math.sqrt(0.5), -math.sqrt(0.5)], atol=1e-6)
    assert (positions(scene)[0] > [207.0, 107.0]).all()


def test_sliding_contact_feels_coulomb_friction():
    """A fast slide over a wall: the tangential impulse is friction times the normal impulse."""
    scene = make_scene([[100.0, 109.99]], walls=WALL, substeps=1)
    scene.array("velocity_x")[0], scene.array("velocity_y")[0] = 5.0, -0.9
    scene.step()
    normal = 0.9 * DECAY
    np.testing.assert_allclose(velocities(scene)[0], [5.0 * DECAY - 0.2 * normal, 0.0], atol=1e-5)
    # Sliding to the right over a wall below turns the body clockwise.
    want = -0.2 * normal * MASS * RADIUS / INERTIA
    np.testing.assert_allclose(scene.array("angular_velocity")[0], want, rtol=2e-3)
    (pair,) = scene.pairs("wall")
    np.testing.assert_allclose(pair[2:4], [MASS * normal, 0.2 * MASS * normal], rtol=1e-4)


def test_slow_slide_ends_rolling():
    """Sufficient friction stops the slip: a disc then keeps 2/3 of its speed and turns at v/r."""
    scene = make_scene([[100.0, 109.99]], walls=WALL, substeps=1, linear_damping=0.0, angular_damping=0.0)
    scene.array("velocity_x")[0], scene.array("velocity_y")[0] = 0.3, -0.9
    scene.step()
    np.testing.assert_allclose(scene.array("velocity_x")[0], 0.2, rtol=1e-3)
    np.testing.assert_allclose(scene.array("angular_velocity")[0], -0.02, rtol=1e-3)


def test_friction_turns_both_bodies_of_a_pair_the_same_way():
    scene = make_scene([[100.0, 100.0], [119.99, 100.0]], substeps=1)
    scene.array("velocity_x")[:] = [0.4, -0.4]
    scene.array("velocity_y")[:] = [2.0, -2.0]
    scene.step()
    spin = scene.array("angular_velocity")
    np.testing.assert_allclose(spin[0], spin[1], rtol=1e-6)
    impulse = 0.2 * 0.4 * DECAY  # friction times normal impulse, per mass
    np.testing.assert_allclose(velocities(scene)[:, 1], [2 * DECAY - impulse, impulse - 2 * DECAY], rtol=1e-5)
    np.testing.assert_allclose(abs(spin[0]), impulse * MASS * RADIUS / INERTIA, rtol=2e-3)


def test_food_stops_a_body_that_keeps_pushing():
    scene = make_scene([[100.0, 100.0]], circles=[[130.0, 100.0]])
    scene.array("force_x")[0] = 160.0
    scene.step(200)
    np.testing.assert_allclose(scene.array("x")[0], 116.0, atol=0.05)


def test_absent_circles_are_not_there():
    scene = make_scene([[100.0, 100.0]], circles=[[130.0, 100.0]])
    scene.array("circle_present")[0] = 0
    scene.set_stale()
    scene.array("force_x")[0] = 160.0
    scene.step(60)
    assert scene.array("x")[0] > 130.0


def test_a_pair_that_separates_loses_its_impulse():
    scene = head_on(0.5)
    assert scene.pairs("body")[0][2] > 0.0
    scene.array("x")[1] += 1.0
    scene.step()
    assert scene.pairs("body")[0][2:4] == (0.0, 0.0)


def test_deep_overlap_is_corrected_at_the_clamped_rate():
    scene = make_scene([[100.0, 100.0], [115.0, 100.0]], substeps=1, position_passes=1)
    scene.step()
    np.testing.assert_allclose(scene.array("x"), [99.9, 115.1], atol=1e-5)
    scene = make_scene([[100.0, 100.0], [119.9, 100.0]], substeps=1, position_passes=1)
    scene.step()
    np.testing.assert_allclose(np.ptp(scene.array("x")), 19.9 + 0.2 * (0.1 - 0.005), atol=2e-5)


def test_visitor_is_called_for_both_sides_and_all_substeps():
    scene = make_scene([[100.0, 100.0], [119.0, 100.0]], circles=[[100.0, 113.0]], walls=[[91.0, 0.0, 91.0, 300.0]])
    scene.array("angle")[:] = [0.5, 1.5]
    scene.array("angular_velocity")[0] = 0.1
    scene.step()
    rows = scene.contacts()
    pair = [row for row in rows if row[0] == 0]
    assert {(row[1], row[2]) for row in pair} == {(0, 1), (1, 0)}
    for row in pair:
        np.testing.assert_allclose(row[3], 1.0 if row[1] == 0 else -1.0, atol=1e-3)
    assert len(pair) == 2 * 5
    walls = [row for row in rows if row[0] == 2]
    assert len(walls) == 5
    np.testing.assert_allclose(walls[0][3:6], [-1.0, 0.0, 0.5], atol=1e-6)
    assert walls[1][5] > 0.5  # the angle is that of the substep
    circles = [row for row in rows if row[0] == 1]
    np.testing.assert_allclose(circles[0][3:5], [0.0, 1.0], atol=1e-6)
    # The recorder counts calls in the mark of each pair.
    assert scene.pairs("wall")[0][4] == 5
    assert scene.pairs("body")[0][4] == 10
    scene.array("x")[:] = [200.0, 300.0]
    scene.step()
    assert scene.contacts() == []


@pytest.mark.parametrize("seed", range(5))
def test_pair_collision_never_gains_energy(seed):
    rng = np.random.default_rng(seed)
    turn = rng.uniform(0, 2 * np.pi)
    between = 19.9 * np.array([np.cos(turn), np.sin(turn)])
    scene = make_scene([[200, 200], 200 + between], substeps=1, linear_damping=0.0, angular_damping=0.0)
    scene.array("velocity_x")[:], scene.array("velocity_y")[:] = rng.uniform(-5, 5, (2, 2))
    scene.array("angular_velocity")[:] = rng.uniform(-1, 1, 2)

    def energy():
        state = read(scene).astype(float)
        return 0.5 * MASS * (state[3] ** 2 + state[4] ** 2).sum() + 0.5 * INERTIA * (state[5] ** 2).sum()

    before = energy()
    for _ in range(20):
        scene.step()
        after = energy()
        assert after <= before * (1 + 1e-6)
        before = after


def test_overlap_of_a_pushing_crowd_stays_small():
    """Full thrust of 200 bodies towards one wall: overlaps stay far below the size of a body."""
    scene = crowd(3, circles=0)
    scene.array("force_y")[:] = -160.0
    scene.step(400)
    place = positions(scene)
    apart = np.hypot(*(place[:, None] - place[None]).transpose(2, 0, 1))
    np.fill_diagonal(apart, np.inf)
    assert apart.min() > 2 * RADIUS - 0.5
    assert place[:, 1].min() > RADIUS - 0.5
    assert np.abs(velocities(scene)).max() < 0.6


def test_turning_a_scene_by_a_right_angle_turns_its_motion():
    """Walls, circles and bodies turned by 90°: the same motion up to rounding, before chaos sets in."""
    places = np.array([[40.0, 40.0], [61.0, 42.0], [50.0, 62.0], [150.0, 150.0]])
    circles = np.array([[75.0, 60.0]])
    speed = np.array([[1.5, 0.8], [-1.5, 1.2], [0.4, -1.5], [0.5, 1.0]])
    walls = arena_walls(200.0, 200.0)

    def run(turn, turn_vector):
        ends = np.hstack([turn(walls[:, :2]), turn(walls[:, 2:])])
        scene = make_scene(turn(places), turn(circles), ends, size=(200.0, 200.0), angular_damping=0.0)
        scene.array("velocity_x")[:], scene.array("velocity_y")[:] = turn_vector(speed).T
        scene.step(20)
        return positions(scene), scene.array("angular_velocity").copy()

    def turn(xy):
        return np.column_stack([200.0 - xy[:, 1], xy[:, 0]])

    def turn_vector(xy):
        return np.column_stack([-xy[:, 1], xy[:, 0]])

    straight, spin = run(lambda xy: xy, lambda xy: xy)
    turned, spin_turned = run(turn, turn_vector)
    np.testing.assert_allclose(turn(straight), turned, atol=1e-3)
    np.testing.assert_allclose(spin, spin_turned, atol=1e-4)
    assert np.abs(spin[:3]).min() > 1e-3
