"""Selection on weights: differentials, gradients and curvature in a birth cohort, for two measures of fitness."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.agent.cohort import complete_share
from hedon.analysis.agent.lifetime import durations
from hedon.statistic.selection import (
    FEWEST,
    STATISTICS,
    linear_selection,
    quadratic_selection,
    relative_fitness,
    within_strata,
)

FITNESS = ("children", "lifespan")

Floats = NDArray[np.float64]


def selection(cohort: pl.DataFrame, names: Sequence[str], last_step: int) -> list[dict[str, Any]]:
    """Selection on each weight within one birth cohort.

    Args:
        cohort: Rows of the table `agents` of one world.
        names: Genome columns; all of them enter the multiple regression.
        last_step: End of the records [step].

    Returns:
        A row by fitness ("children" or "lifespan") and weight (genome column): agents, in the cohort; complete, the
        share of them that has died: if it is below 1, the end of the records truncates fitness; mean_fitness, children
        or steps; sd of the weight among contemporaries; differential s, in units of the weight; intensity s/σ; gradient
        β, per unit of the weight; standard_gradient β·σ. NaN for values that cannot be estimated.
    """
    traits = _Traits(cohort, names, last_step)
    tables = np.full((len(FITNESS), len(STATISTICS), len(names)), np.nan)
    if traits.count >= FEWEST:
        tables = linear_selection(traits.z, traits.relative_fitness())
    sd = traits.z.std(axis=0) if traits.count else np.full(len(names), np.nan)
    return [
        traits.head(fitness, name)
        | {"mean_fitness": mean, "sd": float(sd[i])}
        | dict(zip(STATISTICS, map(float, table[:, i]), strict=True))
        for fitness, mean, table in traits.by_fitness(tables)
        for i, name in enumerate(names)
    ]


def curvature(cohort: pl.DataFrame, names: Sequence[str], last_step: int) -> list[dict[str, Any]]:
    """Curvature along each weight within one birth cohort, with linear terms for all other weights.

    Args:
        cohort: Rows of the table `agents` of one world.
        names: Genome columns.
        last_step: End of the records [step].

    Returns:
        A row by fitness and weight, with agents and complete as for `selection`: curvature γ·σ²; NaN with fewer agents
        than `FEWEST`.
    """
    traits = _Traits(cohort, names, last_step)
    tables = np.full((len(FITNESS), len(names)), np.nan)
    if traits.count >= FEWEST:
        tables = quadratic_selection(traits.z, traits.relative_fitness())
    return [
        traits.head(fitness, name) | {"curvature": float(table[i])}
        for fitness, _, table in traits.by_fitness(tables)
        for i, name in enumerate(names)
    ]


class _Traits:
    """Weights of a cohort, as deviations from contemporaries, with the agents' fitness."""

    def __init__(self, cohort: pl.DataFrame, names: Sequence[str], last_step: int) -> None:
        self._cohort = cohort.sort("birth_step", "agent_id")
        duration, _ = durations(self._cohort, last_step)
        self._fitness = {"children": self._cohort["children"].to_numpy().astype(np.float64), "lifespan": duration}
        self.count = cohort.height
        self.complete = complete_share(cohort)
        self.z = within_strata(self._cohort.select(names).to_numpy().astype(np.float64))

    def head(self, fitness: str, weight: str) -> dict[str, Any]:
        """First columns of a row."""
        return {"fitness": fitness, "weight": weight, "agents": self.count, "complete": self.complete}

    def relative_fitness(self) -> Floats:
        """Fitness relative to contemporaries, a column per measure of fitness."""
        return np.stack([relative_fitness(self._fitness[name]) for name in FITNESS], axis=1)

    def by_fitness(self, tables: Floats) -> Iterator[tuple[str, float, Floats]]:
        """Yields each measure of fitness with its mean and its table, which is NaN if the mean is 0 or unknown."""
        for name, table in zip(FITNESS, tables, strict=True):
            mean = float(self._fitness[name].mean()) if self.count else float("nan")
            yield name, mean, table if mean > 0 else np.full_like(table, np.nan)
