"""What does the paper claim about two conditions at once? Which of them has more, and how sure is that?

The figures of the first condition's worlds are compared with those of the second's, as a difference of means, a ratio
of geometric means or a ratio of standard deviations. The interval of the comparison decides, as for claims about one.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hedon.analysis.gene.weight import last_mean
from hedon.statistic.contrast import difference_interval, spread_ratio_interval
from hedon.statistic.interval import LEVEL
from hedon_studies.kanagawa_doya_2024.claim import SOURCE, WEIGHTS, Measure, Role, lifetime_of_dead
from hedon_studies.kanagawa_doya_2024.paper import PAPER, STEPS

MUCH = 3.0
"""Much longer (≫ in the paper) is read as at least this many times as long; the paper's own ratios are 12 and 13."""

Scale = Literal["difference", "ratio", "spread"]


@dataclass(frozen=True)
class Order:
    """One claim about two settings.

    Attributes:
        name: short, unique together with the settings.
        first, second: presets that are compared.
        text: the claim, in words.
        measure: the figure of one world; None where it has none.
        scale: of the comparison, the first against the second.
        paper: what the paper reports.
        low, high: the region of the comparison in which the claim holds.
        steps: that a world must have lived through to count [step].
        level: of the interval that decides.
        role, together, source: as for `Claim`.
    """

    name: str
    first: str
    second: str
    text: str
    measure: Measure
    scale: Scale
    paper: str
    low: float = -math.inf
    high: float = math.inf
    steps: int = STEPS
    level: float = LEVEL
    role: Role = ""
    together: bool = False
    source: str = SOURCE


def compare(
    scale: Scale, values: NDArray[np.float64], others: NDArray[np.float64], level: float = LEVEL
) -> tuple[float, float, float]:
    """The comparison of two groups with its interval; two values or more in each, above 0 for a "ratio"."""
    if scale == "spread":
        return spread_ratio_interval(values, others, level)
    if scale == "ratio":
        value, low, high = (math.exp(x) for x in difference_interval(np.log(values), np.log(others), level))
        return value, low, high
    return difference_interval(values, others, level)


def _orders() -> Iterator[Order]:
    text, action = (
        "the weight of action is lower in the large arena than in the baseline",
        partial(last_mean, "w_action"),
    )
    yield Order("action weight lower", "large", "baseline", text, action, "difference", "slightly lower", high=0.0)
    for first, second, factor in (
        ("small", "centered", 1.0),
        ("centered", "baseline", MUCH),
        ("centered", "large", MUCH),
    ):
        times = "longer" if factor == 1.0 else f"at least {factor:g} times as long"
        text = f"agents live {times} in the condition {first} than in {second}"
        ratio = (PAPER[first].mean_lifetime or math.nan) / (PAPER[second].mean_lifetime or math.nan)
        yield Order("longer lifetime", first, second, text, lifetime_of_dead, "ratio", f"{ratio:.3g} times", low=factor)
    for second in ("baseline", "large"):
        for weight, name in WEIGHTS.items():
            text = f"the weight of {name} varies less between worlds of the small arena than in {second}"
            measure = partial(last_mean, weight)
            yield Order(f"{name} weight stable", "small", second, text, measure, "spread", "most stable", high=1.0)


ORDERS: tuple[Order, ...] = tuple(_orders())
