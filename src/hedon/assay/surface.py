"""Relative fitness as a function of two genes: a quadratic and a smooth surface, with intervals over worlds.

The quadratic surface is ω = c + β·z + ½ zᵀΓz (Lande & Arnold 1983). The smooth surface is a tensor product of cubic
B-splines with a penalty on second differences of its coefficients (Eilers & Marx 1996); if the data show no further
structure, it is a twisted plane. Its smoothness minimizes generalized cross-validation. Both surfaces are fitted to
deviations from the mean of each world, so that worlds may differ, and are shifted so that the mean over founders is 1.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from lazy_loader import load

from hedon.assay.resample import (
    Estimate,
    Floats,
    Ints,
    bounded,
    within,
    world_draws,
    world_interval,
    world_moments,
)

interpolate: Any = load("scipy.interpolate", suppress_warning=True)  # takes a tenth of a second to load

INTERVALS = 4
"""Number of spline intervals along each gene."""
GRID = 41
"""Number of grid points along each gene for the smooth surface."""
_DEGREE = 3
_PENALTIES = np.logspace(-2, 7, 28)
_RIDGE = 1e-8  # makes up for the constant, which subtracting the means of worlds removes


@dataclass(frozen=True, eq=False)
class Quadratic:
    """The quadratic surface.

    Attributes:
        slope: Slope at 0 along each gene.
        curvature: Second derivative along each gene; negative if fitness has a maximum.
        interaction: Mixed second derivative.
        optimum: Value of each gene at which the slope is 0; NaN unless it is a maximum.
        coefficients: β1, β2, Γ11, Γ22, Γ12, shape (5,).
    """

    slope: tuple[Estimate, Estimate]
    curvature: tuple[Estimate, Estimate]
    interaction: Estimate
    optimum: tuple[Estimate, Estimate]
    coefficients: Floats


@dataclass(frozen=True, eq=False)
class Smooth:
    """The smooth surface on a grid.

    Attributes:
        axes: Values of the two genes along the grid, shape (2, GRID).
        value: Relative fitness, shape (GRID, GRID), with the first gene along the rows.
        low, high: Bounds of its pointwise 95 % interval, with the shape of `value`.
        slope: Slope at 0 along each gene.
        optimum: Value of each gene at which the surface is highest.
        at_edge: Whether it is highest at the edge of the range, beyond which it may rise further.
        freedom: Effective number of parameters; 3 means a twisted plane.
        coefficients, draws: Spline coefficients, shape (K²,), and those of each bootstrap sample, (replicates, K²).
        shift: Constant that makes the mean over founders 1, for the estimate and each sample, (1 + replicates,).
        knots: Knots of each gene, shape (2, K + degree + 1).
        worlds: Number of worlds used.
    """

    axes: Floats
    value: Floats
    low: Floats
    high: Floats
    slope: tuple[Estimate, Estimate]
    optimum: tuple[Estimate, Estimate]
    at_edge: bool
    freedom: float
    coefficients: Floats
    draws: Floats
    shift: Floats
    knots: Floats
    worlds: int

    def at(self, points: Floats) -> list[Estimate]:
        """Relative fitness at points within the range, shape (count, 2)."""
        basis = _basis(points, self.knots)
        surface = basis @ np.vstack([self.coefficients, self.draws]).T + self.shift
        return [bounded(values, self.worlds) for values in surface]


def quadratic_terms(z: Floats) -> Floats:
    """The design matrix of the quadratic surface, shape (n, 5), whose coefficients are derivatives at 0."""
    x, y = z.T
    return np.stack([x, y, x * x / 2, y * y / 2, x * y], axis=1)


def fit_quadratic(z: Floats, fitness: Floats, world: Ints, rng: np.random.Generator) -> Quadratic:
    """Fits the quadratic surface.

    Args:
        z: The two genes of each founder, shape (n, 2).
        fitness: Fitness of each founder relative to the mean of its world, shape (n,).
        world: Index of each founder's world, from 0, shape (n,).
        rng: Source of random numbers.
    """
    terms, deviation = within(quadratic_terms(z), world), within(fitness, world)
    scale = terms.std(axis=0)
    worlds, left, right = world_moments(terms / scale, deviation, world)
    draws = world_draws(worlds, rng)
    coefficients = _solve(draws, left, right, np.eye(5) * _RIDGE) / scale
    estimates = [bounded(values, worlds) for values in coefficients.T]
    optimum = [bounded(values, worlds) for values in np.array([_maximum(row) for row in coefficients]).T]
    return Quadratic(
        (estimates[0], estimates[1]),
        (estimates[2], estimates[3]),
        estimates[4],
        (optimum[0], optimum[1]),
        coefficients[0],
    )


def fit_smooth(
    z: Floats, fitness: Floats, world: Ints, bounds: tuple[Floats, Floats], rng: np.random.Generator
) -> Smooth:
    """Fits the smooth surface within bounds.

    Args:
        z: The two genes of each founder, shape (n, 2).
        fitness: Fitness of each founder relative to the mean of its world, shape (n,).
        world: Index of each founder's world, from 0, shape (n,).
        bounds: Lower and upper bounds of the two genes, shape (2,) each; genes beyond are moved to the bound.
        rng: Source of random numbers.
    """
    knots = np.stack([_knots(low, high) for low, high in zip(*bounds, strict=True)])
    clipped = np.clip(z, *bounds)
    basis, deviation = within(_basis(clipped, knots), world), within(fitness, world)
    worlds, left, right = world_moments(basis, deviation, world)
    penalty = _penalty(knots.shape[1] - _DEGREE - 1)
    smoothness, freedom = _choose(left.sum(axis=0), right.sum(axis=0), penalty, deviation)
    draws = world_draws(worlds, rng)
    coefficients = _solve(draws, left, right, smoothness * penalty + _RIDGE * np.eye(len(penalty)))
    shift = 1.0 - coefficients @ _basis(clipped, knots).mean(axis=0)
    axes = np.stack([np.linspace(low, high, GRID) for low, high in zip(*bounds, strict=True)])
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    surface = coefficients @ _basis(points, knots).T + shift[:, None]
    low, high = world_interval(surface[1:], worlds)
    best = points[surface.argmax(axis=1)]
    slopes = [coefficients @ _basis(np.zeros((1, 2)), knots, gene)[0] for gene in range(2)]
    top = np.unravel_index(surface[0].argmax(), (GRID, GRID))
    shape = (GRID, GRID)
    return Smooth(
        axes=axes,
        value=surface[0].reshape(shape),
        low=low.reshape(shape),
        high=high.reshape(shape),
        slope=(bounded(slopes[0], worlds), bounded(slopes[1], worlds)),
        optimum=(bounded(best[:, 0], worlds), bounded(best[:, 1], worlds)),
        at_edge=any(i in (0, GRID - 1) for i in top),
        freedom=freedom,
        coefficients=coefficients[0],
        draws=coefficients[1:],
        shift=shift,
        knots=knots,
        worlds=worlds,
    )


def _solve(draws: Floats, left: Floats, right: Floats, penalty: Floats) -> Floats:
    """Coefficients in each sample of worlds, (samples, p)."""
    size = left.shape[1]
    sums = (draws @ left.reshape(len(left), -1)).reshape(-1, size, size) + penalty
    return np.asarray(np.linalg.solve(sums, (draws @ right)[..., None])[..., 0], np.float64)


def _maximum(row: Floats) -> Floats:
    hessian = np.array([[row[2], row[4]], [row[4], row[3]]])
    if np.linalg.eigvalsh(hessian).max() >= 0:
        return np.full(2, np.nan)
    return np.asarray(-np.linalg.solve(hessian, row[:2]), np.float64)


def _knots(low: float, high: float) -> Floats:
    inner = np.linspace(low, high, INTERVALS + 1)
    step = inner[1] - inner[0]
    outer = step * np.arange(1, _DEGREE + 1)
    return np.concatenate([low - outer[::-1], inner, high + outer])


def _basis(points: Floats, knots: Floats, slope: int | None = None) -> Floats:
    """The tensor product of the two genes' bases at points, (count, K²), or its derivative along one gene."""
    bases = []
    for gene in range(2):
        functions = np.eye(len(knots[gene]) - _DEGREE - 1)
        bases.append(interpolate.BSpline(knots[gene], functions, _DEGREE)(points[:, gene], nu=int(slope == gene)))
    return (bases[0][:, :, None] * bases[1][:, None, :]).reshape(len(points), -1)


def _penalty(size: int) -> Floats:
    second_difference = np.diff(np.eye(size), 2, axis=0)
    curvature = second_difference.T @ second_difference
    return np.kron(curvature, np.eye(size)) + np.kron(np.eye(size), curvature)


def _choose(left: Floats, right: Floats, penalty: Floats, deviation: Floats) -> tuple[float, float]:
    """The smoothness that minimizes generalized cross-validation, and the effective number of parameters."""
    candidates = []
    for smoothness in _PENALTIES:
        inverse = np.linalg.inv(left + smoothness * penalty + _RIDGE * np.eye(len(left)))
        coefficients, freedom = inverse @ right, float(np.trace(inverse @ left))
        residual = float(deviation @ deviation - 2 * coefficients @ right + coefficients @ left @ coefficients)
        score = residual / max(len(deviation) - freedom, 1.0) ** 2
        candidates.append((score, -smoothness, freedom))
    _, smoothness, freedom = min(candidates)
    return -smoothness, freedom
