from pathlib import Path

import numpy as np
import pytest

from hedon.config import load_config
from hedon.config.schema.arena import ArenaConfig, is_inside, outer_count, walls

DATA = Path(__file__).parents[2] / "data" / "walls.npz"


@pytest.mark.parametrize("preset", ["baseline", "small", "large"])
def test_walls_match_those_of_the_papers_program(preset: str) -> None:
    found = walls(load_config(preset).arena)
    with np.load(DATA) as expected:
        np.testing.assert_allclose(found, expected[preset], atol=1e-4)
    assert found.dtype == np.float32


@pytest.mark.parametrize("chords", [1, 4, 9])
@pytest.mark.parametrize("radius", [0.0, 5.0, 49.0])
def test_outer_walls_close_and_inner_walls_follow(radius: float, chords: int) -> None:
    inner = ((10.0, 20.0, 30.0, 40.0), (50.0, 60.0, 50.0, 80.0))
    arena = ArenaConfig(100.0, 120.0, corner_radius=radius, corner_chords=chords, inner_walls=inner)
    found, count = walls(arena), outer_count(arena)
    np.testing.assert_array_equal(found[:count, 2:], np.roll(found[:count, :2], -1, axis=0))
    np.testing.assert_array_equal(found[count:], np.array(inner, dtype=np.float32))
    assert np.all(np.linalg.norm(found[:, 2:] - found[:, :2], axis=1) > 0)


def test_outer_walls_enclose_the_area_clockwise() -> None:
    arena = ArenaConfig(corner_chords=64)
    ax, ay, bx, by = walls(arena).astype(np.float64).T
    doubled = np.sum(ax * by - bx * ay)
    rounded_off = (4 - np.pi) * arena.corner_radius**2
    assert doubled / 2 == pytest.approx(-(arena.width * arena.height - rounded_off), rel=1e-5)


@pytest.mark.parametrize(
    ("x", "y", "inside"),
    [(240, 180, True), (0, 180, True), (480, 341, True), (1, 1, False), (-1, 180, False), (240, 361, False)],
)
def test_is_inside(x: float, y: float, inside: bool) -> None:
    assert is_inside(ArenaConfig(), x, y) is inside
