"""Did a trait go further, or more in one direction, than drift alone would have carried it? Tests on scores.

In each world the trait is ranked among draws of what drift does there, and the rank becomes a standard normal *score*.
Over worlds, scores that lean to one side say that the trait was pushed in a *direction* (Stouffer); scores that are
large, whatever their sign, that it was carried a *distance* (chi-squared): a trait with two modes shows in the second
alone. Scores that are all too small say that it was *held* (the lower tail).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL, distance_interval, mean_bounds
from hedon.statistic.law import chi2_above, chi2_below, normal_above, normal_quantile

NAN = math.nan
_TIE = 1e-6  # in units of a trait: records keep it with seven digits, walks with more

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ScoreTest:
    """Scores of several worlds against drift.

    Attributes:
        test: "direction", "distance" or "held".
        worlds: number of scores.
        effect: for "direction" the mean score, in standard deviations of drift; else the root mean square score, 1
            under drift. NaN without scores, as p.
        low, high: bounds of the effect's 95 % interval: Student's t over worlds for "direction", else from the
            chi-squared law of normal scores; NaN with fewer than two worlds.
        p: two-sided for "direction"; the chance of a larger effect for "distance", of a smaller one for "held".
        p_holm: p corrected for other tests; NaN where it is not.
        drift_low, drift_high: for "direction", bounds of the effect's 95 % interval by the spread that scores have
            under drift, 1, as p takes it, and not by that between these worlds; NaN for other tests.
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

    Among draws that equal the value, its rank is drawn at random: with a rank in their middle, a trait that hardly ever
    changes would have scores that are all too small.

    Args:
        value: what is judged.
        null: independent draws under the null hypothesis, (draws,).
        rng: source of chance for ties.

    Returns:
        NaN if all draws are equal, since such a trait cannot change.
    """
    if np.ptp(null) <= _TIE:
        return NAN
    tied = np.abs(null - value) <= _TIE
    below = np.count_nonzero((null < value) & ~tied) + int(rng.integers(0, np.count_nonzero(tied) + 1))
    return normal_quantile((below + 0.5) / (len(null) + 1))


def score_tests(scores: Floats) -> list[ScoreTest]:
    """The three tests, in the order direction, distance, held.

    Args:
        scores: one per world, shape (n,); NaN is left out.
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
    wide = (low, high) if n > 1 else (NAN, NAN)
    return [
        ScoreTest("direction", n, effect, t_low, t_high, p, NAN, effect - half, effect + half),
        ScoreTest("distance", n, distance, *wide, chi2_above(square, n)),
        ScoreTest("held", n, distance, *wide, chi2_below(square, n)),
    ]


def rank_sum_p(ranks: Sequence[int], of: Sequence[int]) -> float:
    """Two-sided chance of ranks whose sum is this far from its middle, if each rank is as likely as any other."""
    chances = np.ones(1)
    for count in of:
        chances = np.convolve(chances, np.full(count, 1.0 / count))
    at = sum(ranks) - len(ranks)
    return min(1.0, 2.0 * float(min(chances[: at + 1].sum(), chances[at:].sum())))
