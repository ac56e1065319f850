"""Is a world's mean weight held near a value? Ornstein–Uhlenbeck against Brownian motion, over several worlds.

At equal intervals, a mean that is pulled back to an optimum θ moves by x' − x = (1 − exp(−α))·(θ − x) + shock; without
a pull α is 0 and shocks alone are left. One α and one θ are fitted to all worlds at once, by least squares, each world
in units of its own steps.

What a neutral gene does in the same worlds is the null hypothesis, and its steps are the shocks: where mutations have
heavy tails, a mutant far out comes, shifts the mean and mostly leaves no line, which looks like a pull to normal
shocks. A fit also finds some pull in a Brownian motion of finite length. So courses of neutral genes, walked down the
same pedigrees, are fitted likewise. Pulled by some α, they tell which estimates that α gives, and this is turned
around: the strength is the α whose median estimate is the one seen, and its interval holds the α for which the one
seen is not too far out.

Sources: Hansen (1997), Evolution 51, 1341–1351, for the model; Andrews (1993), Econometrica 61, 139–165, for estimates
that are right in the median.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL

SHOWN_LEVEL = 0.05
"""An optimum is given only where a pull is found at this level: a gene that drifts has none."""
_RATES = np.concatenate([[0.0], np.geomspace(1e-3, 3.0, 25)])
"""Strengths that are tried [1/interval]: a memory of 1000 intervals to one of a third."""
_ROUNDING = 1e-12  # share of a sum of squares that is 0

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Reversion:
    """Whether the mean weights of some worlds are held near a value.

    Attributes:
        worlds: that enter it.
        intervals: between two values of a course, over all worlds.
        strength: α [1/interval]; 0 where nothing pulls.
        strength_low, strength_high: bounds of its 95 % interval; infinite where the pull may be too fast to see.
        optimum: θ, in units of the weight; NaN where no pull was found, as its bounds.
        optimum_low, optimum_high: bounds of its 95 % interval.
        p: one-sided chance of so strong a pull among neutral genes.
    """

    worlds: int
    intervals: int
    strength: float
    strength_low: float
    strength_high: float
    optimum: float
    optimum_low: float
    optimum_high: float
    p: float


def reversion(courses: Sequence[Floats], neutral: Sequence[Floats], level: float = LEVEL) -> Reversion | None:
    """Fits a common pull and a common optimum to the courses of some worlds.

    Args:
        courses: mean weight at equal intervals, per world, shape (times,); worlds may differ in length, not in the
            interval. A course that is not usable is left out.
        neutral: courses of neutral genes of the same world at the same times, per world, shape (walks, times); the
            same number of walks in each.
        level: of the intervals.

    Returns:
        None where no world is left.
    """
    usable = [i for i, course in enumerate(courses) if is_usable(course)]
    if not usable:
        return None
    seen = [courses[i] for i in usable]
    walks = [neutral[i] for i in usable]
    slope, ratio, optimum = (float(x[0]) for x in _fit([_sums(course[None]) for course in seen]))
    ratios = _fit([_sums(walk) for walk in walks])[1]
    p = float((np.count_nonzero(ratios <= ratio) + 1) / (len(ratios) + 1))
    shocks = [np.diff(w, axis=1) * (_size(c[None]) / _size(w))[:, None] for c, w in zip(seen, walks, strict=True)]
    tail = 0.5 * (1.0 - level)
    best = np.array([_reachable(seen, _best_optimum(seen, 1.0 - np.exp(-rate))) for rate in _RATES])
    tried = np.quantile(-_pulled(seen, shocks, _RATES, best)[0], (tail, 0.5, 1.0 - tail), axis=1)
    high, middle, low = (_rate_where(estimates, -slope) for estimates in tried)
    bounds = (np.nan, np.nan)
    if p <= SHOWN_LEVEL:
        rate = min(max(middle, _RATES[1]), _RATES[-1])
        center = _reachable(seen, optimum)
        errors = _pulled(seen, shocks, np.array([rate]), np.array([center]))[2][0] - center
        bounds = optimum - np.quantile(errors, (1.0 - tail, tail))
    return Reversion(
        worlds=len(seen),
        intervals=sum(len(course) - 1 for course in seen),
        strength=middle,
        strength_low=low,
        strength_high=high,
        optimum=optimum if p <= SHOWN_LEVEL else np.nan,
        optimum_low=float(bounds[0]),
        optimum_high=float(bounds[1]),
        p=p,
    )


def is_usable(course: Floats) -> bool:
    """Whether a course says anything of a pull: it has four values or more, and changes before its last step.

    Args:
        course: mean weight at equal intervals, (times,).
    """
    return len(course) > 3 and float(np.ptp(course[:-1])) > 0


def _sums(courses: Floats) -> Floats:
    """What a fit needs of the courses of one world, (samples, times): shape (6, samples).

    Number of steps; sums of the values before the steps, of their squares, of the steps, of the products of both, and
    of the squares of the steps.
    """
    step, value = np.diff(courses, axis=1), courses[:, :-1]
    terms = (np.ones_like(step), value, value**2, step, value * step, step**2)
    return np.array([term.sum(axis=1) for term in terms])


def _fit(sums: Sequence[Floats]) -> tuple[Floats, Floats, Floats]:
    """Slope of the step against the value, that slope over its standard error, and where the step is 0.

    Args:
        sums: per world, as `_sums` gives them, shape (6, ...).

    Returns:
        Each (...).
    """
    count = sum(int(each[0].flat[0]) for each in sums)
    one, x, xx, y, xy, yy = np.sum([each * _per_step(each) for each in sums], axis=0)
    spread = xx - x**2 / one
    varies = spread > _ROUNDING * xx  # else values before the last step are all the same, and say nothing of a pull
    spread = np.where(varies, spread, 1.0)
    slope = np.where(varies, (xy - x * y / one) / spread, 0.0)
    rest = yy - y**2 / one - slope**2 * spread
    error = np.sqrt(np.maximum(rest, _ROUNDING * yy) / max(count - 2, 1) / spread)
    with np.errstate(divide="ignore", invalid="ignore"):
        return slope, np.where(varies, slope / error, 0.0), (x - y / slope) / one


def _per_step(sums: Floats) -> Floats:
    """What brings squares into units of the mean square step of a world and a sample; 1 where nothing moves."""
    moves = sums[5] > 0
    return np.where(moves, sums[0] / np.where(moves, sums[5], 1.0), 1.0)


def _size(course: Floats) -> Floats:
    """Root mean square step of each course, shape (samples,)."""
    size = np.sqrt(np.mean(np.diff(course, axis=1) ** 2, axis=1))
    return np.where(size > 0, size, 1.0)


def _pulled(
    seen: Sequence[Floats], shocks: Sequence[Floats], rates: Floats, optima: Floats
) -> tuple[Floats, Floats, Floats]:
    """Fits to courses that begin where those seen do, take the shocks, and are pulled: each (rates, samples).

    Step by step for all rates and samples, which stay in the processor's cache: four times as fast as course by course.
    """
    kept = np.exp(-rates)[:, None]
    worlds = []
    for course, shock in zip(seen, shocks, strict=True):
        away = np.repeat((course[0] - optima)[:, None], len(shock), axis=1)
        sums = np.zeros((6, *away.shape))
        sums[0] = shock.shape[1]
        for each in np.ascontiguousarray(shock.T):
            after = kept * away
            after += each
            step = after - away
            for total, term in zip(sums[1:], (away, away * away, step, away * step, step * step), strict=True):
                total += term
            away = after
        worlds.append(sums)
    slope, ratio, optimum = _fit(worlds)
    return slope, ratio, optimum + optima[:, None]


def _best_optimum(seen: Sequence[Floats], pull: float) -> float:
    """The optimum that fits best if a share of the distance to it is gone after each interval."""
    weights = np.array([(len(c) - 1) / float(_size(c[None])[0]) ** 2 for c in seen])
    means = np.array([c[:-1].mean() + (np.diff(c).mean() / pull if pull > 0 else 0.0) for c in seen])
    return float(weights @ means / weights.sum())


def _reachable(seen: Sequence[Floats], optimum: float) -> float:
    return float(np.clip(optimum, min(c.min() for c in seen), max(c.max() for c in seen)))


def _rate_where(estimates: Floats, seen: float) -> float:
    """The rate at which a quantile of the estimates is the one seen; 0 or infinite beyond those tried."""
    rising = np.maximum.accumulate(estimates)
    if seen <= rising[0]:
        return 0.0
    if seen > rising[-1]:
        return np.inf
    i = int(np.searchsorted(rising, seen))
    share = (seen - rising[i - 1]) / (rising[i] - rising[i - 1])
    return float(_RATES[i - 1] + share * (_RATES[i] - _RATES[i - 1]))
