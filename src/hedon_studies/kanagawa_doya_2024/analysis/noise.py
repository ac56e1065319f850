"""Recovers the table of tabulated mutation noise from the records of a world.

With `world.mutation_noise = "tabulated"`, the mutation of a gene depends on the seed, the gene and the number of
the birth (`walk.birth_number`). The change from parent to child therefore shows the table, except for children clipped
at the limit of weights. Weights are float32, so equal mutations agree to the rounding of a weight: 1e-6 at 10.

With independent noise there is no table, and births of equal number differ as much as any others.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.analysis import WorldRecord, birth_number, genealogy, is_mutated, mutation_law

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_NEAR = 1e-6
"""Distance from the limit, as a share of it, within which weights count as clipped."""
_SAME = 2.0
"""Largest difference between changes by one mutation, in float32 spacings at the limit; each is rounded by half of one
or less."""


@dataclass(frozen=True, eq=False)
class Mutations:
    """The changes of one gene at the births of a world, in order.

    Attributes:
        birth_step: Step of each birth [step], shape (n,).
        number: Number of each birth, see `walk.birth_number`, shape (n,).
        change: Weight of the child minus that of its parent, shape (n,).
        clipped: Whether the child's weight was clipped, so that the mutation exceeded the change, shape (n,).
        rounding: Spacing of float32 weights at the limit.
    """

    birth_step: Ints
    number: Ints
    change: Floats
    clipped: NDArray[np.bool_]
    rounding: float


@dataclass(frozen=True, eq=False)
class NoiseTable:
    """Mutations by number of birth.

    Attributes:
        value: Mutation of each number, shape (k,): the median change of births that were not clipped. If all were, the
            largest of their changes, which is a lower bound of the mutation's size; NaN for a number without births.
        births: Number of births with each number, shape (k,).
        bound: Whether the value is such a lower bound, shape (k,).
        disagreement: Largest difference between births of equal number that were not clipped.
        is_one: Whether they agree to rounding, as with tabulated noise.
    """

    value: Floats
    births: Ints
    bound: NDArray[np.bool_]
    disagreement: float
    is_one: bool


def mutations(world: WorldRecord, weight: str) -> Mutations:
    """All recorded mutations of one gene.

    The number of births is unknown after a gap in the records, so only births before the first gap are used.

    Args:
        world: The world.
        weight: Genome column of the gene.
    """
    complete_count = np.cumprod(world.agents["agent_id"].to_numpy() == np.arange(world.agents.height)).sum()
    agents = world.agents.head(int(complete_count))
    tree = genealogy(agents)
    law = mutation_law(world.config, world.gene(weight))
    child = np.flatnonzero(is_mutated(tree, law, world.last_step))
    weights = agents[weight].to_numpy().astype(np.float64)
    clipped = np.abs(weights[child]) >= law.limit * (1.0 - _NEAR)
    number = birth_number(tree, law.window, law.late)[child]
    change = weights[child] - weights[tree.parent[child]]
    return Mutations(tree.birth[child], number, change, clipped, float(np.spacing(np.float32(law.limit))))


def noise_table(found: Mutations) -> NoiseTable:
    """The noise table that explains some mutations."""
    size = int(found.number.max(initial=-1)) + 1
    value, spread = np.full(size, np.nan), np.zeros(size)
    births = np.bincount(found.number, minlength=size)
    bound = np.zeros(size, bool)
    for number in np.flatnonzero(births):
        has_number = found.number == number
        unclipped = found.change[has_number & ~found.clipped]
        bound[number] = not len(unclipped)
        changes = found.change[has_number]
        value[number] = np.median(unclipped) if len(unclipped) else changes[np.argmax(np.abs(changes))]
        spread[number] = np.ptp(unclipped) if len(unclipped) else 0.0
    largest = float(spread.max(initial=0.0))
    return NoiseTable(value, births, bound, largest, largest <= _SAME * found.rounding)
