"""Checks of arguments from Python and the command line: numbers, seeds, folders."""

from collections.abc import Iterable
from contextlib import suppress
from itertools import islice
from operator import index
from pathlib import Path
from typing import Any

from hedon.error import ArgumentError
from hedon.text import brief

MAX_SEED = 2**63 - 1
"""Largest seed of a run: records store seeds as signed 64-bit integers."""
MAX_WORLDS = 10_000
MAX_STEPS = 2**31 - 1
MAX_DIGITS = 40
"""Maximum digits of a seed, including leading zeros."""
MAX_THREADS = 1024
MAX_SECONDS = 1e9
INSTRUCTION_SETS = ("avx512", "avx2", "neon", "portable")
"""Instruction sets that the engine can use, fastest first; a processor supports some of them."""
DEVICES = ("cuda",)
"""Backends that are devices, not instruction sets of the processor."""


def integer(name: str, value: Any, low: int, high: int) -> int:
    """Returns an integer within bounds; NumPy integers are valid too.

    Raises:
        ArgumentError: The value is not an integer within the bounds.
    """
    with suppress(TypeError):
        if not isinstance(value, bool) and low <= index(value) <= high:
            return index(value)
    raise ArgumentError(f"{name} = {_text(value)}: must be a whole number from {low:,} to {high:,}")


def number(name: str, value: Any, low: float, high: float) -> float:
    """Returns a number within bounds.

    Raises:
        ArgumentError: The value is not a number within the bounds.
    """
    with suppress(TypeError, ValueError, OverflowError):
        if not isinstance(value, str | bool) and low <= float(value) <= high:
            return float(value)
    raise ArgumentError(f"{name} = {_text(value)}: must be a number from {low:g} to {high:g}")


def seed_list(values: Any, largest: int = MAX_SEED) -> tuple[int, ...]:
    """Returns seeds as a tuple, one per world.

    Raises:
        ArgumentError: The value is not a list of integers, it is empty or too long, or a seed is out of bounds.
    """
    if isinstance(values, str | bytes) or not isinstance(values, Iterable):
        raise ArgumentError(f"seeds = {_text(values)}: must be a list of whole numbers, one per world, such as [1, 2]")
    seeds = tuple(integer("seeds", value, 0, largest) for value in islice(values, MAX_WORLDS + 1))
    if not 1 <= len(seeds) <= MAX_WORLDS:
        number_of = f"more than {MAX_WORLDS:,}" if seeds else "none"
        raise ArgumentError(f"seeds: there must be from 1 to {MAX_WORLDS:,}, one per world, not {number_of}")
    return seeds


def different(seeds: tuple[int, ...], place: str = "seeds") -> tuple[int, ...]:
    """Returns the seeds if they all differ.

    Raises:
        ArgumentError: A seed appears twice.
    """
    seen: set[int] = set()
    for seed in seeds:
        if seed in seen:
            raise ArgumentError(f"{place}: {seed} appears twice; equal seeds give equal worlds")
        seen.add(seed)
    return seeds


def parse_seeds(text: str, place: str = "seeds") -> tuple[int, ...]:
    """Parses seeds from "7", "1-5", "1,4,7-9" or "[1, 4]".

    Raises:
        ArgumentError: The text is not such a list, a seed is out of range, there are too many, or one appears twice.
    """
    seeds: list[int] = []
    for item in map(str.strip, text.strip().removeprefix("[").removesuffix("]").split(",")):
        first, dash, last = item.partition("-")
        if not first and last.isdecimal():
            raise ArgumentError(f"{place}: {brief(item)} is negative: a seed is a whole number from 0 to {MAX_SEED}")
        if not first.isdecimal() or (dash and not last.isdecimal()):
            raise ArgumentError(f"{place}: {brief(text)!r} is not a list of seeds such as 7, 1-5 or 1,4,7-9")
        if any(len(number) > 1 and number.startswith("0") for number in (first, last)):
            raise ArgumentError(
                f"{place}: {brief(item)!r} begins with 0; commas separate seeds, so write 1000 rather than 1,000"
            )
        if max(len(first), len(last)) > MAX_DIGITS:
            raise ArgumentError(f"{place}: a seed of {max(len(first), len(last)):,} digits is larger than {MAX_SEED}")
        low, high = int(first), int(last or first)
        if high < low or high > MAX_SEED or high - low >= MAX_WORLDS:
            raise ArgumentError(
                f"{place}: {item!r} is not a range of seeds from 0 to {MAX_SEED}, at most {MAX_WORLDS:,} of them"
            )
        seeds += range(low, high + 1)
    return different(seed_list(seeds), place)


def folder(name: str, value: Any) -> Path:
    """Returns a path from a path or a string.

    Raises:
        ArgumentError: The value is neither, or is empty, or has a null character.
    """
    if not isinstance(value, str | Path) or not str(value) or "\0" in str(value):
        raise ArgumentError(f"{name} = {_text(value)}: must be the path of a folder")
    return Path(value)


def _text(value: Any) -> str:
    try:
        return brief(repr(value), 60)
    except ValueError:  # Python does not print integers of thousands of digits
        return "an integer of thousands of digits"
