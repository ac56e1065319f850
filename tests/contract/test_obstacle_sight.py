"""Obstacles on a grid, and how rays misread them with the fault of the sequel's program, compared with plain NumPy."""

import re

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, make_simulation, set_scene

from hedon.config import ConfigError, load_config

COUNT, CELL, SIDE, LENGTH, RADIUS = 20, 40.0, 40.0, 200.0, 10.0
SQUARE = (
    *(*QUICK, *DEATHLESS, *CHILDLESS, "arena.width=960", "arena.height=960", "sensor.ray_count=32"),
    *("food.normal.initial_count=0", "food.normal.growth_rate=0", f"obstacle.count={COUNT}", f"obstacle.cell={CELL}"),
    *("obstacle.min_angle=1.5707963", "obstacle.max_angle=2.5707963"),
)
ANGLES = np.radians(np.linspace(-60, 60, 32))


def make(sight: str, *settings: str, seed: int = 1):
    return make_simulation(*SQUARE, f'obstacle.sight="{sight}"', *settings, seeds=[seed])


def test_obstacles_are_centered_in_cells_and_rotated_within_the_range():
    corners = np.concatenate([make("correct", seed=seed).worlds[0].obstacles for seed in range(1, 21)]).astype(float)
    cells = corners.mean(axis=1) / CELL - 0.5
    np.testing.assert_allclose(cells, np.round(cells), atol=1e-4)
    for world in np.round(cells).reshape(20, COUNT, 2):
        assert len({tuple(cell) for cell in world}) == COUNT
    assert cells.min() < 0.5  # cells at walls are included
    assert np.round(cells).max() == 23
    first = corners[:, 0] - corners.mean(axis=1)
    turn = np.arctan2(first[:, 1], first[:, 0]) - np.pi / 2
    assert -1e-4 < turn.min() < 0.05
    assert 0.95 < turn.max() < 1 + 1e-4
    # An obstacle at a wall extends beyond it.
    assert corners.min() < 0


def misread(corners: np.ndarray, place: np.ndarray, heading: float) -> np.ndarray:
    """What each ray reads of the obstacles, -1 for nothing: an independent version of the fault."""
    direction = np.stack([-np.sin(heading + ANGLES), np.cos(heading + ANGLES)], axis=-1)
    best = np.full(len(ANGLES), np.inf)
    for polygon in corners:
        center = polygon.mean(axis=0)
        arm = polygon[0] - center
        turn = np.arctan2(arm[1], arm[0]) - np.pi / 2
        spin = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        local = (polygon - center) @ spin  # the inverse: its corners in its own frame
        start = (place + RADIUS * direction) @ spin.T + center  # the fault: the forward transform
        way = LENGTH * direction @ spin.T
        for r in range(len(ANGLES)):
            entries, exits = [], [1.0]
            for a, b in zip(local, np.roll(local, -1, axis=0), strict=True):
                normal = np.array([a[1] - b[1], b[0] - a[0]])  # outward: the corners run clockwise
                speed = way[r] @ normal
                (entries if speed < 0 else exits).append((a - start[r]) @ normal / speed)
            first = min(entries)
            if 0 <= first <= min(exits):
                best[r] = min(best[r], first)
    return np.where(best <= 1, 1 - best, -1.0)


def test_rays_with_the_fault_read_the_same_as_plain_python():
    rng = np.random.default_rng(3)
    read = right = false = 0
    both = []
    for seed in range(1, 6):
        wrong, correct = make("released", seed=seed), make("correct", seed=seed)
        corners = wrong.worlds[0].obstacles.astype(float)
        np.testing.assert_array_equal(corners, correct.worlds[0].obstacles)
        for _ in range(20):
            x, y, heading = *rng.uniform(230, 730, 2), rng.uniform(0, 2 * np.pi)  # no wall is within reach
            seen = []
            for simulation in (wrong, correct):
                set_scene(simulation, [(x, y, heading)])
                seen.append(simulation.worlds[0].rays()[0][:, 3].astype(float))
            expected = misread(corners, np.array([x, y], np.float32).astype(float), float(np.float32(heading)))
            near_edge = np.abs(expected - seen[0]) > 1e-3
            assert near_edge.mean() <= 1 / 32  # if a ray just grazes a line, either reading is right
            both.append([each >= 0 for each in seen])
            read, right, false = read + (seen[0] >= 0).sum(), right + (seen[1] >= 0).sum(), false + 1
    assert min(read, right) > 0.05 * false * 32
    # Readings are almost uncorrelated with the obstacles, as in a run of the sequel's program: r = 0.01 to 0.08.
    assert abs(np.corrcoef(np.stack(both, axis=1).reshape(2, -1))[0, 1]) < 0.15


def test_nearer_bodies_hide_what_the_fault_reads():
    simulation = make("released", "population.capacity=2", "population.initial_count=1")
    rng = np.random.default_rng(5)
    hidden = 0
    for _ in range(40):
        x, y, heading = *rng.uniform(230, 730, 2), rng.uniform(0, 2 * np.pi)
        set_scene(simulation, [(x, y, heading)])
        alone = simulation.worlds[0].rays()[0]
        place = (x - 25 * np.sin(heading), y + 25 * np.cos(heading), 0.0)
        set_scene(simulation, [(x, y, heading), place])
        beside = simulation.worlds[0].rays()[0]
        agent = beside[:, 0] >= 0
        assert agent.any()
        assert (beside[agent, 3] == -1).all()
        assert (alone[agent, 3] <= beside[agent, 0]).all()
        np.testing.assert_array_equal(beside[~agent, 3], alone[~agent, 3])
        hidden += (alone[agent, 3] >= 0).sum()
    assert hidden > 10


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("obstacle.min_angle=3", "obstacle.min_angle = 3.0: must be at most obstacle.max_angle = 2"),
        ("obstacle.cell=0.5", "obstacle.cell = 0.5: must be 0, or from 1 to the shorter side of the arena, 360 [u]"),
        ("obstacle.cell=361", "obstacle.cell = 361.0: must be 0, or from 1"),
        ("obstacle.cell=200", "obstacle.count = 3: must be at most 1: half of the cells of 200 u"),
        ("obstacle.sight=right", 'obstacle.sight = "right": must be'),
    ],
)
def test_impossible_grids_are_refused(setting, message):
    with pytest.raises(ConfigError, match=re.escape(message)):
        load_config("baseline", overrides=["obstacle.count=3", "obstacle.max_angle=2", setting])
