"""The table of tabulated mutation noise, read off the records of a world.

With `world.mutation_noise = "tabulated"` a birth's mutation of a gene depends on the seed, the gene and the number of
the birth (`walk.birth_number`). So the change from parent to child shows the table, but for children clipped at
the limit of weights. Weights are float32, so equal mutations agree to the rounding of a weight: 1e-6 at 10.

With independent noise the same computation gives no table, and births of equal number disagree as much as any.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.analysis import WorldRecord, birth_number, genealogy, is_mutated, mutation_law

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_NEAR = 1e-6
"""Weights this near to the limit, as a share of it, count as clipped."""
_SAME = 2.0
"""Spacings of float32 at the limit up to which changes are one mutation: each is rounded by half of one, or less."""


@dataclass(frozen=True, eq=False)
class Mutations:
    """How one gene changed at the births of a world, in their order.

    Attributes:
        birth_step: of each [step], (n,).
        number: of each birth, see `walk.birth_number`, (n,).
        change: child's weight − parent's, (n,).
        clipped: whether the child's was clipped, so that the mutation was larger than the change, (n,).
        rounding: distance of neighboring weights at the limit.
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
        value: of each number: the median change of births that were not clipped. Where all were, the largest of their
            changes, a lower bound of the mutation's size; NaN for a number that no birth has, (k,).
        births: of each number, (k,).
        bound: whether the value is such a bound, (k,).
        disagreement: largest difference between births of equal number that were not clipped.
        is_one: whether they agree to rounding, as with tabulated noise.
    """

    value: Floats
    births: Ints
    bound: NDArray[np.bool_]
    disagreement: float
    is_one: bool


def mutations(world: WorldRecord, weight: str) -> Mutations:
    """All recorded mutations of one gene.

    Births after a gap in the records have no known number, so only those before the first are taken.
    """
    whole = np.cumprod(world.agents["agent_id"].to_numpy() == np.arange(world.agents.height)).sum()
    agents = world.agents.head(int(whole))
    tree = genealogy(agents)
    law = mutation_law(world.config, world.gene(weight))
    child = np.flatnonzero(is_mutated(tree, law, world.last_step))
    weights = agents[weight].to_numpy().astype(np.float64)
    clipped = np.abs(weights[child]) >= law.limit * (1.0 - _NEAR)
    number = birth_number(tree, law.window, law.late)[child]
    change = weights[child] - weights[tree.parent[child]]
    return Mutations(tree.birth[child], number, change, clipped, float(np.spacing(np.float32(law.limit))))


def noise_table(found: Mutations) -> NoiseTable:
    """The table that some mutations show."""
    size = int(found.number.max(initial=-1)) + 1
    value, spread = np.full(size, np.nan), np.zeros(size)
    births = np.bincount(found.number, minlength=size)
    bound = np.zeros(size, bool)
    for number in np.flatnonzero(births):
        mine = found.number == number
        free = found.change[mine & ~found.clipped]
        bound[number] = not len(free)
        changes = found.change[mine]
        value[number] = np.median(free) if len(free) else changes[np.argmax(np.abs(changes))]
        spread[number] = np.ptp(free) if len(free) else 0.0
    largest = float(spread.max(initial=0.0))
    return NoiseTable(value, births, bound, largest, largest <= _SAME * found.rounding)
