"""Which share of worlds dies out by a step? Kaplan & Meier (1958) over worlds, with an interval for few of them.

A world that lives when its record ends is *censored*: it may still die out before the step in question. Leaving
it out, or counting the extinct alone, makes the share too large, because a world that died out is known to the end
however short it was.
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
"""Of exchanges, so that the same worlds give the same chance."""


@dataclass(frozen=True)
class ExtinctShare:
    """The share of worlds that is extinct by a step.

    Attributes:
        share: product-limit estimate; where no world was followed so far, that by `known_until`, which is a lower
            bound. NaN without worlds.
        low, high: bounds of its interval; NaN without worlds.
        worlds: all that were asked.
        extinct: of these, by the step.
        followed: of these, alive at the step.
        known_until: up to which step the estimate reaches [step].
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

    The interval is the mid-p form of the beta product confidence procedure. The chance to live on past the deaths is
    a product of beta variables, one for each step at which worlds died; half the weight lies on that product and half
    on the product with one more factor, for a death that could follow at once. Without censoring it is the mid-p
    interval of a share. Where no world is left at risk, nothing limits the share from above.

    Source: Fay, Brittain and Proschan (2013), Biostatistics 14, 723–736; mid-p: Fay and Brittain (2016), Statistics in
    Medicine 35, 2726–2740. Products are matched by a beta law of equal mean and variance, as proposed there.

    Args:
        duration: step of extinction, or at which the record of a living world ends [step], shape (n,).
        died: whether the world died out, shape (n,).
        until: the step by which worlds count as extinct [step].
        level: of the interval.
    """
    if not len(duration):
        return ExtinctShare(np.nan, np.nan, np.nan, 0, 0, 0, 0.0)
    gone = died & (duration <= until)
    time = np.minimum(duration, until)
    followed = int(np.count_nonzero(~gone & (time >= until)))
    curve = survival_curve(time, gone)
    alive = float(curve.share[-1]) if len(curve.age) else 1.0
    low, high = _bounds(curve.at_risk, curve.deaths, followed, level)
    reached = float(until) if followed or gone.all() else float(time.max())
    return ExtinctShare(1.0 - alive, 1.0 - high, 1.0 - low, len(time), int(gone.sum()), followed, reached)


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
    """Parameters of the beta law with mean and variance of a product of beta variables; None for an empty product."""
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
    """The chance of a log-rank statistic this large or larger if two groups of worlds die out alike (Mantel 1966).

    Worlds exchange their groups at random within strata, since with few worlds the usual law of chi squared is off.

    Args:
        lived: Steps up to which each world was seen, (worlds,) [step].
        ended: Whether it died out then, (worlds,).
        first: Whether it is of the first group, (worlds,).
        stratum: Setting that it has beside its group, (worlds,).
        draws: Exchanges.

    Returns:
        The two-sided chance; NaN if no world died out, or a group has none.
    """
    if not ended.any() or first.all() or not first.any():
        return math.nan
    rng = np.random.default_rng(_SEED)
    groups = np.tile(first, (draws + 1, 1))
    difference, variance = np.zeros(draws + 1), np.zeros(draws + 1)
    for each in np.unique(stratum):
        mine = stratum == each
        own = groups[:, mine]
        own[1:] = rng.permuted(own[1:], axis=1)
        step = np.unique(lived[mine & ended])[:, None]
        at_risk, died = lived[mine] >= step, (lived[mine] == step) & ended[mine]
        risk, deaths = at_risk.sum(axis=1), died.sum(axis=1)
        share = own.astype(float) @ at_risk.T / risk
        difference += (own.astype(float) @ died.T - deaths * share).sum(axis=1)
        left = np.where(risk > 1, (risk - deaths) / np.maximum(risk - 1, 1), 0.0)
        variance += (deaths * share * (1.0 - share) * left).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.nan_to_num(difference**2 / variance)
    return float(np.count_nonzero(found >= found[0] - 1e-9) / (draws + 1))
