"""Motion of agents that have learned nothing: free bodies with random actions, walls, and no other agents.

Places and velocities are complex numbers, x + iy, so that a rotation is a product.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.arena import outline, walls
from hedon.config.schema.body import MotorConfig
from hedon.config.schema.species import SpeciesConfig

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(32)
_WEIGHTS = _WEIGHTS / _WEIGHTS.sum()

Floats = NDArray[np.float64]
Points = NDArray[np.complex128]


def fresh_force(motor: MotorConfig) -> float:
    """Mean norm of both forces under a fresh policy, whose raw actions are standard normal, by quadrature."""
    low, high = (motor.force_scale * force for force in (motor.min_force, motor.max_force))
    force = low + (high - low) / (1.0 + np.exp(-_NODES))
    return float(_WEIGHTS @ np.hypot(force[:, None], force[None, :]) @ _WEIGHTS)


def unlearned_walk(
    config: Config, species_config: SpeciesConfig, place: Points, steps: int, rng: np.random.Generator
) -> Iterator[tuple[Points, Points]]:
    """Moves agents as the engine does while their policies are new, ignoring other agents.

    A new policy draws raw actions that are nearly standard normal, whatever it observes. A step is computed at once:
    its force acts in the first substep, and damping leaves a geometric series. A wall stops a body, and friction makes
    it roll, so that it turns to face the wall and mostly stays there. Obstacles are ignored.

    Args:
        config: Settings of the arena and the physics.
        species_config: Body, motors and policy of the species; "idle" agents rest.
        place: Initial centers [u], shape (agents,).
        steps: Length of the walk [step].
        rng: Random number generator for headings and actions.

    Yields:
        Centers [u] and headings (of length 1) after each step, (agents,) each; the arrays are reused.
    """
    physics, motor, radius = config.physics, species_config.motor, species_config.body.radius
    mass = species_config.body.density * math.pi * radius**2
    lever = radius * math.sin(math.radians(motor.angle)) / (0.5 * mass * radius**2)
    low, high = (motor.force_scale * force for force in (motor.min_force, motor.max_force))
    slowing, turning = (math.exp(-rate * physics.dt) for rate in (physics.linear_damping, physics.angular_damping))
    path, turn = (physics.dt * sum(damping**i for i in range(physics.substeps)) for damping in (slowing, turning))
    linear_decay, angular_decay = slowing ** (physics.substeps - 1), turning ** (physics.substeps - 1)
    count, max_speed = len(place), physics.max_speed
    place, velocity, spin = place.copy(), np.zeros(count, np.complex128), np.zeros(count)
    angle = species_config.population.heading_range * rng.random(count)
    heading = 1j * np.exp(1j * angle)
    boundary = _Boundary(config, radius)
    is_idle = species_config.learning.policy == "idle"
    for _ in range(steps):
        force = (
            low + (high - low) / (1.0 + np.exp(-rng.normal(size=(2, count)))) if not is_idle else np.zeros((2, count))
        )
        velocity += heading * ((force[0] + force[1]) * (physics.dt / mass))
        velocity *= slowing
        velocity = np.clip(velocity.real, -max_speed, max_speed) + 1j * np.clip(velocity.imag, -max_speed, max_speed)
        spin = (spin + (force[1] - force[0]) * (lever * physics.dt)) * turning
        spin = np.clip(spin, -physics.max_angular_speed, physics.max_angular_speed)
        place += path * velocity
        boundary.stop(place, velocity, spin)
        angle += turn * spin
        heading = 1j * np.exp(1j * angle)
        velocity *= linear_decay
        spin *= angular_decay
        yield place, heading


class _Boundary:
    """The walls: the outer polygon as half planes, and inner walls as segments."""

    def __init__(self, config: Config, radius: float) -> None:
        corners = np.array([complex(*corner) for corner in outline(config.arena)])
        along = np.roll(corners, -1) - corners
        self.inward = -1j * along / np.abs(along)
        self.offset = (corners * self.inward.conj()).real + radius
        segments = walls(config.arena)[len(corners) :].astype(np.float64)
        ends = segments[:, ::2] + 1j * segments[:, 1::2]
        self.segments = [(a, b - a) for a, b in ends.tolist()]
        self.radius, self.friction = radius, config.physics.friction

    def stop(self, place: Points, velocity: Points, spin: Floats) -> None:
        """Moves bodies out of walls, removes the velocity into the wall, and makes them roll along it, in place."""
        gap = place.real[:, None] * self.inward.real + place.imag[:, None] * self.inward.imag - self.offset
        deepest = gap.argmin(axis=1)  # the other wall of a corner follows in the next step
        depth = -gap[np.arange(len(place)), deepest]
        indices = np.flatnonzero(depth >= 0)
        self._meet(indices, self.inward[deepest[indices]], depth[indices], place, velocity, spin)
        for start, span in self.segments:
            share = ((place - start) * span.conjugate()).real / max(abs(span) ** 2, 1e-12)
            separation = place - start - np.clip(share, 0.0, 1.0) * span
            distance = np.abs(separation)
            indices = np.flatnonzero(distance <= self.radius)
            self._meet(
                indices,
                separation[indices] / np.maximum(distance[indices], 1e-12),
                self.radius - distance[indices],
                place,
                velocity,
                spin,
            )

    def _meet(
        self, indices: NDArray[np.intp], normal: Points, depth: Floats, place: Points, velocity: Points, spin: Floats
    ) -> None:
        """Contact of some bodies with a wall, with normals that point away from it."""
        if not len(indices):
            return
        place[indices] += depth * normal
        speed = velocity[indices] * normal.conj()  # along the normal and along the wall
        approach_speed = np.minimum(speed.real, 0.0)
        slide = speed.imag - self.radius * spin[indices]
        grip = np.clip(
            -slide / 3.0, self.friction * approach_speed, -self.friction * approach_speed
        )  # for a disc: 1/(1 + m r²/I) = 1/3
        velocity[indices] += (-approach_speed + 1j * grip) * normal
        spin[indices] -= 2.0 * grip / self.radius
