"""Worlds in which the fitness of each genome is known: tables of agents from birth–death processes."""

from collections.abc import Callable
from heapq import heappop, heappush
from itertools import count

import numpy as np
import polars as pl
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def birth_death_world(
    genes: dict[str, Floats],
    birth: Callable[[dict[str, Floats]], Floats],
    rng: np.random.Generator,
    *,
    world: int = 0,
    death: float = 1e-3,
    steps: int = 2000,
) -> pl.DataFrame:
    """The agents of a world without mutation, in which birth and death have constant probabilities.

    A founder is expected to have exp((birth − death) · steps) living descendants at the end, and birth / death children
    in a full life.

    Args:
        genes: Genes of the founders, by column.
        birth: Probability of a birth per step, given the founders' genes.
        rng: Random number generator.
        world: Index of the world.
        death: Probability of death per step.
        steps: Length of the run.
    """
    rates = birth(genes)
    rows: list[tuple[int, int, int, int, int | None, int]] = []  # id, parent, founder, birth, death, generation
    children: dict[int, int] = {}
    number = count()  # breaks ties between births in the same step: whichever was queued first
    waiting = [(0, next(number), -1, i, 0) for i in range(len(rates))]
    while waiting:
        born, _, parent, line, generation = heappop(waiting)
        agent = len(rows)
        end = born + 1 + int(rng.exponential(1 / death))
        until = min(end, steps)
        rows.append((agent, parent, line, born, end if end <= steps else None, generation))
        times = born + 1 + rng.uniform(0, max(until - born - 1, 0), rng.poisson(rates[line] * (until - born)))
        children[agent] = len(times)
        for time in times:
            if int(time) < steps:
                heappush(waiting, (int(time), next(number), agent, line, generation + 1))
    agent_id, parent_id, line, born, died, generation = zip(*rows, strict=True)
    lines = np.array(line)
    lived = np.array([steps if end is None else end for end in died]) - np.array(born)
    return pl.DataFrame(
        {
            "world": np.full(len(rows), world, np.int32),
            "agent_id": np.array(agent_id, np.int64),
            "parent_id": pl.Series([None if parent < 0 else parent for parent in parent_id], dtype=pl.Int64),
            "generation": np.array(generation, np.int32),
            "birth_step": np.array(born, np.int64),
            "death_step": pl.Series(died, dtype=pl.Int64),
            "children": np.array([children[agent] for agent in agent_id], np.int32),
            "energy_gained": (lived * rates[lines]).astype(np.float32),
            **{name: values[lines].astype(np.float32) for name, values in genes.items()},
        }
    )
