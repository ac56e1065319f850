"""The kernels' rays against plain Python, on random scenes and on the cases where mistakes hide."""

from __future__ import annotations

import math

import numpy as np
import pytest
from learning_case import KERNELS
from ray_reference import Scene, cast, is_delicate

from hedon import _engine

FORWARD = np.array([[1.0, 0.0]])


def scene(
    circles: list[tuple[float, float, float, int]],
    segments: list[tuple[float, float, float, float]] | None = None,
    direction: np.ndarray = FORWARD,
) -> Scene:
    rows = np.array(circles, np.float64).reshape(-1, 4)
    walls = np.array(segments or [], np.float64).reshape(-1, 4)
    return Scene(rows[:, :3], rows[:, 3].astype(int), walls, direction)


def cast_by(kernel: str, case: Scene) -> tuple[np.ndarray, np.ndarray]:
    return _engine.kernel.cast_rays(
        kernel,
        np.ascontiguousarray(case.circles, np.float32),
        np.ascontiguousarray(case.circle_type, np.int32),
        np.ascontiguousarray(case.segments, np.float32),
        case.wall_type,
        np.ascontiguousarray(case.direction, np.float32),
        case.start,
        case.length,
    )


def fan(heading: float, rays: int = 24) -> np.ndarray:
    angle = heading + np.linspace(-math.pi / 3, math.pi / 3, rays)
    return np.stack([-np.sin(angle), np.cos(angle)], 1).astype(np.float32)


def random_scene(seed: int, rays: int = 24) -> Scene:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 80))
    place = rng.uniform(-250, 250, (count, 2))
    kind = rng.integers(0, 2, count)
    circles = np.column_stack([place, np.where(kind == 0, 10.0, 4.0)]).astype(np.float32)
    segments = rng.uniform(-250, 250, (int(rng.integers(0, 20)), 4)).astype(np.float32)
    return Scene(circles, kind, segments, fan(rng.uniform(0, 2 * math.pi), rays))


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("rays", [1, 16, 17, 24, 32])
def test_random_scenes(kernel: str, rays: int):
    compared = hits = 0
    for seed in range(40):
        case = random_scene(seed, rays)
        reading, kind = cast_by(kernel, case)
        expected_reading, expected_kind = cast(case)
        clear = ~is_delicate(case)
        compared += clear.sum()
        hits += (expected_kind[clear] > 0).sum()
        np.testing.assert_allclose(reading[clear], expected_reading[clear], rtol=0, atol=1e-5)
        close = np.abs(reading - expected_reading) < 1e-5
        np.testing.assert_array_equal(kind[clear & close], expected_kind[clear & close])
    assert compared > 0.8 * 40 * rays
    assert hits > 0.1 * 40 * rays


CASES = {
    "straight ahead": (scene([(60, 0, 10, 1)]), 2 - 40 / 200, 1),
    "behind": (scene([(-60, 0, 10, 1)]), 0.0, 0),
    "aside": (scene([(60, 10.01, 10, 1)]), 0.0, 0),
    "tangent": (scene([(60, 8, 8, 1)]), 2 - 50 / 200, 1),
    "hit at exactly the length": (scene([(214, 0, 4, 1)]), 1.0, 1),
    "just beyond the length": (scene([(214.001, 0, 4, 1)]), 0.0, 0),
    "start inside a circle": (scene([(13, 0, 10, 1)]), 2.0, 1),
    "center inside a circle, start too": (scene([(2, 0, 30, 1)]), 2.0, 1),
    "start at a circle's far side": (scene([(5, 0, 5, 1)]), 2.0, 1),
    "start past a circle's far side": (scene([(4.9, 0, 5, 1)]), 0.0, 0),
    "the nearer of two": (scene([(90, 0, 10, 1), (50, 0, 4, 0)]), 2 - 36 / 200, 0),
    "the first of two equals": (scene([(50, 0, 4, 1), (50, 0, 4, 0)]), 2 - 36 / 200, 1),
    "wall ahead": (scene([], [(70, -5, 70, 5)]), 2 - 60 / 200, 2),
    "wall between center and start": (scene([], [(6, -5, 6, 5)]), 2.0, 2),
    "wall behind the center": (scene([], [(-6, -5, -6, 5)]), 0.0, 0),
    "wall at exactly the length": (scene([], [(210, -5, 210, 5)]), 1.0, 2),
    "wall beyond the length": (scene([], [(210.001, -5, 210.001, 5)]), 0.0, 0),
    "wall that ends before the ray": (scene([], [(70, 0.01, 70, 5)]), 0.0, 0),
    "wall along the ray": (scene([], [(70, 0, 90, 0)]), 0.0, 0),
    "circle before wall at the same place": (scene([(74, 0, 4, 1)], [(70, -5, 70, 5)]), 2 - 60 / 200, 1),
    "circle hidden by a wall": (scene([(120, 0, 4, 1)], [(70, -5, 70, 5)]), 2 - 60 / 200, 2),
    "nothing": (scene([]), 0.0, 0),
}


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("name", CASES)
def test_single_cases(kernel: str, name: str):
    case, reading, kind = CASES[name]
    got, got_kind = cast_by(kernel, case)
    assert got[0] == pytest.approx(reading, abs=1e-6)
    assert got_kind[0] == kind


@pytest.mark.parametrize("kernel", KERNELS)
def test_no_ray_slips_through_where_walls_meet(kernel: str):
    corner = np.random.default_rng(1).uniform(20, 150, (200, 2)).astype(np.float32)
    for x, y in corner:
        direction = np.array([[x, y]], np.float32) / np.hypot(x, y)
        walls = [(x + 40, y - 40, x, y), (x, y, x - 40, y + 40)]
        reading, kind = cast_by(kernel, scene([], walls, direction))
        assert kind[0] == 2
        assert reading[0] == pytest.approx(2 - (np.hypot(x, y) - 10) / 200, abs=1e-5)
