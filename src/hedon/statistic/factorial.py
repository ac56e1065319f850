"""What is the effect of each of several two-level factors and of their combinations? Contrasts of a factorial design.

A factor is coded −1/2 if it is absent and +1/2 if it is present. The column of several factors is the product of their
columns, and the effects are the coefficients of these columns. Hence

- the *main effect* of A is the mean of the cells with A minus the mean of those without;
- the *interaction* A × B is the effect of A with B minus the effect of A without B, averaged over the other factors;
- A × B × C is the interaction A × B with C minus the same interaction without C.

If all cells are present, they have equal weight, however many worlds they contain. See Box, Hunter & Hunter (2005),
chapters 5 and 6. They halve interactions; we do not, so that on a log scale an interaction is a ratio of ratios.

The error comes from the variation of worlds within cells, and each cell has its own variance (Welch, 1947; degrees of
freedom by Satterthwaite, 1946). Seeds shared by several cells are not treated as blocks, which is conservative.

If cells are missing, an effect is estimated by least squares in the largest model that determines it: all effects up to
some order, with effects of higher order assumed to be zero. The estimate is then an average over only some cells. It is
reported only if no effect of other factors, of any order, is mixed in: A may be estimated from two cells that differ
only in A, but never from cells with B, with C and with all three. Effects that no model determines are left out.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.correction import holm
from hedon.statistic.interval import LEVEL
from hedon.statistic.law import t_above, t_quantile

Cell = tuple[bool, ...]
"""Whether each factor is present, in the order of the factors."""
Factors = tuple[int, ...]
"""Indices of the factors of an effect, in ascending order."""

PER_CELL = 3
"""Worlds per cell that an interval requires if cells differ in size. With two worlds in a small, variable cell, the
false positive rate would be 12 % instead of 5 %."""
NAN = math.nan
_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Effect:
    """One effect on one response, on the scale of the values given.

    Attributes:
        factors: The factors whose effect or interaction it is.
        order: Order of its model; effects of higher order are assumed to be zero.
        estimate: The estimated effect, as defined for this module.
        low, high: Bounds of its 95 % interval (Student's t); NaN unless each cell has `PER_CELL` worlds, or all cells
            have the same number of worlds and at least two.
        p: Two-sided p value; NaN likewise, and if worlds agree within all cells.
        freedom: Degrees of freedom of its t.
        p_holm: p after Holm correction for all effects of the fit.
        seed_low, seed_high: Smallest and largest estimate of the effect from single seeds; NaN if no seed determines
            it.
        seeds: Number of seeds that determine it.
    """

    factors: Factors
    order: int
    estimate: float
    low: float
    high: float
    p: float
    freedom: float
    p_holm: float
    seed_low: float
    seed_high: float
    seeds: int


@dataclass(frozen=True)
class FactorialFit:
    """The effects of one response.

    Attributes:
        effects: The estimated effects, by order and then in the order of the factors.
        left_out: Effects that the cells do not determine.
    """

    effects: tuple[Effect, ...]
    left_out: tuple[Factors, ...]


def fit_factorial(cells: Mapping[Cell, Mapping[int, float]], factors: int) -> FactorialFit:
    """Estimates all effects that the cells determine.

    Args:
        cells: For each nonempty cell, the value of each seed.
        factors: Number of factors.
    """
    filled = {cell: values for cell, values in cells.items() if values}
    rows = [(cell, value) for cell, values in filled.items() for value in values.values()]
    values = np.array([value for _, value in rows])
    counts = np.array([len(cell_values) for cell_values in filled.values()])
    variances = _variances(filled)
    unadjusted = []
    for group, (order, weights) in _solve([cell for cell, _ in rows], factors).items():
        estimate = float(weights @ values)
        parts = np.repeat(variances, counts) * weights**2
        error, freedom = math.sqrt(parts.sum()), _freedom(parts, np.repeat(counts, counts))
        half_width = t_quantile(0.5 + LEVEL / 2, freedom) * error if error > 0 else error
        p = 2.0 * t_above(abs(estimate) / error, freedom) if error > 0 else NAN
        seeds = _in_seeds(filled, factors, group, order)
        low, high = min(seeds, default=NAN), max(seeds, default=NAN)
        bounds = (estimate - half_width, estimate + half_width)
        unadjusted.append(Effect(group, order, estimate, *bounds, p, freedom, NAN, low, high, len(seeds)))
    corrected = holm([effect.p for effect in unadjusted])
    effects = tuple(replace(effect, p_holm=p) for effect, p in zip(unadjusted, corrected, strict=True))
    estimated = {effect.factors for effect in effects}
    return FactorialFit(effects, tuple(group for group in all_effects(factors) if group not in estimated))


def _variances(cells: Mapping[Cell, Mapping[int, float]]) -> NDArray[np.float64]:
    """Variance of the worlds in each cell; NaN if a cell has too few worlds for the level to hold."""
    counts = {len(values) for values in cells.values()}
    if min(counts, default=0) < (2 if len(counts) == 1 else PER_CELL):
        return np.full(len(cells), NAN)
    return np.array([float(np.var(list(values.values()), ddof=1)) for values in cells.values()])


def _freedom(parts: NDArray[np.float64], counts: NDArray[np.int_]) -> float:
    """Satterthwaite's degrees of freedom.

    Args:
        parts: Contribution of each world to the variance of an effect, (worlds,).
        counts: Number of worlds in the cell of each world, (worlds,).
    """
    # The n worlds of a cell add n equal parts v, so (n v)² / (n − 1) is the sum over them of n v² / (n − 1).
    denominator = float((parts**2 * counts / (counts - 1.0)).sum()) if counts.min(initial=2) > 1 else NAN
    return float(parts.sum()) ** 2 / denominator if denominator > 0 else NAN


def all_effects(factors: int, order: int | None = None) -> list[Factors]:
    """All effects of some factors up to an order, by order.

    Args:
        factors: Number of factors.
        order: Order of the highest interaction; None for all orders.
    """
    orders = range(1, (factors if order is None else order) + 1)
    return [group for k in orders for group in itertools.combinations(range(factors), k)]


def _solve(cells: Sequence[Cell], factors: int) -> dict[Factors, tuple[int, NDArray[np.float64]]]:
    """The effects that some worlds determine, each with the order of its model and the weights of the worlds."""
    solved: dict[Factors, tuple[int, NDArray[np.float64]]] = {}
    if not cells:
        return solved
    model_effects = [(), *all_effects(factors)]
    full_design = _design(cells, model_effects)
    for order in range(factors, 0, -1):
        model = [(), *all_effects(factors, order)]
        inverse = np.linalg.pinv(_design(cells, model))
        for group, weights in list(zip(model, inverse, strict=True))[1:]:
            # The share of each true effect in the estimate: 1 for the effect itself, and 0 for all effects that do not
            # include its factors.
            coefficients = dict(zip(model_effects, weights @ full_design, strict=True))
            largest_bias = max(abs(share) for effect, share in coefficients.items() if not set(group) <= set(effect))
            if group not in solved and abs(coefficients[group] - 1.0) < _TOLERANCE and largest_bias < _TOLERANCE:
                solved[group] = (order, weights)
    return {group: solved[group] for group in all_effects(factors) if group in solved}


def _in_seeds(cells: Mapping[Cell, Mapping[int, float]], factors: int, group: Factors, order: int) -> list[float]:
    """Estimates of an effect from each single seed whose cells determine it with a model of the same order."""
    estimates = []
    for seed in sorted({seed for values in cells.values() for seed in values}):
        seed_cells = [cell for cell, values in cells.items() if seed in values]
        solution = _solve(seed_cells, factors).get(group)
        if solution is not None and solution[0] == order:
            estimates.append(float(solution[1] @ np.array([cells[cell][seed] for cell in seed_cells])))
    return estimates


def _design(cells: Sequence[Cell], groups: Sequence[Factors]) -> NDArray[np.float64]:
    """One row per cell, one column per effect."""
    coded = np.array(cells, np.float64).reshape(len(cells), -1) - 0.5
    return np.array([coded[:, list(group)].prod(axis=1) for group in groups]).reshape(len(groups), -1).T
