"""The arena: a rectangle with rounded corners and optional inner walls."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hedon.config.field import CODE, OURS, PAPER, setting

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class ArenaConfig:
    """The space in which agents live."""

    width: float = setting(480.0, "extent along x", "u", PAPER, gt=0, le=1e5, shapes=True)
    height: float = setting(360.0, "extent along y", "u", PAPER, gt=0, le=1e5, shapes=True)
    corner_radius: float = setting(
        19.0, "radius of the rounded corners; 0 leaves them square", "u", CODE, ge=0, le=1e5, derived=True
    )
    corner_chords: int = setting(
        4, "straight walls that make up each rounded corner", "", CODE, ge=1, le=64, derived=True
    )
    inner_walls: tuple[tuple[float, float, float, float], ...] = setting(
        (),
        "inner walls: a list of [ax, ay, bx, by], each a wall from (ax, ay) to (bx, by)",
        "u",
        OURS,
        max_items=256,
        each=(0, 1e5),
        derived=True,
    )


def outline(arena: ArenaConfig) -> list[tuple[float, float]]:
    """Corners of the outer polygon, clockwise from the lower end of the left wall.

    Returns:
        Points [u], each the start of an outer wall that ends at the next point.
    """
    w, h, r = arena.width, arena.height, arena.corner_radius
    if r == 0:
        return [(0.0, 0.0), (0.0, h), (w, h), (w, 0.0)]
    points = []
    for corner, (x, y) in enumerate([(r, r), (r, h - r), (w - r, h - r), (w - r, r)]):
        start = 1.5 * math.pi - corner * 0.5 * math.pi
        for i in range(arena.corner_chords + 1):
            angle = start - 0.5 * math.pi * i / arena.corner_chords
            points.append((x + r * math.cos(angle), y + r * math.sin(angle)))
    # The polygon starts with the left wall, so the points of the first corner come last.
    return points[arena.corner_chords :] + points[: arena.corner_chords]


def outer_count(arena: ArenaConfig) -> int:
    """Number of the first `walls` that form the closed outer polygon."""
    return 4 if arena.corner_radius == 0 else 4 * (arena.corner_chords + 1)


def walls(arena: ArenaConfig) -> "NDArray[np.float32]":
    """All walls: the outer polygon clockwise from the left wall, then the inner walls in their order.

    Returns:
        (count, 4) float32: ax, ay, bx, by of each segment [u]. Seen from a toward b, the inside of the outer polygon is
        on the right.
    """
    import numpy as np

    points = outline(arena)
    outer = [(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)]
    return np.array([*outer, *arena.inner_walls], dtype=np.float32)


def is_inside(arena: ArenaConfig, x: float, y: float) -> bool:
    """Whether a point [u] is within the outer polygon; a point on a wall counts as inside.

    Args:
        arena: Settings of the arena.
        x: Coordinate along its width [u].
        y: Coordinate along its height [u].
    """
    points = outline(arena)
    return all(
        (bx - ax) * (y - ay) - (by - ay) * (x - ax) <= 1e-6 * arena.width * arena.height
        for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True)
    )
