"""The arena: walls, obstacles, and where things may be placed."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from reference.draw import Draws, normals, one_of, uniform

from hedon.config.config import Config
from hedon.config.schema.arena import outer_count, walls

TRIES = 20_000
"""The most draws for the place of one obstacle, one founder, or the first foods of a kind."""
Point = tuple[float, float]
Circle = tuple[float, float, float]


class Arena:
    """Walls and obstacles of one world. `obstacles` are polygons, as lists of their corners."""

    def __init__(self, config: Config, draw: Draws) -> None:
        self.width, self.height = (float(np.float32(side)) for side in (config.arena.width, config.arena.height))
        self.walls = walls(config.arena).astype(float).tolist()
        self.outline = self.walls[: outer_count(config.arena)]
        self.obstacles: list[list[Point]] = []
        around: list[Circle] = []
        for i in range(config.obstacle.count):
            found = (self._obstacle(config, draw("obstacle", i, 0, n)) for n in range(TRIES))
            cell = config.obstacle.cell
            circle, corners = next(
                each
                for each in found
                if (all(each[0][:2] != other[:2] for other in around) if cell else self._is_apart(each[0], around))
            )
            around.append(circle)
            self.obstacles.append(corners)
        self.walls += [[*a, *b] for polygon in self.obstacles for a, b in sides(polygon)]

    def _obstacle(self, config: Config, words: tuple[int, int, int, int]) -> tuple[Circle, list[Point]]:
        """A regular polygon: the circle around it, and its corners, clockwise."""
        own = config.obstacle
        x, y = self.anywhere(words)
        if own.cell:
            x, y = (
                own.cell * (math.floor(uniform(word) * math.floor(side / own.cell)) + 0.5)
                for word, side in zip(words, (self.width, self.height), strict=False)
            )
        first, last = (float(np.float32(angle)) for angle in (own.min_angle, own.max_angle))
        angle = first + (last - first) * uniform(words[2])
        side = own.min_side + (own.max_side - own.min_side) * uniform(words[3])
        radius = side / (2 * math.sin(math.pi / own.corners))
        turns = [angle - 2 * math.pi * corner / own.corners for corner in range(own.corners)]
        return (x, y, radius), [(x + radius * math.cos(turn), y + radius * math.sin(turn)) for turn in turns]

    def _is_apart(self, circle: Circle, others: Iterable[Circle]) -> bool:
        x, y, radius = circle
        return self.is_inside(x, y, radius) and not overlaps(x, y, radius, others)

    def anywhere(self, words: tuple[int, int, int, int]) -> Point:
        return self.width * uniform(words[0]), self.height * uniform(words[1])

    def is_inside(self, x: float, y: float, radius: float) -> bool:
        """Whether a disc is inside, touches no wall, and is in no obstacle."""
        if not encloses([wall[:2] for wall in self.outline], x, y):
            return False
        if any(wall_distance(x, y, wall) < radius for wall in self.walls):
            return False
        return not any(encloses(polygon, x, y) for polygon in self.obstacles)


def sides(polygon: Sequence[Point]) -> Iterable[tuple[Point, Point]]:
    return zip(polygon, [*polygon[1:], polygon[0]], strict=True)


def encloses(polygon: Sequence[Sequence[float]], x: float, y: float) -> bool:
    crossings = 0
    ax, ay = polygon[-1]
    for bx, by in polygon:
        crossings += (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax)
        ax, ay = bx, by
    return crossings % 2 == 1


def wall_distance(x: float, y: float, wall: Sequence[float]) -> float:
    ax, ay, bx, by = wall
    ex, ey = bx - ax, by - ay
    t = min(max(((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey), 0.0), 1.0)
    return math.hypot(ax + t * ex - x, ay + t * ey - y)


def overlaps(x: float, y: float, radius: float, circles: Iterable[Circle]) -> bool:
    return any((cx - x) ** 2 + (cy - y) ** 2 < (radius + r) ** 2 for cx, cy, r in circles)


def candidate(arena: Arena, placement, center: int, step: int, words: tuple[int, int, int, int]) -> Point:
    """A place for a new food; it may be outside the arena."""
    if placement.form == "uniform":
        return arena.anywhere(words)
    if placement.form == "mixture":
        center = one_of(words[2], len(placement.centers))
    start, drift = placement.centers[center], placement.drift
    ends = (arena.width, arena.height)
    middle = [min(max(start[axis] + drift[axis] * step, 0.0), ends[axis]) for axis in (0, 1)]
    square = placement.form == "rectangle"
    away = [2 * uniform(word) - 1 for word in words[:2]] if square else normals(*words[:2])
    x, y = (middle[axis] + placement.sd[axis] * away[axis] for axis in (0, 1))
    return x, y
