"""A second implementation of the contact solver `jacobi`, in NumPy and float64, based on docs/model.md, not the engine.

A scene has discs that move, circles that do not, and a clockwise ring of walls with the inside to the right. Each
contact joins `first` and `second`, which is -1 if it never moves; its normal points from the first to the second.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from physics_scene import CIRCLE_RADIUS, INERTIA, MASS, RADIUS

DT, VELOCITY_PASSES, POSITION_PASSES = 0.1, 6, 2
FRICTION, RESTITUTION, THRESHOLD = 0.2, 0.4, 1.0
RATE, SLOP, LARGEST_CORRECTION = 0.2, 0.005, 0.2
LEAST_DEPTH = 0.02
"""Smallest overlap on which the solver acts [u]."""

Name = tuple[str, int, int]


@dataclass
class Contacts:
    """The contacts of a substep; `name` identifies the pair of each one, to look up its impulses."""

    name: list[Name]
    first: np.ndarray
    second: np.ndarray
    normal: np.ndarray
    depth: np.ndarray

    def where(self, chosen: np.ndarray) -> "Contacts":
        """The chosen contacts."""
        names = [name for name, keep in zip(self.name, chosen, strict=True) if keep]
        return Contacts(names, self.first[chosen], self.second[chosen], self.normal[chosen], self.depth[chosen])


@dataclass
class ReferenceScene:
    """Bodies (n, 6): x, y, angle, x and y velocity, angular velocity. Impulses by pair [mass·u/s]."""

    bodies: np.ndarray
    circles: np.ndarray
    walls: np.ndarray
    impulse: dict[Name, tuple[float, float]] = field(default_factory=dict)
    touches: set[Name] = field(default_factory=set)
    margin: float = math.inf
    """How close the last substep came to a different decision on a touch, a contact or a bounce [u, u/s]."""

    def step(self, force: np.ndarray, torque: np.ndarray, substeps: int = 5) -> None:
        """Advances by one step; forces (n, 2) and torques (n,) act in the first substep."""
        for substep in range(substeps):
            self.substep(force * (substep == 0), torque * (substep == 0))

    def substep(self, force: np.ndarray, torque: np.ndarray) -> None:
        """Applies forces, damping and caps; then contacts, velocities, bounce, positions and motion."""
        state = self.bodies
        velocity = np.clip((state[:, 3:5] + force / MASS * DT) * math.exp(-0.8 * DT), -10.0, 10.0)
        spin = np.clip((state[:, 5] + torque / INERTIA * DT) * math.exp(-0.6 * DT), -math.pi, math.pi)
        moving = np.column_stack([velocity, spin])
        near = self.overlaps(-0.1)
        self.touches = set(near.where(near.depth >= 0).name)
        found = near.where(near.depth >= LEAST_DEPTH)
        self.margin = np.abs([*near.depth, *(near.depth - LEAST_DEPTH)]).min(initial=math.inf)
        self._solve(found, moving)
        state[:, :2] += _shift(found, len(state))
        state[:, 3:] = moving
        state[:, :2] += moving[:, :2] * DT
        state[:, 2] = np.mod(state[:, 2] + moving[:, 2] * DT, 2 * math.pi)
        self.keep_inside()

    def keep_inside(self) -> None:
        """Moves centers that are behind a wall to 0.001 u in front of it."""
        for start, end in self.walls.reshape(-1, 2, 2):
            inward = np.array([end[1] - start[1], start[0] - end[0]]) / np.hypot(*(end - start))
            behind = -(self.bodies[:, :2] - start) @ inward
            self.bodies[:, :2] += np.where(behind > 0, behind + 1e-3, 0.0)[:, None] * inward

    def overlaps(self, least: float) -> Contacts:
        """All pairs that overlap by `least` or more: bodies first, then circles, then walls."""
        place = self.bodies[:, :2]
        rows = []
        close = np.hypot(*(place[None] - place[:, None]).transpose(2, 0, 1)) <= 2 * RADIUS - least
        rows += [(("body", i, j), place[i], place[j], 2 * RADIUS) for i, j in np.argwhere(np.triu(close, 1)).tolist()]
        for i, center in enumerate(place):
            rows += [(("circle", i, j), center, point, RADIUS + CIRCLE_RADIUS) for j, point in enumerate(self.circles)]
        for i, center in enumerate(place):
            points = [self.wall_point(j, center) for j in range(len(self.walls))]
            rows += [(("wall", i, j), center, point, RADIUS) for j, point in enumerate(points) if point is not None]
        between = np.array([point - center for _, center, point, _ in rows]).reshape(-1, 2)
        distance = np.hypot(*between.T)
        name = [row[0] for row in rows]
        all_pairs = Contacts(
            name,
            np.array([first for _, first, _ in name], int),
            np.array([second if kind == "body" else -1 for kind, _, second in name], int),
            between / distance[:, None],
            np.array([touch for *_, touch in rows]) - distance,
        )
        return all_pairs.where(all_pairs.depth >= least)

    def wall_point(self, wall: int, center: np.ndarray) -> np.ndarray | None:
        """The contact point of a wall for a body; None behind the wall, or beyond an end that the rule excludes."""
        start, end = self.walls[wall, :2], self.walls[wall, 2:]
        before, after = self.walls[wall - 1, :2], self.walls[(wall + 1) % len(self.walls), 2:]
        along, offset = end - start, center - start
        if along[0] * offset[1] - along[1] * offset[0] > 0:
            return None
        if offset @ along <= 0 and (after - end) @ (center - end) > 0:
            return None
        if (end - center) @ along <= 0 and (start - before) @ (center - start) <= 0:
            return None
        return start + min(max(offset @ along / (along @ along), 0.0), 1.0) * along

    def _solve(self, found: Contacts, moving: np.ndarray) -> None:
        """Runs six Jacobi passes and the bounce; updates `moving`, (n, 3), and the stored impulses."""
        first, second, depth = found.first, found.second, found.depth
        normal, tangent = found.normal, np.column_stack([-found.normal[:, 1], found.normal[:, 0]])
        pair = second >= 0
        arm = RADIUS - depth / 2
        normal_mass = MASS / (1 + pair)
        tangent_mass = 1 / ((1 + pair) * (1 / MASS + arm**2 / INERTIA))
        bias = RATE / DT * np.maximum(0, depth - SLOP)

        def relative() -> tuple[np.ndarray, np.ndarray]:
            """Relative velocities at the contacts, along normal and tangent."""
            other = np.where(pair[:, None], moving[second], 0.0)
            speed = other[:, :2] - moving[first, :2]
            return (speed * normal).sum(1), (speed * tangent).sum(1) - arm * (moving[first, 2] + other[:, 2])

        def apply(push: np.ndarray, rub: np.ndarray) -> None:
            """Applies the impulses of all contacts to the bodies."""
            impulse = push[:, None] * normal + rub[:, None] * tangent
            turn = arm * rub / INERTIA
            np.subtract.at(moving[:, :2], first, impulse / MASS)
            np.subtract.at(moving[:, 2], first, turn)
            np.add.at(moving[:, :2], second[pair], impulse[pair] / MASS)
            np.subtract.at(moving[:, 2], second[pair], turn[pair])

        push, rub = np.array([self.impulse.get(name, (0.0, 0.0)) for name in found.name]).reshape(-1, 2).T
        approach, _ = relative()
        for number in range(VELOCITY_PASSES):
            along, aside = relative()
            if number == 0:  # Each contact sees its two bodies with its stored impulse, which is never applied to them.
                along, aside = along + push / normal_mass, aside + rub / tangent_mass
            new_rub = np.clip(rub - tangent_mass * aside, -FRICTION * push, FRICTION * push)
            new_push = np.maximum(0, push + normal_mass * (bias - along))
            apply(new_push - push, new_rub - rub)
            push, rub = new_push, new_rub
        along, _ = relative()
        bounce = np.where(approach <= -THRESHOLD, -normal_mass * (along + RESTITUTION * approach), 0.0)
        apply(bounce, np.zeros_like(rub))
        self.margin = np.abs(approach + THRESHOLD).min(initial=self.margin)
        self.impulse = dict(zip(found.name, zip(push.tolist(), rub.tolist(), strict=True), strict=True))


def _shift(found: Contacts, bodies: int) -> np.ndarray:
    """How far two Jacobi position passes move each body, (n, 2)."""
    pair = found.second >= 0
    shift = np.zeros((bodies, 2))
    for _ in range(POSITION_PASSES):
        other = np.where(pair[:, None], shift[found.second], 0.0)
        separation = ((other - shift[found.first]) * found.normal).sum(1) - found.depth
        correction = np.clip(RATE * (separation + SLOP), -LARGEST_CORRECTION, 0.0)
        move = (-correction / (1 + pair))[:, None] * found.normal
        change = np.zeros_like(shift)
        np.subtract.at(change, found.first, move)
        np.add.at(change, found.second[pair], move[pair])
        shift += change
    return shift
