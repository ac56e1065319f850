"""The weights that agents act with, derived from their parameters in NumPy with identical bits."""

import numpy as np

HIDDEN = 64
AFTER_W2 = HIDDEN + 3 * HIDDEN + 16
"""Floats of a network after its two matrices: second bias, heads, and their biases with the log-sd."""


def to_bfloat16(x: np.ndarray) -> np.ndarray:
    """The upper 16 bits of each float32, rounded to nearest, ties to even."""
    bits = x.view(np.uint32).astype(np.uint64)
    return ((bits + 0x7FFF + (bits >> 16 & 1)) >> 16).astype(np.uint32)


def pair(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The float32 nearest to `first` among those with its sign whose lower bits are `second` in bfloat16.

    The distance is the number of float32 values in between; ties go to the larger magnitude.
    """
    lower, size = to_bfloat16(second).astype(np.int64), np.abs(first).view(np.uint32).astype(np.int64)
    upper = np.stack([(size >> 16) + 1, size >> 16, (size >> 16) - 1])
    candidates = np.where(upper < 0, 2**40, upper << 16 | lower)
    best = np.take_along_axis(candidates, np.abs(candidates - size).argmin(axis=0)[None], axis=0)[0]
    return (best | np.where(np.signbit(first), 1 << 31, 0)).astype(np.uint32).view(np.float32)


def unpair(words: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both weights of each pair, as agents read them."""
    return words, (words.view(np.uint32) << 16).view(np.float32)


def as_read(params: np.ndarray) -> np.ndarray:
    """Parameters of networks (..., size), with the two matrices as read by agents that act with bfloat16."""
    read = params.copy()
    count = params.shape[-1] - AFTER_W2
    blocks = read[..., :count].reshape(*params.shape[:-1], -1, 2, 16)
    blocks[..., 0, :], blocks[..., 1, :] = unpair(pair(blocks[..., 0, :].copy(), blocks[..., 1, :].copy()))
    read[..., :count] = blocks.reshape(*params.shape[:-1], count)
    b1 = slice(count - HIDDEN * (HIDDEN + 1), count - HIDDEN * HIDDEN)
    read[..., b1] = params[..., b1]  # enters unchanged, through the folded bias
    return read
