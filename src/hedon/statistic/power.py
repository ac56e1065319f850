"""How many worlds are needed to find an effect with the test that is used?

Pairs are compared with a sign-flip permutation test. With few pairs, such a test has few possible p values: with five
pairs the smallest is 2/2⁵, so no effect is ever significant at 0.05. Independent worlds are compared with Welch's t
test, which has fewer degrees of freedom than Student's. The power of both tests is simulated up to `SIMULATED` worlds.
Beyond, it equals the power of Student's t test to within one percentage point.
"""

import math
from bisect import bisect_left
from functools import cache
from typing import Any, Literal

import numpy as np
from lazy_loader import load
from numpy.typing import NDArray

from hedon.statistic.law import t_quantile

optimize: Any = load("scipy.optimize", suppress_warning=True)
stats: Any = load("scipy.stats", suppress_warning=True)

MOST = 10_000_000
"""Largest number of worlds considered."""
SIMULATED = 12
"""Largest number of worlds per condition for which the power is simulated."""
_TRIES = 4000
"""Number of simulated data sets; the standard error of a power is below 0.008."""
_SEED = 20261127
_EQUAL = 1e-9
"""Relative difference below which two sums count as equal, since they are computed in different ways."""
CERTAIN = 10.0
"""Distance of an effect beyond the critical value at which the power counts as 1, in standard errors."""


def t_test_power(effect: float, worlds: float, level: float = 0.05, *, paired: bool) -> float:
    """The power of a two-sided t test. Source: Cohen (1988), sections 2.3 and 2.4.

    Args:
        effect: Difference of the means, in standard deviations.
        worlds: Number of pairs, or of worlds per condition.
        level: Significance level.
        paired: Whether worlds are compared in pairs.
    """
    degrees = worlds - 1 if paired else 2 * worlds - 2
    shift = abs(effect) * math.sqrt(worlds if paired else worlds / 2)
    edge = t_quantile(1.0 - level / 2, degrees)
    if shift - edge > CERTAIN:  # where the noncentral t distribution cannot be evaluated
        return 1.0
    wrong_sign = float(stats.nct.cdf(-edge, degrees, shift))  # NaN if too small to represent
    return float(stats.nct.sf(edge, degrees, shift)) + (0.0 if math.isnan(wrong_sign) else wrong_sign)


def pair_test_power(effect: float, pairs: int, level: float = 0.05) -> float:
    """The power of a sign-flip permutation test of pairs with normally distributed differences.

    Args:
        effect: Mean difference, in standard deviations of pairs.
        pairs: Number of pairs.
        level: Significance level.
    """
    if pairs > SIMULATED:
        return t_test_power(effect, pairs, level, paired=True)
    if 2.0 ** (1 - pairs) > level:
        return 0.0
    noise, signs = _draws(pairs)
    values = noise + abs(effect)
    sums = np.abs(values @ signs.T)  # half of all signs, since the other half gives the same sizes
    extreme = (sums >= sums[:, :1] * (1.0 - _EQUAL)).mean(axis=1)
    return float((extreme <= level).mean())


@cache
def _draws(pairs: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Standard normal differences, (tries, pairs), and all sign patterns up to a common sign, all positive first."""
    noise = np.random.default_rng([_SEED, pairs]).normal(size=(_TRIES, pairs))
    bits = (np.arange(2 ** (pairs - 1))[:, None] >> np.arange(pairs)) & 1
    return noise, 1.0 - 2.0 * bits


Design = Literal["pairs", "independent", "alone"]
"""Pairs of equal seeds, two independent conditions, or one condition against a known number."""


def contrast_power(effect: float, worlds: int, design: Design, level: float = 0.05) -> float:
    """The power of the test that a design uses.

    Args:
        effect: Difference of the means, in standard deviations of pairs, or of worlds within a condition.
        worlds: Number of worlds per condition, two or more.
        design: How worlds are compared.
        level: Significance level.
    """
    if design == "pairs":
        return pair_test_power(effect, worlds, level)
    if design == "independent" and worlds <= SIMULATED:
        noise = np.random.default_rng([_SEED, worlds]).normal(size=(2, _TRIES, worlds))
        p = np.asarray(stats.ttest_ind(noise[0] + effect, noise[1], axis=1, equal_var=False)[1])
        return float((p <= level).mean())
    return t_test_power(effect, worlds, level, paired=design == "alone")


def worlds_needed(effect: float, design: Design, power: float = 0.8, level: float = 0.05) -> int | None:
    """The smallest number of worlds per condition that gives the required power; None if larger than `MOST`.

    Args:
        effect: Difference of the means, as for `contrast_power`.
        design: How worlds are compared.
        power: Required power, larger than the level.
        level: Significance level.
    """
    if effect == 0 or not math.isfinite(effect) or contrast_power(effect, MOST, design, level) < power:
        return None
    small_counts = range(2, SIMULATED + 1)
    sufficient = next(
        (worlds for worlds in small_counts if contrast_power(effect, worlds, design, level) >= power), None
    )
    if sufficient is not None:
        return sufficient
    start = SIMULATED + 1
    return start + bisect_left(range(start, MOST), power, key=lambda n: contrast_power(effect, n, design, level))


def effect_seen(worlds: int, design: Design, power: float = 0.8, level: float = 0.05) -> float:
    """The smallest effect, in standard deviations, that a number of worlds can find with the required power.

    Args:
        worlds: Number of worlds per condition, two or more.
        design: How worlds are compared.
        power: Required power.
        level: Significance level.

    Returns:
        The effect; infinite if so few worlds cannot find any effect.
    """
    largest = 1e3
    if contrast_power(largest, worlds, design, level) < power:
        return math.inf
    solution = optimize.root_scalar(
        lambda effect: contrast_power(effect, worlds, design, level) - power, bracket=(0.0, largest), xtol=1e-12
    )
    return float(solution.root)
