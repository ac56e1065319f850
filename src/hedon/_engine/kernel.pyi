"""Single kernels: one implementation per instruction set."""

from typing import Annotated

import numpy
from numpy.typing import NDArray


def kernel_names() -> list[str]:
    """Names of the kernels that this processor can run, best first."""

def cast_rays(kernel: str, circles: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', device='cpu', writable=False)], circle_type: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', device='cpu', writable=False)], wall_type: int, direction: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', device='cpu', writable=False)], start: float, length: float, repeats: int = 1) -> tuple:
    """
    Reading + 1 and type of each ray. circles (n, 3: x, y, radius) and segments (m, 4) relative to the center; computed `repeats` times, for timing.
    """

def calibrate(kernel: str, rounds: int) -> float:
    """
    Multiply-adds in registers on this thread [GF/s]: the limit for the other kernels. Releases the interpreter lock.
    """

def read_rate(kernel: str, bytes: int, rounds: int) -> float:
    """
    An array of `bytes` read again and again on this thread [GB/s]. Releases the interpreter lock.
    """
