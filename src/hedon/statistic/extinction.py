"""What share of worlds dies out by a given step? The Kaplan–Meier estimate (1958) over worlds, for small samples.

A world that is alive when its record ends is *censored*: it may still die out before the step in question. Leaving
such worlds out makes the share too large, because the fate of an extinct world is known however short it was.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL
from hedon.statistic.law import beta_below
from hedon.statistic.survival import survival_curve

optimize: Any = load("scipy.optimize", suppress_warning=True)

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
_SEED = 1966
"""Seed of the permutations, so that the same worlds give the same p value."""


@dataclass(frozen=True)
class ExtinctShare:
    """The share of worlds that is extinct by a step.

    Attributes:
        share: Product-limit estimate. If no world was followed up to the step, the estimate for `known_until`, which is
            a lower bound. NaN without worlds.
        low, high: Bounds of its interval; NaN without worlds.
        worlds: Number of all worlds.
        extinct: Number of worlds extinct by the step.
        followed: Number of worlds alive at the step.
        known_until: Last step for which there is an estimate [step].
    """

    share: float
    low: float
    high: float
    worlds: int
    extinct: int
    followed: int
    known_until: float


def extinct_share(duration: Floats, died: Flags, until: float, level: float = LEVEL) -> ExtinctShare:
    """The share extinct by a step, from worlds of any length.

    The interval is the mid-p form of the beta product confidence procedure. The chance to survive all deaths is
    a product of beta variables, one for each step at which worlds died out. Half the weight is on that product, and
    half on the product with one more factor, for a death that could follow immediately. Without censoring, it is the
    mid-p interval of a share. If no world is left at risk, the share has no upper limit below 1.

    Source: Fay, Brittain and Proschan (2013), Biostatistics 14, 723–736; mid-p: Fay and Brittain (2016), Statistics in
    Medicine 35, 2726–2740. As proposed there, products are approximated by a beta distribution with the same mean and
    variance.

    Args:
        duration: Step at which each world died out, or at which the record of a living world ends [step], shape (n,).
        died: Whether the world died out, shape (n,).
        until: Step by which a world must have died out to count as extinct [step].
        level: Confidence level of the interval.
    """
    if not len(duration):
        return ExtinctShare(np.nan, np.nan, np.nan, 0, 0, 0, 0.0)
    is_extinct = died & (duration <= until)
    time = np.minimum(duration, until)
    followed = int(np.count_nonzero(~is_extinct & (time >= until)))
    curve = survival_curve(time, is_extinct)
    alive = float(curve.share[-1]) if len(curve.age) else 1.0
    low, high = _bounds(curve.at_risk, curve.deaths, followed, level)
    known_until = float(until) if followed or is_extinct.all() else float(time.max())
    return ExtinctShare(1.0 - alive, 1.0 - high, 1.0 - low, len(time), int(is_extinct.sum()), followed, known_until)


def _bounds(at_risk: NDArray[np.int64], deaths: NDArray[np.int64], followed: int, level: float) -> tuple[float, float]:
    """Bounds of the share alive."""
    tail = 0.5 * (1.0 - level)
    first, second = (at_risk - deaths + 1).astype(np.float64), deaths.astype(np.float64)
    upper = _product(first, second)
    lower = _product(np.append(first, followed), np.append(second, 1.0)) if followed else None

    def below(share: float) -> float:
        by_lower = 1.0 if lower is None else beta_below(share, *lower)
        by_upper = 0.0 if upper is None else beta_below(share, *upper)
        return 0.5 * (by_lower + by_upper)

    low = 0.0 if lower is None else optimize.root_scalar(lambda s: below(s) - tail, bracket=(0.0, 1.0)).root
    high = 1.0 if upper is None else optimize.root_scalar(lambda s: below(s) - 1.0 + tail, bracket=(0.0, 1.0)).root
    return low, high


def _product(a: Floats, b: Floats) -> tuple[float, float] | None:
    """Parameters of the beta distribution with the mean and variance of a product of beta variables; None if empty."""
    if not len(a):
        return None
    mean = float(np.prod(a / (a + b)))
    square = float(np.prod(a * (a + 1.0) / ((a + b) * (a + b + 1.0))))
    sum_of_both = (mean - square) / (square - mean**2)
    return mean * sum_of_both, (1.0 - mean) * sum_of_both


def log_rank(
    lived: Floats,
    ended: Flags,
    first: Flags,
    stratum: NDArray[np.int64],
    draws: int = 2000,
) -> float:
    """The p value of a log-rank test that two groups of worlds die out alike (Mantel 1966).

    It is a permutation test within strata, since the usual chi-squared approximation is inaccurate for few worlds.

    Args:
        lived: Last recorded step of each world, shape (worlds,) [step].
        ended: Whether the world died out then, shape (worlds,).
        first: Whether the world belongs to the first group, shape (worlds,).
        stratum: Stratum of each world, such as its condition apart from the group, shape (worlds,).
        draws: Number of random permutations.

    Returns:
        The two-sided p value; NaN if no world died out, or a group has no worlds.
    """
    if not ended.any() or first.all() or not first.any():
        return math.nan
    rng = np.random.default_rng(_SEED)
    groups = np.tile(first, (draws + 1, 1))
    difference, variance = np.zeros(draws + 1), np.zeros(draws + 1)
    for stratum_index in np.unique(stratum):
        in_stratum = stratum == stratum_index
        stratum_groups = groups[:, in_stratum]
        stratum_groups[1:] = rng.permuted(stratum_groups[1:], axis=1)
        step = np.unique(lived[in_stratum & ended])[:, None]
        at_risk, died = lived[in_stratum] >= step, (lived[in_stratum] == step) & ended[in_stratum]
        risk, deaths = at_risk.sum(axis=1), died.sum(axis=1)
        share = stratum_groups.astype(float) @ at_risk.T / risk
        difference += (stratum_groups.astype(float) @ died.T - deaths * share).sum(axis=1)
        correction = np.where(risk > 1, (risk - deaths) / np.maximum(risk - 1, 1), 0.0)
        variance += (deaths * share * (1.0 - share) * correction).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        statistics = np.nan_to_num(difference**2 / variance)
    return float(np.count_nonzero(statistics >= statistics[0] - 1e-9) / (draws + 1))
