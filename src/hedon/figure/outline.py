"""Finds the walls that enclose the arena."""

import numpy as np

_NEAR = 1e-2  # largest distance between the ends of joined walls [u]


def wall_outline(walls: np.ndarray) -> np.ndarray | None:
    """Follows the walls from the first one, end to end, until they close.

    Args:
        walls: Segments from (ax, ay) to (bx, by) [u], shape (w, 4), in any order and direction; inner walls
            may follow the outer ones.

    Returns:
        Corners of the closed polygon that the first wall belongs to [u], shape (n, 2); None if it does
        not close.
    """
    if len(walls) == 0:
        return None
    endpoints = walls.reshape(-1, 2, 2).astype(np.float64)
    unused = np.ones(len(endpoints), bool)
    unused[0] = False
    corners = [endpoints[0, 0], endpoints[0, 1]]
    while np.abs(corners[-1] - corners[0]).max() > _NEAR:
        close = (np.abs(endpoints - corners[-1]).max(axis=2) < _NEAR) & unused[:, None]  # (walls, two ends)
        if not close.any():
            return None
        wall, end = np.argwhere(close)[0]
        unused[wall] = False
        corners.append(endpoints[wall, 1 - end])
    return np.array(corners[:-1])
