"""The paper's claims about the order of two conditions.

The figures of the worlds of both conditions are compared by a difference of means, a ratio of geometric means or a
ratio of standard deviations. The interval of the comparison decides, as for claims about one condition.
"""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

from hedon.analysis import last_mean
from hedon.measure import MEASURES
from hedon.study import Condition, Order
from hedon_studies.kanagawa_doya_2024.claim import SOURCE, WEIGHTS
from hedon_studies.kanagawa_doya_2024.paper import PAPER, STEPS

MUCH = 3.0
"""Ratio from which we read "much longer" (≫ in the paper) as true; the paper's own ratios are 12 and 13."""


def _order(name: str, first: str, second: str, *rest: Any, **region: float) -> Order:
    pair = Condition(first, first), Condition(second, second)
    return Order(name, *pair, *rest, **region, steps=STEPS, source=SOURCE)


def _orders() -> Iterator[Order]:
    text, action = (
        "the weight of action is lower in the large arena than in the baseline",
        partial(last_mean, "w_action"),
    )
    yield _order("action weight lower", "large", "baseline", text, action, "difference", "slightly lower", high=0.0)
    for first, second, factor in (
        ("small", "centered", 1.0),
        ("centered", "baseline", MUCH),
        ("centered", "large", MUCH),
    ):
        comparison = "longer" if factor == 1.0 else f"at least {factor:g} times as long"
        text = f"agents live {comparison} in the condition {first} than in {second}"
        ratio = (PAPER[first].mean_lifetime or math.nan) / (PAPER[second].mean_lifetime or math.nan)
        lifetime, reported = MEASURES["mean_lifetime"].of, f"{ratio:.3g} times"
        yield _order("longer lifetime", first, second, text, lifetime, "ratio", reported, low=factor)
    for second in ("baseline", "large"):
        for weight, name in WEIGHTS.items():
            text = f"the weight of {name} varies less between worlds of the small arena than in {second}"
            measure = partial(last_mean, weight)
            yield _order(f"{name} weight stable", "small", second, text, measure, "spread", "most stable", high=1.0)


ORDERS: tuple[Order, ...] = tuple(_orders())
