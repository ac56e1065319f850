"""Intervals over worlds, and chances under the null that genes do nothing."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import SHARE, mean_interval
from hedon.statistic.law import normal_below, normal_quantile, t_quantile
from hedon.statistic.minimum import FOR_INTERVAL

REPLICATES = 1000
PERMUTATIONS = 999
_FAILED = 0.05  # of the replicates that may have no value

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def world_draws(worlds: int, rng: np.random.Generator, replicates: int = REPLICATES) -> Floats:
    """How often each world is drawn in each bootstrap sample, (replicates, worlds)."""
    return rng.multinomial(worlds, np.full(worlds, 1.0 / worlds), replicates).astype(np.float64)


def world_interval(values: NDArray[np.float64], worlds: int) -> Floats:
    """Bounds of a 95 % interval from bootstrap samples of worlds, (2, …); NaN with too few worlds.

    Percentiles are moved out as far as Student's t is wider than the normal law, and by the factor that a bootstrap of
    few worlds is too narrow: Hesterberg (2015), "expanded percentile interval".

    Args:
        values: one per replicate, (replicates, …). There is no interval where more than one in twenty is not finite.
        worlds: how many were drawn.

    Returns:
        Lower and upper bound, (2, …).
    """
    if worlds < FOR_INTERVAL:
        return np.full((2, *values.shape[1:]), np.nan)
    reach = math.sqrt(worlds / (worlds - 1)) * t_quantile(0.975, worlds - 1)
    tail = normal_below(-reach)
    known = np.isfinite(values)
    enough = known.mean(axis=0) >= 1.0 - _FAILED
    bounds = np.nanquantile(np.where(known | ~enough, np.where(known, values, 0.0), np.nan), (tail, 1.0 - tail), axis=0)
    return np.where(enough, bounds, np.nan)


@dataclass(frozen=True)
class Estimate:
    """A number with the bounds of its 95 % interval over worlds; NaN where there is none."""

    value: float
    low: float
    high: float


def bounded(value: float, replicates: NDArray[np.float64] | Sequence[float], worlds: int) -> Estimate:
    """An estimate with its interval; see `world_interval`.

    Args:
        value: of all worlds.
        replicates: one per bootstrap sample, (replicates,).
        worlds: how many were drawn.
    """
    return Estimate(float(value), *map(float, world_interval(np.asarray(replicates), worlds)))


def diffusion_strength(change: Floats, variation: Floats, worlds: int) -> Estimate:
    """The strength of selection on a share, with an interval from how much the share wanders within worlds.

    The changes Δp less s·V are noise of mean 0 with a variance of its own at each moment, so that the sum of their
    squares estimates the variance of ΣΔp. A bootstrap over worlds misses the truth in a quarter of cases with ten
    worlds and in half with three, since worlds that have lost the group say almost nothing.

    Args:
        change: Δp of each interval of each world, (intervals,).
        variation: V = p(1 − p)Δg of each, (intervals,).
        worlds: how many these are.

    Returns:
        s = ΣΔp / ΣV per generation, and s ± 1.96 √Σ(Δp − sV)² / ΣV; NaN if the share never varied.
    """
    total = float(variation.sum())
    if total <= 0:
        return Estimate(math.nan, math.nan, math.nan)
    strength = float(change.sum()) / total
    if worlds < FOR_INTERVAL:
        return Estimate(strength, math.nan, math.nan)
    reach = normal_quantile(0.975) * math.sqrt(float(((change - strength * variation) ** 2).sum())) / total
    return Estimate(strength, strength - reach, strength + reach)


def share_estimate(shares: Floats) -> Estimate:
    """The mean share over worlds with Student's interval, within 0 and 1.

    Args:
        shares: one per world, (worlds,).
    """
    found = mean_interval(shares.tolist(), within=SHARE)
    if found.mean is None or found.low is None or found.high is None:
        return Estimate(math.nan if found.mean is None else found.mean, math.nan, math.nan)
    return Estimate(found.mean, found.low, found.high)


def within(values: Floats, world: Ints) -> Floats:
    """Deviations from the mean of the own world.

    Args:
        values: (n,) or (n, columns).
        world: the world of each row, from 0 on, (n,).

    Returns:
        The shape of `values`.
    """
    count = np.bincount(world)
    columns = values if values.ndim > 1 else values[:, None]
    means = np.stack([np.bincount(world, column) / np.maximum(count, 1) for column in columns.T], axis=1)
    found = columns - means[world]
    return found if values.ndim > 1 else found[:, 0]


def relative(values: Floats, world: Ints) -> Floats:
    """Values over the mean of the own world, (n,); NaN in a world whose mean is not above 0.

    Args:
        values: (n,).
        world: the world of each, from 0 on, (n,).
    """
    mean = (np.bincount(world, values) / np.maximum(np.bincount(world), 1))[world]
    return np.where(mean > 0, values / np.where(mean > 0, mean, 1.0), np.nan)


def permuted(values: Floats, world: Ints, rng: np.random.Generator, times: int = PERMUTATIONS) -> Floats:
    """Values exchanged among the founders of each world, (n, times): what is expected if genes do nothing.

    Args:
        values: one per founder, (n,).
        world: the world of each, from 0 on, (n,).
        rng: source of chance.
        times: how many permutations.
    """
    found = np.empty((len(values), times))
    for index in np.unique(world):
        mine = np.flatnonzero(world == index)
        order = rng.permuted(np.tile(mine[:, None], (1, times)), axis=0)
        found[mine] = values[order]
    return found


def chance(observed: Floats, null: Floats) -> Floats:
    """Two-sided chance of a value at least this far from 0 under the null."""
    beyond = (np.abs(null) >= np.abs(observed)[..., None] * (1 - 1e-12)).sum(axis=-1)
    return (1.0 + beyond) / (1.0 + null.shape[-1])
