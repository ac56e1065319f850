"""The engine's counter-based random numbers, reimplemented with plain Python integers."""

import math
from functools import lru_cache

PURPOSES = (
    *("action", "life_and_death", "parent_order", "child_place", "child_heading", "mutation", "initial_genome"),
    *("initial_place", "network", "minibatch", "food_place", "frozen_mutation", "initial_heading", "initial_food"),
    *("vacant_network", "vacant_genome", "hunt", "obstacle", "inherited_network", "recombination"),
)
"""The purposes of draws, in the order of their numbers."""


@lru_cache(maxsize=10_000)
def philox(counter: tuple[int, int, int, int], key: tuple[int, int]) -> tuple[int, int, int, int]:
    """Philox4x32-10. Source: Salmon et al. (2011)."""
    mask = 0xFFFFFFFF
    c0, c1, c2, c3 = counter
    k0, k1 = key
    for _ in range(10):
        a, b = 0xD2511F53 * c0, 0xCD9E8D57 * c2
        c0, c1, c2, c3 = (b >> 32) ^ c1 ^ k0, b & mask, (a >> 32) ^ c3 ^ k1, a & mask
        k0, k1 = (k0 + 0x9E3779B9) & mask, (k1 + 0xBB67AE85) & mask
    return c0, c1, c2, c3


class Draws:
    """The draws of one world."""

    def __init__(self, seed: int) -> None:
        self.key = (seed & 0xFFFFFFFF, seed >> 32)

    def __call__(self, purpose: str, of: int, step: int, index: int = 0) -> tuple[int, int, int, int]:
        return philox((index, PURPOSES.index(purpose), of, step), self.key)


def uniform(word: int) -> float:
    return (word >> 8) / 2**24


def fine_uniform(high: int, low: int) -> float:
    return (((high << 32) | low) >> 11) / 2**53


def normals(word0: int, word1: int) -> tuple[float, float]:
    radius = math.sqrt(-2 * math.log((word0 + 0.5) / 2**32))
    angle = 2 * math.pi * (word1 + 0.5) / 2**32
    return radius * math.cos(angle), radius * math.sin(angle)


def cauchy(word: int) -> float:
    return math.tan(math.pi * ((word + 0.5) / 2**32 - 0.5))


def student_t(df: float, word0: int, word1: int) -> float:
    """Bailey (1994), the polar method."""
    radius = math.sqrt(df * (((word0 + 0.5) / 2**32) ** (-2 / df) - 1))
    return radius * math.cos(2 * math.pi * (word1 + 0.5) / 2**32)


def open_uniform(word: int) -> float:
    return (word + 0.5) / 2**32


def one_of(word: int, count: int) -> int:
    return word * count >> 32
