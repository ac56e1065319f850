"""How many worlds does it take to see an effect?"""

import math
from bisect import bisect_left

from scipy import optimize, stats

MOST = 10_000_000
"""Worlds beyond which none are counted."""
CERTAIN = 10.0
"""Standard errors by which an effect lies beyond the edge of a test that cannot miss it."""


def t_test_power(effect: float, worlds: float, level: float = 0.05, *, paired: bool) -> float:
    """The chance that a two-sided t test finds an effect. Source: Cohen (1988), sections 2.3 and 2.4.

    Args:
        effect: difference of the means, in standard deviations: of pairs, or within each of two conditions.
        worlds: of each condition, two or more.
        level: of the test.
        paired: whether worlds are compared in pairs.
    """
    degrees = worlds - 1 if paired else 2 * worlds - 2
    shift = abs(effect) * math.sqrt(worlds if paired else worlds / 2)
    edge = float(stats.t.ppf(1.0 - level / 2, degrees))
    if shift - edge > CERTAIN:  # where the noncentral law has no numbers
        return 1.0
    far = float(stats.nct.cdf(-edge, degrees, shift))  # by the wrong sign; NaN where too small for a number
    return float(stats.nct.sf(edge, degrees, shift)) + (0.0 if math.isnan(far) else far)


def worlds_needed(effect: float, power: float = 0.8, level: float = 0.05, *, paired: bool) -> int | None:
    """The least worlds of each condition with which an effect is found as often as asked; None if beyond `MOST`.

    Args:
        effect: as for `t_test_power`.
        power: chance to find it, above the level.
        level: of the test.
        paired: whether worlds are compared in pairs.
    """
    if effect == 0 or not math.isfinite(effect) or t_test_power(effect, MOST, level, paired=paired) < power:
        return None
    return 2 + bisect_left(range(2, MOST), power, key=lambda worlds: t_test_power(effect, worlds, level, paired=paired))


def effect_seen(worlds: int, power: float = 0.8, level: float = 0.05, *, paired: bool) -> float:
    """The least effect, in standard deviations, that some worlds of each condition find as often as asked.

    Args:
        worlds: of each condition, two or more.
        power: chance to find it.
        level: of the test.
        paired: whether worlds are compared in pairs.
    """
    found = optimize.root_scalar(
        lambda effect: t_test_power(effect, worlds, level, paired=paired) - power, bracket=(0.0, 1e3)
    )
    return float(found.root)
