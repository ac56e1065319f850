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


def linear_selection(z: Floats, omega: Floats) -> Floats:
    """The four `STATISTICS` of each trait, by measure of fitness.

    They have no interval: relatives share their fitness, and nothing within one world says by how much.

    Args:
        z: traits, deviations from contemporaries, shape (n, p).
        omega: relative fitness by each measure, shape (n, f).

    Returns:
        Shape (f, 4, p); NaN for a trait that does not vary, and for a fitness that nobody has.
    """
    sd = z.std(axis=0)
    scale = np.where(sd > 0, sd, 1.0)
    scaled = (z - z.mean(axis=0)) / scale
    with np.errstate(divide="ignore", invalid="ignore"):
        s = scaled.T @ omega / omega.sum(axis=0)  # (p, f)
    beta = np.linalg.pinv(scaled.T @ scaled / len(z), rcond=_ROUNDING, hermitian=True) @ s
    beta[sd <= 0] = np.nan
    varies = np.where(sd > 0, 1.0, np.nan)[:, None]
    return np.stack([s * scale[:, None], s * varies, beta / scale[:, None], beta]).transpose(2, 0, 1)


def quadratic_selection(z: Floats, omega: Floats) -> Floats:
    """The standardized curvature γ·σ² along each trait, by measure of fitness.

    By Frisch, Waugh and Lovell, the coefficient of the square is that of a regression of what the traits leave of
    fitness on what they leave of the square.

    Args:
        z: traits, deviations from contemporaries, shape (n, p).
        omega: relative fitness by each measure, shape (n, f).

    Returns:
        Shape (f, p); NaN for a trait that does not vary.
    """
    z = standardized(z)
    design = np.column_stack([np.ones(len(z)), z])
    scale = np.std(z, axis=0)
    square = 0.5 * (z / np.where(scale > 0, scale, 1.0)) ** 2  # in units of the variance after drawing in
    rest_square, rest_omega = (y - design @ np.linalg.lstsq(design, y, rcond=None)[0] for y in (square, omega))
    with np.errstate(divide="ignore", invalid="ignore"):
        gamma = (rest_square.T @ rest_omega) / (rest_square**2).sum(axis=0)[:, None]
    gamma[scale <= 0] = np.nan
    return gamma.T


def standardized(z: Floats) -> Floats:
    """Traits in standard deviations, drawn in to ± `REACH`; what does not vary is 0, shape (n, p) as given."""
    sd = z.std(axis=0)
    return np.clip(z / np.where(sd > _ROUNDING, sd, np.inf), -REACH, REACH)


def _strata(count: int) -> list[NDArray[np.int64]]:
    """Positions of individuals, in the order of birth, cut into runs of at least `STRATUM`."""
    return np.array_split(np.arange(count), max(count // STRATUM, 1))
