"""Is the mean weight of worlds held near a value? Ornstein–Uhlenbeck against Brownian motion, over several worlds.

If a mean is pulled back to an optimum θ, it moves at equal intervals by x' − x = (1 − exp(−α))·(θ − x) + shock. Without
a pull α is 0, and only shocks remain. One α and one θ are fitted to all worlds together by least squares, each world
in units of its own steps.

Neutral genes in the same worlds provide the null hypothesis, and their steps are the shocks. This is needed for two
reasons. If mutations have heavy tails, an extreme mutant shifts the mean and then mostly leaves no descendants, which
looks like a pull if shocks are assumed to be normal. A fit also finds some pull in a Brownian motion of finite length.
Neutral genes, walked down the same pedigrees, are therefore fitted in the same way. Simulating them with a pull α shows
which estimates that α gives. This is then inverted: the strength is the α whose median estimate equals the observed
one, and its interval contains every α for which the observed estimate is not too extreme.

Sources: Hansen (1997), Evolution 51, 1341–1351, for the model; Andrews (1993), Econometrica 61, 139–165, for
median-unbiased estimates.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL

SHOWN_LEVEL = 0.05
"""Level at which a pull must be found for an optimum to be reported, since a drifting gene has none."""
_RATES = np.concatenate([[0.0], np.geomspace(1e-3, 3.0, 25)])
"""Strengths that are tried [1/interval], for memories of 1000 intervals to a third of one."""
_ROUNDING = 1e-12  # share of a sum of squares that counts as 0

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Reversion:
    """Whether the mean weights of some worlds are held near a value.

    Attributes:
        worlds: Number of worlds used.
        intervals: Number of intervals between values, over all worlds.
        strength: α [1/interval]; 0 without a pull.
        strength_low, strength_high: Bounds of its 95 % interval; infinite if the pull may be too fast to measure.
        optimum: θ, in units of the weight; NaN if no pull was found.
        optimum_low, optimum_high: Bounds of its 95 % interval; NaN if no pull was found.
        p: One-sided p value: the chance of so strong a pull among neutral genes.
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
        courses: Mean weight of each world at equal intervals, shape (times,); worlds may differ in length but not in
            the interval. A course that is not usable is left out.
        neutral: Courses of neutral genes of the same worlds at the same times, each of shape (walks, times), with the
            same number of walks in each.
        level: Confidence level of the intervals.

    Returns:
        The fit; None if no usable world is left.
    """
    usable = [i for i, course in enumerate(courses) if is_usable(course)]
    if not usable:
        return None
    usable_courses = [courses[i] for i in usable]
    walks = [neutral[i] for i in usable]
    slope, ratio, optimum = (float(x[0]) for x in _fit([_sums(course[None]) for course in usable_courses]))
    ratios = _fit([_sums(walk) for walk in walks])[1]
    p = float((np.count_nonzero(ratios <= ratio) + 1) / (len(ratios) + 1))
    shocks = [
        np.diff(w, axis=1) * (_size(c[None]) / _size(w))[:, None] for c, w in zip(usable_courses, walks, strict=True)
    ]
    tail = 0.5 * (1.0 - level)
    best = np.array([_reachable(usable_courses, _best_optimum(usable_courses, 1.0 - np.exp(-rate))) for rate in _RATES])
    quantiles = np.quantile(-_pulled(usable_courses, shocks, _RATES, best)[0], (tail, 0.5, 1.0 - tail), axis=1)
    high, middle, low = (_rate_where(estimates, -slope) for estimates in quantiles)
    bounds = (np.nan, np.nan)
    is_shown = p <= SHOWN_LEVEL and middle > 0  # a steady course can look unlike drift without being pulled anywhere
    if is_shown:
        rate = min(max(middle, _RATES[1]), _RATES[-1])
        center = _reachable(usable_courses, optimum)
        errors = _pulled(usable_courses, shocks, np.array([rate]), np.array([center]))[2][0] - center
        bounds = optimum - np.quantile(errors, (1.0 - tail, tail))
    return Reversion(
        worlds=len(usable_courses),
        intervals=sum(len(course) - 1 for course in usable_courses),
        strength=middle,
        strength_low=low,
        strength_high=high,
        optimum=optimum if is_shown else np.nan,
        optimum_low=float(bounds[0]),
        optimum_high=float(bounds[1]),
        p=p,
    )


def is_usable(course: Floats) -> bool:
    """Whether a course is informative about a pull: it has at least four values, and changes before its last step.

    Args:
        course: Mean weight at equal intervals, shape (times,).
    """
    return len(course) > 3 and float(np.ptp(course[:-1])) > 0


def _sums(courses: Floats) -> Floats:
    """The sums over the courses of one world, (samples, times), that a fit needs: shape (6, samples).

    They are the number of steps, and the sums of the values before the steps, of their squares, of the steps, of the
    products of both, and of the squares of the steps.
    """
    step, value = np.diff(courses, axis=1), courses[:, :-1]
    terms = (np.ones_like(step), value, value**2, step, value * step, step**2)
    return np.array([term.sum(axis=1) for term in terms])


def _fit(sums: Sequence[Floats]) -> tuple[Floats, Floats, Floats]:
    """The slope of the step against the value, that slope over its standard error, and the value where the step is 0.

    Args:
        sums: Sums of each world from `_sums`, shape (6, ...).

    Returns:
        Three arrays of shape (...).
    """
    count = sum(int(world_sums[0].flat[0]) for world_sums in sums)
    one, x, xx, y, xy, yy = np.sum([world_sums * _per_step(world_sums) for world_sums in sums], axis=0)
    spread = xx - x**2 / one
    varies = spread > _ROUNDING * xx  # otherwise all values before the last step are equal, and uninformative
    spread = np.where(varies, spread, 1.0)
    slope = np.where(varies, (xy - x * y / one) / spread, 0.0)
    residual = yy - y**2 / one - slope**2 * spread
    error = np.sqrt(np.maximum(residual, _ROUNDING * yy) / max(count - 2, 1) / spread)
    with np.errstate(divide="ignore", invalid="ignore"):
        return slope, np.where(varies, slope / error, 0.0), (x - y / slope) / one


def _per_step(sums: Floats) -> Floats:
    """Factors that convert squares to units of the mean square step of a world and a sample; 1 without movement."""
    moves = sums[5] > 0
    return np.where(moves, sums[0] / np.where(moves, sums[5], 1.0), 1.0)


def _size(course: Floats) -> Floats:
    """Root mean square step of each course, shape (samples,)."""
    size = np.sqrt(np.mean(np.diff(course, axis=1) ** 2, axis=1))
    return np.where(size > 0, size, 1.0)


def _pulled(
    courses: Sequence[Floats], shocks: Sequence[Floats], rates: Floats, optima: Floats
) -> tuple[Floats, Floats, Floats]:
    """Fits to simulated courses with the observed starts, the given shocks and a pull: each (rates, samples).

    All rates and samples advance together, step by step, so that they stay in the processor's cache; this is four times
    as fast as simulating course by course.
    """
    retained = np.exp(-rates)[:, None]
    worlds = []
    for course, shock in zip(courses, shocks, strict=True):
        deviations = np.repeat((course[0] - optima)[:, None], len(shock), axis=1)
        sums = np.zeros((6, *deviations.shape))
        sums[0] = shock.shape[1]
        for step_shocks in np.ascontiguousarray(shock.T):
            next_values = retained * deviations
            next_values += step_shocks
            step = next_values - deviations
            for total, term in zip(
                sums[1:], (deviations, deviations * deviations, step, deviations * step, step * step), strict=True
            ):
                total += term
            deviations = next_values
        worlds.append(sums)
    slope, ratio, optimum = _fit(worlds)
    return slope, ratio, optimum + optima[:, None]


def _best_optimum(courses: Sequence[Floats], pull: float) -> float:
    """The best-fitting optimum if each interval removes a share `pull` of the distance to it."""
    weights = np.array([(len(c) - 1) / float(_size(c[None])[0]) ** 2 for c in courses])
    means = np.array([c[:-1].mean() + (np.diff(c).mean() / pull if pull > 0 else 0.0) for c in courses])
    return float(weights @ means / weights.sum())


def _reachable(courses: Sequence[Floats], optimum: float) -> float:
    return float(np.clip(optimum, min(c.min() for c in courses), max(c.max() for c in courses)))


def _rate_where(estimates: Floats, observed: float) -> float:
    """The rate at which a quantile of the estimates equals the observed one; 0 or infinite beyond the rates tried."""
    rising = np.maximum.accumulate(estimates)
    if observed <= rising[0]:
        return 0.0
    if observed > rising[-1]:
        return np.inf
    i = int(np.searchsorted(rising, observed))
    share = (observed - rising[i - 1]) / (rising[i] - rising[i - 1])
    return float(_RATES[i - 1] + share * (_RATES[i] - _RATES[i - 1]))
