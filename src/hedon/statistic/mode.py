"""Does the distribution of a weight over worlds have one mode or more? Hartigan & Hartigan's (1985) dip test.

The *dip* is the smallest distance between the empirical distribution and any distribution with a single mode, measured
as the largest difference between the two cumulative curves. Its null distribution is simulated from the uniform
distribution, which has the largest dip of all distributions with one mode. For other shapes the test is therefore
conservative.

Reasons for this test: it depends only on modes, whereas a mixture of two normals also fits a single skewed hump; it
needs no bandwidth; and it keeps its level with few worlds and at hard limits such as the limits of weights. Silverman's
test, which we also tried, called a flat distribution of 40 worlds bimodal three times as often as its level allows.

Failure to find a second mode is not evidence of a single mode. With few worlds the test has little power, since chance
also decides how many worlds end at each mode. `power` is the chance that two clear modes would be found.
"""

from dataclasses import dataclass
from functools import cache

import diptest
import numpy as np
from numpy.typing import NDArray

LEVEL = 0.05
_NULL_SAMPLES = 2000
_CLEAR = 6.0  # distance between two clear modes, in standard deviations of worlds around each
_POWER_TRIALS = 400
_FEWEST = 4  # worlds: two at each of two modes
_SEED = 1985  # of the null distribution, so that equal worlds get equal answers

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Modes:
    """Whether values have one mode or more.

    Attributes:
        worlds: Number of values.
        answer: "two" (a single mode is rejected at 5 %) or "undecided".
        dip: The test statistic; NaN for fewer than four values.
        p: Chance of a dip at least this large under a single mode; NaN for fewer than four values.
        power: Chance that two clear modes, each equally likely for a world, would have been found.
        low, high: Means of the values on either side of the widest gap that leaves two on each side; NaN unless the
            answer is "two".
        low_worlds, high_worlds: Number of values on either side; 0 unless the answer is "two".
    """

    worlds: int
    answer: str
    dip: float
    p: float
    power: float
    low: float = np.nan
    high: float = np.nan
    low_worlds: int = 0
    high_worlds: int = 0


def modes(values: Floats) -> Modes:
    """Tests a single mode against several.

    Args:
        values: Value of each world, shape (n,); NaN is ignored.
    """
    values = np.sort(values[np.isfinite(values)])
    count = len(values)
    if count < _FEWEST:
        return Modes(count, "undecided", np.nan, np.nan, 0.0)
    statistic = dip(values)
    null, power = _null_and_power(count)
    p = float((np.count_nonzero(null >= statistic) + 1) / (len(null) + 1))
    if p > LEVEL:
        return Modes(count, "undecided", statistic, p, power)
    split = 2 + int(np.argmax(np.diff(values[1:-1])))
    low, high = values[:split], values[split:]
    return Modes(count, "two", statistic, p, power, float(low.mean()), float(high.mean()), len(low), len(high))


def dip(values: Floats) -> float:
    """The dip of a sample, from 1/(2n) for evenly spread values to 1/4 for two points.

    Args:
        values: The sample in ascending order, shape (n,), n > 0.
    """
    statistic = diptest.dipstat(values, allow_zero=False, sort_x=False)
    assert isinstance(statistic, float)  # a tuple only if the full output is requested
    return statistic


@cache
def _null_and_power(count: int) -> tuple[Floats, float]:
    """Dips of uniform samples, and how often samples with two clear modes exceed 95 % of them."""
    rng = np.random.default_rng(_SEED)
    null = np.array([dip(np.sort(rng.random(count))) for _ in range(_NULL_SAMPLES)])
    limit = np.quantile(null, 1.0 - LEVEL)
    shifts = _CLEAR * (rng.random((_POWER_TRIALS, count)) < 0.5)
    detected = [dip(np.sort(rng.normal(size=count) + shift)) > limit for shift in shifts]
    return null, float(np.mean(detected))
