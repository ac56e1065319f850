"""Which weights does selection favor, and how strongly? Differentials and gradients of Lande & Arnold (1983).

With ω = W / mean W the relative fitness of an agent and z its weights, the *differential* s = Cov(ω, z) is how far
selection within a generation moves the mean weight, by whatever route; the *gradient* β = Cov(z)⁻¹ s, the slopes
of the multiple regression of ω on all weights, is what a weight does by itself, others held fixed. Standardized
to the weight's standard deviation σ they are s/σ and β·σ: change of relative fitness per standard deviation.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.bootstrap import REPLICATES, percentile_interval, resampled_sums
from hedon.analysis.cohort import complete_share
from hedon.analysis.survival import durations

FITNESS = ("children", "lifespan")
STRATUM = 200
"""Births that are compared with one another. Agents are compared with contemporaries alone: where weights and mean
fitness both drift within a window, a comparison across it would show selection that is none."""
FEWEST = 50
"""Agents below which nothing is estimated."""
_ROUNDING = 1e-9  # deviations below which a weight does not vary
STATISTICS = ("differential", "intensity", "gradient", "standard_gradient")

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Selection:
    """Selection on one weight in one cohort, by one measure of fitness.

    Attributes:
        fitness: "children" or "lifespan".
        weight: genome column.
        agents: in the cohort.
        complete: share of them that has died: below 1, fitness is cut short by the end of the records.
        mean_fitness: children, or steps.
        sd: standard deviation of the weight among contemporaries.
        differential: s, in units of the weight; NaN where it cannot be estimated, as all below.
        intensity: s/σ.
        gradient: β, per unit of the weight.
        standard_gradient: β·σ.
        differential_low, …_high: bounds of the bootstrap's 95 % interval of each.
    """

    fitness: str
    weight: str
    agents: int
    complete: float
    mean_fitness: float
    sd: float
    differential: float
    differential_low: float
    differential_high: float
    intensity: float
    intensity_low: float
    intensity_high: float
    gradient: float
    gradient_low: float
    gradient_high: float
    standard_gradient: float
    standard_gradient_low: float
    standard_gradient_high: float


def selection(
    cohort: pl.DataFrame,
    names: Sequence[str],
    last_step: int,
    rng: np.random.Generator,
    replicates: int = REPLICATES,
) -> list[Selection]:
    """Selection on each weight within one birth cohort.

    Intervals are percentiles of a bootstrap that draws sibships as wholes, since siblings share their
    mother's place and energy. They take sibships as independent; for statements about a condition use the
    spread over worlds.

    Args:
        cohort: rows of the table `agents` of one world.
        names: genome columns; all of them enter the multiple regression.
        last_step: up to which the records reach [step].
        rng: source of chance.
        replicates: bootstrap samples.

    Returns:
        By fitness and weight.
    """
    cohort = cohort.sort("birth_step", "agent_id")
    weights = cohort.select(names).to_numpy().astype(np.float64)
    lived, _ = durations(cohort, last_step)
    fitness = {"children": cohort["children"].to_numpy().astype(np.float64), "lifespan": lived}
    complete = complete_share(cohort)
    z = within_strata(weights)
    z[:, np.abs(z).max(axis=0, initial=0.0) < _ROUNDING] = 0.0
    sd = z.std(axis=0) if len(z) else np.full(len(names), np.nan)
    tables = np.full((len(FITNESS), 3, len(STATISTICS), len(names)), np.nan)
    if cohort.height >= FEWEST:
        omega = np.stack([relative_fitness(fitness[name]) for name in FITNESS], axis=1)
        tables = _estimates(z, omega, sd, sibships(cohort), rng, replicates)
    results = []
    for name, table in zip(FITNESS, tables, strict=True):
        mean = float(fitness[name].mean()) if cohort.height else float("nan")
        for i, weight in enumerate(names):
            numbers = {
                f"{statistic}{bound}": float(table[b, k, i]) if mean > 0 else float("nan")
                for k, statistic in enumerate(STATISTICS)
                for b, bound in enumerate(("", "_low", "_high"))
            }
            results.append(Selection(name, weight, cohort.height, complete, mean, float(sd[i]), **numbers))
    return results


def differential_and_gradient(z: Floats, omega: Floats) -> tuple[Floats, Floats]:
    """s = Cov(ω, z) and β = Cov(z)⁻¹ s.

    Args:
        z: weights, shape (n, p).
        omega: relative fitness, shape (n,).

    Returns:
        Each (p,). The gradient of a weight without variance is NaN, and the others are as without it.
    """
    features = _features(z, omega[:, None])
    s, beta = _solve(features.sum(axis=0, keepdims=True), z.shape[1], 0)
    return s[0], beta[0]


def _estimates(
    z: Floats, omega: Floats, sd: Floats, cluster: NDArray[np.int64], rng: np.random.Generator, replicates: int
) -> Floats:
    """Value and bounds of the four statistics of each weight, by measure of fitness, shape (f, 3, 4, p).

    All measures are taken from the same bootstrap samples, since making these takes nearly all the time.
    """
    scale = np.where(sd > 0, sd, 1.0)
    features = _features(z / scale, omega)
    sums = np.concatenate([features.sum(axis=0, keepdims=True), resampled_sums(features, cluster, rng, replicates)])
    varies = np.where(sd > 0, 1.0, np.nan)
    tables = []
    for k in range(omega.shape[1]):
        s, beta = _solve(sums, z.shape[1], k)
        # In units of the whole cohort's standard deviation, also within a bootstrap sample.
        statistics = np.stack([s * scale, s * varies, beta / scale, beta], axis=1)  # (1 + replicates, 4, p)
        low, high = percentile_interval(statistics[1:])
        tables.append(np.stack([statistics[0], low, high]))
    return np.stack(tables)


def _features(z: Floats, omega: Floats) -> Floats:
    """What has to be summed over agents for all moments: 1, z, the upper triangle of zz, and each ω with its ωz.

    Args:
        z: weights, shape (n, p).
        omega: relative fitness by each measure, shape (n, f).
    """
    first, second = np.triu_indices(z.shape[1])
    parts = [np.ones((len(z), 1)), z, z[:, first] * z[:, second]]
    for column in omega.T:
        parts += [column[:, None], column[:, None] * z]
    return np.hstack(parts)


def _solve(sums: Floats, p: int, measure: int) -> tuple[Floats, Floats]:
    """Differentials and gradients on one measure of fitness from sums of features, each (samples, p)."""
    means = sums[:, 1:] / sums[:, :1]
    first, second = np.triu_indices(p)
    begin = p + len(first) + measure * (1 + p)
    z, zz = means[:, :p], means[:, p : p + len(first)]
    omega, omega_z = means[:, begin : begin + 1], means[:, begin + 1 : begin + 1 + p]
    covariance = np.empty((len(sums), p, p))
    covariance[:, first, second] = covariance[:, second, first] = zz - z[:, first] * z[:, second]
    s = omega_z / omega - z
    beta = (np.linalg.pinv(covariance, rcond=_ROUNDING, hermitian=True) @ s[..., None])[..., 0]
    beta[:, covariance[0].diagonal() <= 0] = np.nan  # the first sample is the cohort itself
    return s, beta


def _strata(count: int) -> list[NDArray[np.int64]]:
    """Positions of agents, in the order of birth, cut into runs of at least `STRATUM`."""
    return np.array_split(np.arange(count), max(count // STRATUM, 1))


def within_strata(values: Floats) -> Floats:
    """Deviations from the mean of contemporaries, shape as given."""
    parts = [values[part] - values[part].mean(axis=0) for part in _strata(len(values)) if len(part)]
    return np.concatenate(parts) if parts else values


def relative_fitness(values: Floats) -> Floats:
    """Fitness over the mean fitness of contemporaries; 1 where all of these have none."""
    parts = []
    for part in _strata(len(values)):
        mean = values[part].mean()
        parts.append(values[part] / mean if mean > 0 else np.ones(len(part)))
    return np.concatenate(parts)


def sibships(cohort: pl.DataFrame) -> NDArray[np.int64]:
    """One number per mother; each founder has one of its own, below 0."""
    own = -1 - pl.int_range(pl.len(), dtype=pl.Int64)
    return cohort.select(pl.coalesce(pl.col("parent_id").cast(pl.Int64), own)).to_series().to_numpy()
