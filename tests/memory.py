"""Writes into the memory of a world, as a memory error would: for tests of the checks that find it."""

import ctypes

import numpy as np

from hedon.experiment.simulation import Simulation


def overwrite(simulation: Simulation, world: int, path: str, index: int, value: float) -> None:
    """Overwrites number `index`, counted over all rows, of one array of a world's state."""
    view = simulation.engine.view(world, path)
    at = view.ctypes.data + int(np.dot(np.unravel_index(index, view.shape), view.strides))
    number = np.array([value]).astype(view.dtype)
    ctypes.memmove(at, number.ctypes.data, number.itemsize)
