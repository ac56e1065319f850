"""Has the distribution of a weight over worlds one mode, or more? Hartigan & Hartigan's (1985) dip test.

The *dip* is the least distance between the empirical distribution and any distribution with a single mode: the
largest difference between the two cumulative curves. Its null distribution is simulated from the uniform, the
distribution with one mode that dips most, so that other shapes are called two modes less often than promised.

Why this test: it asks for modes and nothing else, where a mixture of two normals also fits one skewed hump; it has no
bandwidth; and it holds its level with few worlds and at hard limits such as those of the weights, where Silverman's
test, tried as well, called a flat distribution of 40 worlds bimodal three times as often as promised.
Not finding a second mode is no evidence that there is one: with few worlds the test has little power, since chance also
decides how many worlds end at each mode. `power` says how often two clear modes would be found.
"""

from dataclasses import dataclass
from functools import cache

import diptest
import numpy as np
from numpy.typing import NDArray

LEVEL = 0.05
_NULL_SAMPLES = 2000
_CLEAR = 6.0  # standard deviations between two clear modes, of worlds around each
_POWER_TRIALS = 400
_FEWEST = 4  # worlds: two at each of two modes
_SEED = 1985  # of the null distribution, so that equal worlds get equal answers

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Modes:
    """Whether values have one mode or more.

    Attributes:
        worlds: number of values.
        answer: "two" (one mode is rejected at 5 %) or "undecided".
        dip: the statistic; NaN for fewer than four values, as p.
        p: chance of such a dip if there is one mode.
        power: chance that two clear modes, at which a world ends with equal chance, would have been found.
        low, high: mean of the values on either side of the widest gap that leaves two on each; NaN unless the
            answer is "two".
        low_worlds, high_worlds: how many are there; 0 likewise.
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
    """Tests one mode against more.

    Args:
        values: one per world, (n,); NaN is left out.
    """
    values = np.sort(values[np.isfinite(values)])
    count = len(values)
    if count < _FEWEST:
        return Modes(count, "undecided", np.nan, np.nan, 0.0)
    found = dip(values)
    null, power = _null_and_power(count)
    p = float((np.count_nonzero(null >= found) + 1) / (len(null) + 1))
    if p > LEVEL:
        return Modes(count, "undecided", found, p, power)
    split = 2 + int(np.argmax(np.diff(values[1:-1])))
    low, high = values[:split], values[split:]
    return Modes(count, "two", found, p, power, float(low.mean()), float(high.mean()), len(low), len(high))


def dip(values: Floats) -> float:
    """The dip of a sample, from 1/(2n), for evenly spread values, to 1/4, for two points.

    Args:
        values: ascending, shape (n,), n > 0.
    """
    found = diptest.dipstat(values, allow_zero=False, sort_x=False)
    assert isinstance(found, float)  # a tuple only with its full output
    return found


@cache
def _null_and_power(count: int) -> tuple[Floats, float]:
    """Dips of uniform samples, and how often two clear modes dip further than 95 % of these."""
    rng = np.random.default_rng(_SEED)
    null = np.array([dip(np.sort(rng.random(count))) for _ in range(_NULL_SAMPLES)])
    limit = np.quantile(null, 1.0 - LEVEL)
    shifts = _CLEAR * (rng.random((_POWER_TRIALS, count)) < 0.5)
    found = [dip(np.sort(rng.normal(size=count) + shift)) > limit for shift in shifts]
    return null, float(np.mean(found))
