"""Intervals over worlds, and p values under the null hypothesis that genes have no effect."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import SHARE, mean_bounds
from hedon.statistic.law import normal_below, normal_quantile, t_quantile
from hedon.statistic.minimum import FOR_INTERVAL

REPLICATES = 1000
PERMUTATIONS = 999
_FAILED = 0.05  # largest share of replicates without a value

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def world_draws(worlds: int, rng: np.random.Generator, replicates: int = REPLICATES) -> Floats:
    """How often each world counts in an estimate and in its bootstrap samples, shape (1 + replicates, worlds).

    In the first row, which gives the estimate itself, each world counts once.
    """
    draws = rng.multinomial(worlds, np.full(worlds, 1.0 / worlds), replicates).astype(np.float64)
    return np.concatenate([np.ones((1, worlds)), draws])


def world_moments(terms: Floats, deviation: Floats, world: Ints) -> tuple[int, Floats, Floats]:
    """The number of worlds, and of each XᵀX, (worlds, p, p), and Xᵀy, (worlds, p), where X are the terms."""
    indices = np.unique(world)
    parts = [(terms[world == index], deviation[world == index]) for index in indices]
    return len(indices), np.stack([x.T @ x for x, _ in parts]), np.stack([x.T @ y for x, y in parts])


def world_interval(values: NDArray[np.float64], worlds: int) -> Floats:
    """A 95 % interval from bootstrap samples of worlds; NaN with too few worlds.

    The percentiles are widened to account for Student's t instead of the normal distribution, and for the bias of a
    bootstrap of few worlds: Hesterberg (2015), "expanded percentile interval".

    Args:
        values: Value of each replicate, shape (replicates, …). There is no interval if more than one in twenty is not
            finite.
        worlds: Number of worlds drawn.

    Returns:
        Lower and upper bound, shape (2, …).
    """
    if worlds < FOR_INTERVAL:
        return np.full((2, *values.shape[1:]), np.nan)
    t_bound = math.sqrt(worlds / (worlds - 1)) * t_quantile(0.975, worlds - 1)
    tail = normal_below(-t_bound)
    is_finite = np.isfinite(values)
    is_sufficient = is_finite.mean(axis=0) >= 1.0 - _FAILED
    bounds = np.nanquantile(
        np.where(is_finite | ~is_sufficient, np.where(is_finite, values, 0.0), np.nan), (tail, 1.0 - tail), axis=0
    )
    return np.where(is_sufficient, bounds, np.nan)


@dataclass(frozen=True)
class Estimate:
    """A number with the bounds of its 95 % interval over worlds; missing values are NaN."""

    value: float
    low: float
    high: float


def bounded(values: Floats, worlds: int) -> Estimate:
    """An estimate with its interval; see `world_interval`.

    Args:
        values: The estimate from each row of `world_draws`, shape (1 + replicates,).
        worlds: Number of worlds drawn.
    """
    return Estimate(float(values[0]), *map(float, world_interval(values[1:], worlds)))


def diffusion_strength(change: Floats, variation: Floats, worlds: int) -> Estimate:
    """The strength of selection on a share, with an interval from the fluctuations of the share within worlds.

    The changes Δp minus s·V are noise with mean 0 and a variance that differs between moments, so the sum of their
    squares estimates the variance of ΣΔp. A bootstrap over worlds would miss the true value in a quarter of cases with
    ten worlds, and in half with three, since worlds that have lost the group contain almost no information.

    Args:
        change: Δp of each interval of each world, shape (intervals,).
        variation: V = p(1 − p)Δg of each interval, shape (intervals,).
        worlds: Number of worlds.

    Returns:
        s = ΣΔp / ΣV per generation, and s ± 1.96 √Σ(Δp − sV)² / ΣV; NaN if the share never varied.
    """
    total = float(variation.sum())
    if total <= 0:
        return Estimate(math.nan, math.nan, math.nan)
    strength = float(change.sum()) / total
    if worlds < FOR_INTERVAL:
        return Estimate(strength, math.nan, math.nan)
    half_width = normal_quantile(0.975) * math.sqrt(float(((change - strength * variation) ** 2).sum())) / total
    return Estimate(strength, strength - half_width, strength + half_width)


def share_estimate(shares: Floats) -> Estimate:
    """The mean share over worlds with Student's interval, within 0 and 1.

    Args:
        shares: Share in each world, shape (worlds,).
    """
    return Estimate(*mean_bounds(shares, within=SHARE))


def within(values: Floats, world: Ints) -> Floats:
    """Deviations of values from the mean of their world.

    Args:
        values: The values, shape (n,) or (n, columns).
        world: Index of each row's world, from 0, shape (n,).

    Returns:
        The shape of `values`.
    """
    count = np.bincount(world)
    columns = values if values.ndim > 1 else values[:, None]
    means = np.stack([np.bincount(world, column) / np.maximum(count, 1) for column in columns.T], axis=1)
    deviations = columns - means[world]
    return deviations if values.ndim > 1 else deviations[:, 0]


def relative(values: Floats, world: Ints) -> Floats:
    """Values divided by the mean of their world, shape (n,); NaN in a world whose mean is not above 0.

    Args:
        values: The values, shape (n,).
        world: Index of each value's world, from 0, shape (n,).
    """
    mean = (np.bincount(world, values) / np.maximum(np.bincount(world), 1))[world]
    return np.where(mean > 0, values / np.where(mean > 0, mean, 1.0), np.nan)


def permuted(values: Floats, world: Ints, rng: np.random.Generator, times: int = PERMUTATIONS) -> Floats:
    """Values permuted among the founders of each world, shape (n, times), as if genes had no effect.

    Args:
        values: Value of each founder, shape (n,).
        world: Index of each founder's world, from 0, shape (n,).
        rng: Source of random numbers.
        times: Number of permutations.
    """
    result = np.empty((len(values), times))
    for index in np.unique(world):
        members = np.flatnonzero(world == index)
        order = rng.permuted(np.tile(members[:, None], (1, times)), axis=0)
        result[members] = values[order]
    return result


def chance(observed: Floats, null: Floats) -> Floats:
    """The two-sided p value of an observation, from values under the null hypothesis.

    Args:
        observed: Observed values, any shape.
        null: Values under the null hypothesis; the same shape with a last axis for permutations.
    """
    extreme_count = (np.abs(null) >= np.abs(observed)[..., None] * (1 - 1e-12)).sum(axis=-1)
    return (1.0 + extreme_count) / (1.0 + null.shape[-1])
