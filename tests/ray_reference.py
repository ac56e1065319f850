"""Rays in plain Python and float64, the reference for the kernels."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass
class Scene:
    """Circles (n, 3: x, y, radius) and segments (m, 4) relative to the agent's center, and ray directions."""

    circles: np.ndarray
    circle_type: np.ndarray
    segments: np.ndarray
    direction: np.ndarray
    wall_type: int = 2
    start: float = 10.0
    length: float = 200.0


def circle_distance(x: float, y: float, radius: float, dx: float, dy: float, start: float) -> float | None:
    """Distance from the ray's start to the circle; 0 inside it; None if the ray misses it."""
    aside = dx * y - dy * x
    if abs(aside) > radius:
        return None
    along, reach = dx * x + dy * y, math.sqrt(radius**2 - aside**2)
    return max(0.0, along - reach - start) if along + reach >= start else None


def segment_distance(ax: float, ay: float, bx: float, by: float, dx: float, dy: float, start: float) -> float | None:
    """Distance from the ray's start to the segment; 0 if crossed before the start; None if the ray misses it."""
    ex, ey = bx - ax, by - ay
    across = dx * ey - dy * ex
    if across == 0.0:
        return None
    part, distance = (ax * dy - ay * dx) / across, (ax * ey - ay * ex) / across
    return max(0.0, distance - start) if 0.0 <= part <= 1.0 and distance >= 0.0 else None


def cast(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Reading + 1 and type of each ray."""
    reading, kind = np.zeros(len(scene.direction)), np.zeros(len(scene.direction), int)
    for r, (dx, dy) in enumerate(scene.direction.astype(np.float64).tolist()):
        hits = [
            (circle_distance(x, y, radius, dx, dy, scene.start), int(k))
            for (x, y, radius), k in zip(scene.circles.astype(np.float64).tolist(), scene.circle_type, strict=True)
        ]
        hits += [
            (segment_distance(ax, ay, bx, by, dx, dy, scene.start), scene.wall_type)
            for ax, ay, bx, by in scene.segments.astype(np.float64).tolist()
        ]
        near = [(d, k) for d, k in hits if d is not None and d <= scene.length]
        if near:
            distance, kind[r] = min(near, key=lambda hit: hit[0])
            reading[r] = 2.0 - distance / scene.length
    return reading, kind


def is_delicate(scene: Scene) -> np.ndarray:
    """Marks rays that nearly touch a circle's rim or a segment's end, or end at a hit, so that rounding decides."""
    dx, dy = scene.direction.astype(np.float64).T[:, :, None]
    x, y, radius = scene.circles.astype(np.float64).T[:, None, :]
    rim = np.abs(radius**2 - (dx * y - dy * x) ** 2) < 0.05
    far = np.abs(dx * x + dy * y + np.sqrt(np.maximum(radius**2 - (dx * y - dy * x) ** 2, 0)) - scene.start)
    ends = scene.segments.astype(np.float64).reshape(-1, 2)
    off = np.abs(dx * ends[:, 1] - dy * ends[:, 0]) < 1e-3
    at_end = np.abs(cast(scene)[0] - 1.0) < 1e-5
    return rim.any(1) | (far < 1e-3).any(1) | off.any(1) | at_end
