"""Which traits does selection favor, and how strongly? Selection differentials and gradients (Lande & Arnold 1983).

Let ω = W / mean W be the relative fitness of an individual, and z its traits. The *differential* s = Cov(ω, z) is the
change of the mean trait by selection within a generation, whether direct or through correlated traits. The *gradient*
β = Cov(z)⁻¹ s contains the slopes of the multiple regression of ω on all traits: the direct effect of each trait with
the others held fixed. Standardized by the trait's standard deviation σ, they are s/σ and β·σ, the change of relative
fitness per standard deviation.

In the regression on all traits and on half the square of one of them, the coefficient of that square is γ, the
*curvature* of fitness. If it is below 0, selection is stabilizing, and intermediate individuals have more children than
extreme ones; if it is above 0, selection is disruptive. The standardized curvature γ·σ² is per variance of the trait.
Mutations with Cauchy tails produce a few extreme individuals, which would dominate a regression on squares. Traits are
therefore clipped to ± 3 standard deviations of contemporaries.
"""

import numpy as np
from numpy.typing import NDArray

STRATUM = 200
"""Number of consecutive births that are compared with one another. Individuals are compared only with contemporaries:
if traits and mean fitness both drift within a window, a comparison across it would show spurious selection."""
FEWEST = 50
"""Smallest number of individuals for an estimate."""
REACH = 3.0
"""Limit to which traits are clipped for the curvature, in standard deviations."""
STATISTICS = ("differential", "intensity", "gradient", "standard_gradient")
"""The statistics that `linear_selection` returns, in this order."""
_ROUNDING = 1e-9  # largest deviation of a trait that counts as constant

Floats = NDArray[np.float64]


def within_strata(values: Floats) -> Floats:
    """Deviations from the mean of contemporaries, shape (n, p); 0 for a trait that does not vary.

    Args:
        values: Traits of individuals in the order of birth, shape (n, p).
    """
    parts = [values[part] - values[part].mean(axis=0) for part in _strata(len(values)) if len(part)]
    z = np.concatenate(parts) if parts else values
    z[:, np.abs(z).max(axis=0, initial=0.0) < _ROUNDING] = 0.0
    return z


def relative_fitness(values: Floats) -> Floats:
    """Fitness divided by the mean fitness of contemporaries, shape (n,); 1 if all contemporaries have fitness 0."""
    parts = []
    for part in _strata(len(values)):
        mean = values[part].mean()
        parts.append(values[part] / mean if mean > 0 else np.ones(len(part)))
    return np.concatenate(parts)


def linear_selection(z: Floats, omega: Floats) -> Floats:
    """The four `STATISTICS` of each trait, by measure of fitness.

    They have no interval, since the fitness of relatives is correlated to an extent that one world cannot show.

    Args:
        z: Traits as deviations from contemporaries, shape (n, p).
        omega: Relative fitness by each measure, shape (n, f).

    Returns:
        The statistics, shape (f, 4, p); NaN for a trait that does not vary, or if all individuals have fitness 0.
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

    By the theorem of Frisch, Waugh and Lovell, the coefficient of the square equals the slope of the residuals of
    fitness on the residuals of the square, after regressing both on the traits.

    Args:
        z: Traits as deviations from contemporaries, shape (n, p).
        omega: Relative fitness by each measure, shape (n, f).

    Returns:
        The curvature, shape (f, p); NaN for a trait that does not vary.
    """
    z = standardized(z)
    design = np.column_stack([np.ones(len(z)), z])
    scale = np.std(z, axis=0)
    square = 0.5 * (z / np.where(scale > 0, scale, 1.0)) ** 2  # in units of the variance after clipping
    rest_square, rest_omega = (y - design @ np.linalg.lstsq(design, y, rcond=None)[0] for y in (square, omega))
    with np.errstate(divide="ignore", invalid="ignore"):
        gamma = (rest_square.T @ rest_omega) / (rest_square**2).sum(axis=0)[:, None]
    gamma[scale <= 0] = np.nan
    return gamma.T


def standardized(z: Floats) -> Floats:
    """Traits in standard deviations, clipped to ± `REACH`, shape (n, p); 0 for a trait that does not vary."""
    sd = z.std(axis=0)
    return np.clip(z / np.where(sd > _ROUNDING, sd, np.inf), -REACH, REACH)


def _strata(count: int) -> list[NDArray[np.int64]]:
    """Positions of individuals, in the order of birth, divided into strata of at least `STRATUM`."""
    return np.array_split(np.arange(count), max(count // STRATUM, 1))
