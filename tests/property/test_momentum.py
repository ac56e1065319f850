"""Collisions among free bodies conserve momentum, whatever the scene."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physics_scene import INERTIA, MASS, make_scene, positions, read, velocities

SOLVERS = ("sequential", "jacobi")
speeds = st.floats(-3.0, 3.0, width=32)


@st.composite
def clusters(draw):
    """Bodies on a crowded lattice with some overlap, and their velocities and spins."""
    columns, rows = draw(st.integers(2, 5)), draw(st.integers(1, 4))
    spacing = draw(st.floats(18.5, 20.5))
    seed = draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    lattice = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), -1).reshape(-1, 2)
    places = 150.0 + spacing * lattice + rng.uniform(-0.3, 0.3, lattice.shape)
    return places, rng.uniform(-3, 3, lattice.shape), rng.uniform(-1, 1, len(lattice))


def moments(scene):
    """Total linear momentum, (2,), and total angular momentum about the origin."""
    linear = MASS * velocities(scene)
    place = positions(scene)
    spin = INERTIA * scene.array("angular_velocity").astype(float)
    return linear.sum(0), (place[:, 0] * linear[:, 1] - place[:, 1] * linear[:, 0] + spin).sum()


@pytest.mark.parametrize("solver", SOLVERS)
@settings(max_examples=60, deadline=None)
@given(cluster=clusters())
def test_cluster_keeps_linear_momentum(solver, cluster):
    """With either solver, as long as no speed is capped."""
    places, velocity, spin = cluster
    scene = make_scene(places, linear_damping=0.0, angular_damping=0.0, solver=solver, max_speed=1e4)
    scene.array("velocity_x")[:], scene.array("velocity_y")[:] = velocity.T
    scene.array("angular_velocity")[:] = spin
    before, _ = moments(scene)
    scene.step(4)
    after, _ = moments(scene)
    assert np.isfinite(read(scene)).all()
    # Each impulse rounds by 2^-24 of about 3 u/s, 20 substeps · 7 passes · 3 contacts per body.
    np.testing.assert_allclose(after, before, atol=MASS * len(places) * 1e-5)


@pytest.mark.parametrize("solver", SOLVERS)
@settings(max_examples=60, deadline=None)
@given(turn=st.floats(0, 2 * np.pi), motion=st.tuples(speeds, speeds, speeds, speeds, *2 * [st.floats(-1, 1)]))
def test_pair_keeps_angular_momentum(solver, turn, motion):
    """Friction turns orbital into spin momentum and back, with an arm that ends where both surfaces meet. The position
    correction, left out here, moves bodies without changing velocities, and so changes angular momentum."""
    ax, ay, bx, by, spin_a, spin_b = motion
    between = 19.9 * np.array([np.cos(turn), np.sin(turn)])
    still = {"linear_damping": 0.0, "angular_damping": 0.0, "position_passes": 0}
    scene = make_scene([[10.0, 10.0], 10.0 + between], substeps=1, solver=solver, **still)
    scene.array("velocity_x")[:], scene.array("velocity_y")[:] = [ax, bx], [ay, by]
    scene.array("angular_velocity")[:] = [spin_a, spin_b]
    before = moments(scene)
    place = positions(scene)
    scene.step()
    linear = MASS * velocities(scene)
    angular = (place[:, 0] * linear[:, 1] - place[:, 1] * linear[:, 0]).sum() + INERTIA * scene.array(
        "angular_velocity"
    ).astype(float).sum()
    np.testing.assert_allclose(linear.sum(0), before[0], atol=1e-3)
    # Magnitudes are about 31 · 3 · 30 + 1571; float32 velocities lose about 1e-6 of that per pass.
    np.testing.assert_allclose(angular, before[1], atol=0.02)
