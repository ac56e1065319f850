"""Did a trait move further, or more in one direction, than under drift? Tests of scores.

In each world, the trait is ranked among values simulated under drift, and the rank becomes a standard normal *score*.
There are three tests over worlds. Scores that lean to one side show that the trait was pushed in a *direction*
(Stouffer). Scores that are large, whatever their sign, show that it was carried a *distance* (chi-squared); only this
test detects a trait with two modes. Scores that are all too small show that the trait was *held* (the lower tail).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL, distance_interval, mean_bounds
from hedon.statistic.law import chi2_above, chi2_below, normal_above, normal_quantile

NAN = math.nan
_TIE = 1e-6  # in units of a trait, since records have seven digits and walks have more

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ScoreTest:
    """A test of the scores of several worlds against drift.

    Attributes:
        test: "direction", "distance" or "held".
        worlds: Number of scores.
        effect: For "direction" the mean score, in standard deviations of drift; otherwise the root mean square score,
            which is 1 under drift. NaN without scores.
        low, high: Bounds of the effect's 95 % interval: Student's t over worlds for "direction", otherwise from the
            chi-squared distribution of normal scores; NaN with fewer than two worlds.
        p: Two-sided for "direction"; the chance of a larger effect for "distance", and of a smaller one for "held". NaN
            without scores.
        p_holm: p corrected for other tests; NaN if not corrected.
        drift_low, drift_high: For "direction", bounds of the effect's 95 % interval computed, like p, from the standard
            deviation of scores under drift, 1, instead of the one between these worlds; NaN for other tests.
    """

    test: str
    worlds: int
    effect: float
    low: float
    high: float
    p: float
    p_holm: float = NAN
    drift_low: float = NAN
    drift_high: float = NAN


def rank_score(value: float, null: Floats, rng: np.random.Generator) -> float:
    """The standard normal score of a value's rank among draws under the null hypothesis.

    Ties are broken at random. With the middle rank instead, a trait that hardly ever changes would have scores that are
    all too small.

    Args:
        value: The observed value.
        null: Independent draws under the null hypothesis, shape (draws,).
        rng: Source of random numbers for ties.

    Returns:
        The score; NaN if all draws are equal, since such a trait cannot change.
    """
    if np.ptp(null) <= _TIE:
        return NAN
    is_tied = np.abs(null - value) <= _TIE
    rank = np.count_nonzero((null < value) & ~is_tied) + int(rng.integers(0, np.count_nonzero(is_tied) + 1))
    return normal_quantile((rank + 0.5) / (len(null) + 1))


def score_tests(scores: Floats) -> list[ScoreTest]:
    """The three tests, in the order direction, distance, held.

    Args:
        scores: Score of each world, shape (n,); NaN is ignored.
    """
    scores = scores[np.isfinite(scores)]
    n = len(scores)
    if n == 0:
        return [ScoreTest(test, 0, NAN, NAN, NAN, NAN) for test in ("direction", "distance", "held")]
    p = float(2.0 * normal_above(abs(scores.sum()) / math.sqrt(n)))
    half = normal_quantile(0.5 + LEVEL / 2) / math.sqrt(n)
    effect, t_low, t_high = mean_bounds(scores)
    square = float(np.sum(scores**2))
    distance, low, high = distance_interval(scores)
    interval = (low, high) if n > 1 else (NAN, NAN)
    return [
        ScoreTest("direction", n, effect, t_low, t_high, p, NAN, effect - half, effect + half),
        ScoreTest("distance", n, distance, *interval, chi2_above(square, n)),
        ScoreTest("held", n, distance, *interval, chi2_below(square, n)),
    ]


def rank_sum_p(ranks: Sequence[int], of: Sequence[int]) -> float:
    """The two-sided p value of a sum of ranks, if all ranks are equally likely.

    Args:
        ranks: Rank of each world.
        of: Number of possible ranks in each world.
    """
    chances = np.ones(1)
    for count in of:
        chances = np.convolve(chances, np.full(count, 1.0 / count))
    index = sum(ranks) - len(ranks)
    return min(1.0, 2.0 * float(min(chances[: index + 1].sum(), chances[index:].sum())))
