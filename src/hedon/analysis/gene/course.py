"""Courses of a world's mean weights and of neutral genes on the same pedigree."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from hedon.analysis.descent.genealogy import depth, living_at
from hedon.analysis.descent.walk import mutation_law, neutral_courses
from hedon.analysis.gene.pedigree import walked_pedigree
from hedon.analysis.world.record import WorldRecord, generator

WALKS = 500
"""Neutral courses per world; the smallest p-value that they can show is 1 in 500."""
_INTERVALS = 100  # number of intervals in the longest world of a condition

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WorldCourse:
    """Mean weights over the living agents of one world, at equal intervals from its start.

    Attributes:
        generations: Mean generation of the agents alive at the end, minus that at the start.
        mean: Per genome column, shape (times,).
        neutral: Per genome column, courses of neutral genes that start as it does, shape (walks, times).
    """

    generations: float
    mean: Mapping[str, Floats]
    neutral: Mapping[str, Floats]

    @property
    def intervals(self) -> int:
        """Number of intervals between the values of a course."""
        return len(next(iter(self.mean.values()))) - 1


def world_course(
    world: WorldRecord, interval: float, rng: np.random.Generator, walks: int = WALKS
) -> WorldCourse | None:
    """Courses of one world.

    Args:
        world: Records of the world.
        interval: Time between two values [step].
        rng: Random number generator.
        walks: Number of neutral genes per course.

    Returns:
        None if no neutral gene can walk down the pedigree (see `walked_pedigree`), or no agent is alive at the end of
        the first interval.
    """
    tree = walked_pedigree(world)
    if tree is None:
        return None
    # The small excess keeps rounding from dropping the last time.
    times = np.arange(0.0, world.last_step * (1.0 + 1e-9), interval).astype(np.int64)
    living = [living_at(tree, int(time)) for time in times]
    ends = next((i for i, positions in enumerate(living) if not len(positions)), len(living))
    living = living[:ends]
    if len(living) < 2:
        return None
    generation = depth(tree)
    laws = {name: mutation_law(world.config, world.gene(name)) for name in world.weight_names}
    null = {law: neutral_courses(tree, living, law, rng, walks) for law in dict.fromkeys(laws.values())}
    means = {}
    for name in world.weight_names:
        values = world.agents[name].to_numpy().astype(np.float64)
        means[name] = np.array([values[positions].mean() for positions in living])
    return WorldCourse(
        float(generation[living[-1]].mean() - generation[living[0]].mean()),
        means,
        {name: null[law] for name, law in laws.items()},
    )


_KNOWN: WeakKeyDictionary[WorldRecord, tuple[float, WorldCourse | None]] = WeakKeyDictionary()


def standard_interval(worlds: Sequence[WorldRecord]) -> float:
    """Time between two values of the courses of one condition [step]: a hundredth of its longest world."""
    return max(max(world.last_step for world in worlds) / _INTERVALS, 1.0)


def standard_courses(worlds: Sequence[WorldRecord]) -> list[WorldCourse | None]:
    """Courses of the worlds of one condition, at the same times; cached, since walks take long.

    Returns:
        For each world, the result of `world_course` with the standard interval and the world's own random numbers.
    """
    interval = standard_interval(worlds)
    for world in worlds:
        if _KNOWN.get(world, (None, None))[0] != interval:
            _KNOWN[world] = interval, world_course(world, interval, generator(world))
    return [_KNOWN[world][1] for world in worlds]
