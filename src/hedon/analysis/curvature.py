"""Does selection favor a middle value of a weight? Quadratic gradients of Lande & Arnold (1983).

In the regression of relative fitness on all weights z and on half the square of one of them, the coefficient of that
square is γ, the curvature of fitness: below 0 selection is stabilizing, and agents in the middle have more children
than those on either side; above 0 it is disruptive. Standardized, γ·σ² is per variance of the weight.

Mutations with Cauchy tails put a few agents far out, and a regression on squares would follow these alone. Weights are
therefore drawn in to ± 3 standard deviations of contemporaries.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.bootstrap import REPLICATES, percentile_interval, resampled_sums
from hedon.analysis.cohort import complete_share
from hedon.analysis.selection import FEWEST, FITNESS, relative_fitness, sibships, within_strata
from hedon.analysis.survival import durations

REACH = 3.0
"""Standard deviations to which weights are drawn in."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Curvature:
    """The curvature of fitness along one weight in one cohort.

    Attributes:
        fitness: "children" or "lifespan".
        weight: genome column.
        agents: in the cohort.
        complete: share of them that has died.
        curvature: γ·σ²; NaN where it cannot be estimated, as its bounds.
        low, high: bounds of the bootstrap's 95 % interval.
    """

    fitness: str
    weight: str
    agents: int
    complete: float
    curvature: float
    low: float
    high: float


def curvature(
    cohort: pl.DataFrame,
    names: Sequence[str],
    last_step: int,
    rng: np.random.Generator,
    replicates: int = REPLICATES,
) -> list[Curvature]:
    """Curvature along each weight within one birth cohort, all other weights held fixed by their linear parts.

    Args:
        cohort: rows of the table `agents` of one world.
        names: genome columns.
        last_step: up to which the records reach [step].
        rng: source of chance.
        replicates: bootstrap samples of sibships.

    Returns:
        By fitness and weight.
    """
    cohort = cohort.sort("birth_step", "agent_id")
    lived, _ = durations(cohort, last_step)
    fitness = {"children": cohort["children"].to_numpy().astype(np.float64), "lifespan": lived}
    complete, results = complete_share(cohort), []
    table = np.full((len(FITNESS), len(names), 3), np.nan)
    if cohort.height >= FEWEST:
        z = standardized(within_strata(cohort.select(names).to_numpy().astype(np.float64)))
        omega = np.stack([relative_fitness(fitness[name]) for name in FITNESS], axis=1)
        table = _estimates(z, omega, sibships(cohort), rng, replicates)
    for name, rows in zip(FITNESS, table, strict=True):
        has_fitness = cohort.height > 0 and fitness[name].mean() > 0
        for weight, numbers in zip(names, rows, strict=True):
            value, low, high = (float(x) if has_fitness else float("nan") for x in numbers)
            results.append(Curvature(name, weight, cohort.height, complete, value, low, high))
    return results


def standardized(z: Floats) -> Floats:
    """Weights in standard deviations, drawn in to ± `REACH`; what does not vary is 0, shape (n, p) as given."""
    sd = z.std(axis=0)
    return np.clip(z / np.where(sd > 1e-9, sd, np.inf), -REACH, REACH)


def _estimates(
    z: Floats, omega: Floats, cluster: NDArray[np.int64], rng: np.random.Generator, replicates: int
) -> Floats:
    """Value and bounds, shape (fitness, p, 3).

    By Frisch, Waugh and Lovell, the coefficient of the square is that of a regression of what the weights leave of
    fitness on what they leave of the square. That part is taken from the whole cohort also in a bootstrap sample.
    """
    n, p = z.shape
    design = np.column_stack([np.ones(n), z])
    scale = np.std(z, axis=0)
    square = 0.5 * (z / np.where(scale > 0, scale, 1.0)) ** 2  # in units of the variance after drawing in
    rest_square, rest_omega = (y - design @ np.linalg.lstsq(design, y, rcond=None)[0] for y in (square, omega))
    products = (rest_square[:, :, None] * rest_omega[:, None, :]).reshape(n, -1)
    features = np.hstack([products, rest_square**2])
    sums = np.concatenate([features.sum(axis=0, keepdims=True), resampled_sums(features, cluster, rng, replicates)])
    with np.errstate(divide="ignore", invalid="ignore"):
        gamma = sums[:, :-p].reshape(len(sums), p, -1) / sums[:, -p:, None]
    gamma[:, scale <= 0] = np.nan
    low, high = percentile_interval(gamma[1:])
    return np.stack([gamma[0], low, high], axis=-1).transpose(1, 0, 2)
