"""How many worlds does it take to see an effect, by the test that decides?

Pairs are decided by exchanging their signs. Such a test has few values of p if there are few pairs: with five, the
least is 2/2⁵, so that no effect is ever found at 0.05. Independent worlds are decided by Welch's t, which has fewer
degrees of freedom than Student's. The power of both is simulated up to `SIMULATED` worlds; from there on, it is that of
Student's t test within a point.
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
"""Worlds beyond which none are counted."""
SIMULATED = 12
"""Worlds of each condition up to which the power is simulated."""
_TRIES = 4000
"""Simulated data sets; the error of a power is below 0.008."""
_SEED = 20261127
_EQUAL = 1e-9
"""Relative difference below which two sums are the same number, computed in two ways."""
CERTAIN = 10.0
"""Standard errors by which an effect lies beyond the edge of a test that cannot miss it."""


def t_test_power(effect: float, worlds: float, level: float = 0.05, *, paired: bool) -> float:
    """The chance that a two-sided t test finds an effect. Source: Cohen (1988), sections 2.3 and 2.4."""
    degrees = worlds - 1 if paired else 2 * worlds - 2
    shift = abs(effect) * math.sqrt(worlds if paired else worlds / 2)
    edge = t_quantile(1.0 - level / 2, degrees)
    if shift - edge > CERTAIN:  # where the noncentral law has no numbers
        return 1.0
    far = float(stats.nct.cdf(-edge, degrees, shift))  # by the wrong sign; NaN where too small for a number
    return float(stats.nct.sf(edge, degrees, shift)) + (0.0 if math.isnan(far) else far)


def pair_test_power(effect: float, pairs: int, level: float = 0.05) -> float:
    """The chance that exchanging the signs of pairs finds an effect, if differences are normally distributed."""
    if pairs > SIMULATED:
        return t_test_power(effect, pairs, level, paired=True)
    if 2.0 ** (1 - pairs) > level:
        return 0.0
    noise, signs = _draws(pairs)
    values = noise + abs(effect)
    sums = np.abs(values @ signs.T)  # half of all signs: the others have the same size
    extreme = (sums >= sums[:, :1] * (1.0 - _EQUAL)).mean(axis=1)
    return float((extreme <= level).mean())


@cache
def _draws(pairs: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Standard normal differences, (tries, pairs), and all signs of pairs but for a common one, the plain sum first."""
    noise = np.random.default_rng([_SEED, pairs]).normal(size=(_TRIES, pairs))
    bits = (np.arange(2 ** (pairs - 1))[:, None] >> np.arange(pairs)) & 1
    return noise, 1.0 - 2.0 * bits


Design = Literal["pairs", "independent", "alone"]
"""Pairs of equal seeds, two independent conditions, or one condition against a known number."""


def contrast_power(effect: float, worlds: int, design: Design, level: float = 0.05) -> float:
    """The chance that an effect is found by the test that decides its design.

    Args:
        effect: difference of the means, in standard deviations: of pairs, or of worlds within a condition.
        worlds: of each condition, two or more.
        design: how worlds are compared.
        level: of the test.
    """
    if design == "pairs":
        return pair_test_power(effect, worlds, level)
    if design == "independent" and worlds <= SIMULATED:
        noise = np.random.default_rng([_SEED, worlds]).normal(size=(2, _TRIES, worlds))
        p = np.asarray(stats.ttest_ind(noise[0] + effect, noise[1], axis=1, equal_var=False)[1])
        return float((p <= level).mean())
    return t_test_power(effect, worlds, level, paired=design == "alone")


def worlds_needed(effect: float, design: Design, power: float = 0.8, level: float = 0.05) -> int | None:
    """The least worlds of each condition with which an effect is found as often as asked; None if beyond `MOST`.

    Args:
        effect: as for `contrast_power`.
        design: how worlds are compared.
        power: chance to find it, above the level.
        level: of the test.
    """
    if effect == 0 or not math.isfinite(effect) or contrast_power(effect, MOST, design, level) < power:
        return None
    few = range(2, SIMULATED + 1)
    enough = next((worlds for worlds in few if contrast_power(effect, worlds, design, level) >= power), None)
    if enough is not None:
        return enough
    least = SIMULATED + 1
    return least + bisect_left(range(least, MOST), power, key=lambda n: contrast_power(effect, n, design, level))


def effect_seen(worlds: int, design: Design, power: float = 0.8, level: float = 0.05) -> float:
    """The least effect, in standard deviations, that some worlds of each condition find as often as asked.

    Args:
        worlds: of each condition, two or more.
        design: how worlds are compared.
        power: chance to find it.
        level: of the test.

    Returns:
        The effect; infinite if so few worlds find none, however large.
    """
    most = 1e3
    if contrast_power(most, worlds, design, level) < power:
        return math.inf
    found = optimize.root_scalar(
        lambda effect: contrast_power(effect, worlds, design, level) - power, bracket=(0.0, most), xtol=1e-12
    )
    return float(found.root)
