"""Which traits does selection favor, and how strongly? Differentials and gradients of Lande & Arnold (1983).

With ω = W / mean W the relative fitness of an individual and z its traits, the *differential* s = Cov(ω, z) is how far
selection within a generation moves the mean trait, by whatever route; the *gradient* β = Cov(z)⁻¹ s, the slopes of the
multiple regression of ω on all traits, is what a trait does by itself, others held fixed. Standardized to the trait's
standard deviation σ they are s/σ and β·σ: change of relative fitness per standard deviation.

In the regression on all traits and on half the square of one of them, the coefficient of that square is γ, the
*curvature* of fitness: below 0 selection is stabilizing, and individuals in the middle have more children than those on
either side; above 0 it is disruptive. Standardized, γ·σ² is per variance of the trait. Mutations with Cauchy tails put
a few individuals far out, and a regression on squares would follow these alone. Traits are therefore drawn in to ± 3
standard deviations of contemporaries.
"""

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.bootstrap import percentile_interval, resampled_sums

STRATUM = 200
"""Births that are compared with one another. Individuals are compared with contemporaries alone: where traits and mean
fitness both drift within a window, a comparison across it would show selection where there is none."""
FEWEST = 50
"""Individuals below which nothing is estimated."""
REACH = 3.0
"""Standard deviations to which traits are drawn in for the curvature."""
STATISTICS = ("differential", "intensity", "gradient", "standard_gradient")
"""In the order of `linear_selection`; see above."""
_ROUNDING = 1e-9  # deviations below which a trait does not vary

Floats = NDArray[np.float64]


def within_strata(values: Floats) -> Floats:
    """Deviations from the mean of contemporaries, shape as given (n, p); 0 for a trait that does not vary.

    Args:
        values: traits in the order of birth, (n, p).
    """
    parts = [values[part] - values[part].mean(axis=0) for part in _strata(len(values)) if len(part)]
    z = np.concatenate(parts) if parts else values
    z[:, np.abs(z).max(axis=0, initial=0.0) < _ROUNDING] = 0.0
    return z


def relative_fitness(values: Floats) -> Floats:
    """Fitness over the mean fitness of contemporaries, (n,); 1 where all of these have none."""
    parts = []
    for part in _strata(len(values)):
        mean = values[part].mean()
        parts.append(values[part] / mean if mean > 0 else np.ones(len(part)))
    return np.concatenate(parts)


def linear_selection(
    z: Floats, omega: Floats, cluster: NDArray[np.int64], rng: np.random.Generator, replicates: int
) -> Floats:
    """The four `STATISTICS` of each trait with their bounds, by measure of fitness.

    All measures are taken from the same bootstrap samples, since making these takes nearly all the time.

    Args:
        z: traits, deviations from contemporaries, shape (n, p).
        omega: relative fitness by each measure, shape (n, f).
        cluster: who is drawn together: siblings share their mother's place and energy, shape (n,).
        rng: source of chance.
        replicates: bootstrap samples.

    Returns:
        Value and bounds of the 95 % interval, shape (f, 3, 4, p).
    """
    sd = z.std(axis=0)
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


def quadratic_selection(
    z: Floats, omega: Floats, cluster: NDArray[np.int64], rng: np.random.Generator, replicates: int
) -> Floats:
    """The standardized curvature γ·σ² along each trait with its bounds, by measure of fitness.

    By Frisch, Waugh and Lovell, the coefficient of the square is that of a regression of what the traits leave of
    fitness on what they leave of the square. That part is taken from the whole cohort also in a bootstrap sample.

    Args:
        z: traits, deviations from contemporaries, shape (n, p).
        omega: relative fitness by each measure, shape (n, f).
        cluster: who is drawn together, shape (n,).
        rng: source of chance.
        replicates: bootstrap samples.

    Returns:
        Value and bounds of the 95 % interval, shape (f, 3, p).
    """
    z = standardized(z)
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
    return np.stack([gamma[0], low, high]).transpose(2, 0, 1)


def standardized(z: Floats) -> Floats:
    """Traits in standard deviations, drawn in to ± `REACH`; what does not vary is 0, shape (n, p) as given."""
    sd = z.std(axis=0)
    return np.clip(z / np.where(sd > _ROUNDING, sd, np.inf), -REACH, REACH)


def _features(z: Floats, omega: Floats) -> Floats:
    """What has to be summed over individuals for all moments: 1, z, the upper triangle of zz, each ω with its ωz."""
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
    with np.errstate(divide="ignore", invalid="ignore"):  # in a sample of nobody with children there is no differential
        s = omega_z / omega - z
    beta = (np.linalg.pinv(covariance, rcond=_ROUNDING, hermitian=True) @ s[..., None])[..., 0]
    beta[:, covariance[0].diagonal() <= 0] = np.nan  # the first sample is the cohort itself
    return s, beta


def _strata(count: int) -> list[NDArray[np.int64]]:
    """Positions of individuals, in the order of birth, cut into runs of at least `STRATUM`."""
    return np.array_split(np.arange(count), max(count // STRATUM, 1))
