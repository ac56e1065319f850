"""Overwrites a world's memory as a memory error would, to test the checks that detect it."""

import ctypes

import numpy as np

from hedon.experiment.simulation import Simulation


def overwrite(simulation: Simulation, world: int, path: str, index: int, value: float) -> None:
    """Overwrites one number in an array of a world's state; `index` counts across all rows."""
    view = simulation.engine.view(world, path)
    at = view.ctypes.data + int(np.dot(np.unravel_index(index, view.shape), view.strides))
    number = np.array([value]).astype(view.dtype)
    ctypes.memmove(at, number.ctypes.data, number.itemsize)
