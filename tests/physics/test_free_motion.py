"""Bodies that touch nothing: closed forms, caps, and motions recorded from the paper's program."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from physics_scene import CONFIG, INERTIA, MASS, drive, make_scene, positions, read, velocities

CASES = json.loads((Path(__file__).parents[1] / "data" / "motion.json").read_text())


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['force_left']},{case['force_right']}")
def test_motion_matches_the_released_code(case):
    start = case["start"]
    scene = make_scene([start["xy"]])
    scene.array("angle")[0] = start["angle"]
    checked = 0
    for step in range(1, 61):
        drive(scene, case["force_left"], case["force_right"])
        scene.step()
        want = case["after_steps"].get(str(step))
        if want is None:
            continue
        np.testing.assert_allclose(positions(scene)[0], want["xy"], atol=1e-3)
        np.testing.assert_allclose(velocities(scene)[0], want["velocity"], atol=1e-3)
        np.testing.assert_allclose(scene.array("angle")[0], want["angle"], atol=1e-3)
        np.testing.assert_allclose(scene.array("angular_velocity")[0], want["angular_velocity"], atol=1e-3)
        checked += 1
    assert checked == 5


def test_damped_flight_follows_its_closed_form():
    scene = make_scene([[200.0, 150.0]])
    scene.array("velocity_x")[0], scene.array("velocity_y")[0] = 1.5, -0.7
    scene.array("angular_velocity")[0] = 0.4
    steps = 12
    scene.step(steps)
    substeps = steps * CONFIG["substeps"]
    linear, angular = math.exp(-0.08), math.exp(-0.06)
    path = 0.1 * linear * (1 - linear**substeps) / (1 - linear)
    turn = 0.1 * angular * (1 - angular**substeps) / (1 - angular)
    # 60 additions at magnitude 200 round by at most 60 · 2^-17 = 5e-4 u, mostly far less.
    np.testing.assert_allclose(positions(scene)[0], [200.0 + 1.5 * path, 150.0 - 0.7 * path], atol=2e-4)
    np.testing.assert_allclose(velocities(scene)[0], np.array([1.5, -0.7]) * linear**substeps, rtol=1e-5)
    np.testing.assert_allclose(scene.array("angle")[0], 0.4 * turn, rtol=1e-5)
    np.testing.assert_allclose(scene.array("angular_velocity")[0], 0.4 * angular**substeps, rtol=1e-5)


def test_force_and_torque_act_in_the_first_substep_only():
    scene = make_scene([[100.0, 100.0]])
    scene.array("force_x")[0], scene.array("force_torque")[0] = 50.0, 300.0
    scene.step()
    decay = CONFIG["substeps"] * CONFIG["dt"]
    np.testing.assert_allclose(velocities(scene)[0], [50.0 / MASS * 0.1 * math.exp(-0.8 * decay), 0.0], rtol=1e-5)
    want = 300.0 / INERTIA * 0.1 * math.exp(-0.6 * decay)
    np.testing.assert_allclose(scene.array("angular_velocity")[0], want, rtol=1e-5)


def test_speeds_are_capped_per_axis():
    scene = make_scene([[240.0, 180.0]], linear_damping=0.0, angular_damping=0.0)
    scene.array("force_x")[0], scene.array("force_y")[0] = 1e6, -1e6
    scene.array("force_torque")[0] = -1e9
    scene.step(3)
    np.testing.assert_array_equal(velocities(scene)[0], [10.0, -10.0])
    np.testing.assert_allclose(scene.array("angular_velocity")[0], -math.pi, rtol=1e-7)
    np.testing.assert_allclose(positions(scene)[0], [255.0, 165.0], atol=1e-3)


@pytest.mark.parametrize("turn", [-2.9, 2.9])
def test_angle_stays_within_one_turn(turn):
    scene = make_scene([[240.0, 180.0]], angular_damping=0.0)
    scene.array("angular_velocity")[0] = turn
    angles = []
    for _ in range(20):
        scene.step()
        angles.append(float(scene.array("angle")[0]))
    assert min(angles) >= 0.0
    assert max(angles) < 2 * np.pi
    want = (turn * 0.5 * np.arange(1, 21)) % (2 * np.pi)
    np.testing.assert_allclose(np.exp(1j * np.array(angles)), np.exp(1j * want), atol=1e-4)


def test_a_body_that_is_not_in_the_order_does_not_move():
    scene = make_scene([[100.0, 100.0], [300.0, 100.0]])
    scene.set_order([1])
    scene.array("velocity_x")[:] = 1.0
    before = read(scene)
    scene.step(5)
    np.testing.assert_array_equal(read(scene)[:, 0], before[:, 0])
    assert scene.array("x")[1] > 300.5
