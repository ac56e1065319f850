"""Verdicts of studies: how often a claim is decided whose truth lies exactly on its border."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from calibrations.calibration import Calibration
from hedon.statistic.extinction import extinct_share
from hedon.statistic.minimum import FOR_VERDICT
from hedon.study.claim import Claim, Comparison, OverWorlds
from hedon.study.estimate import compare, estimate
from hedon.study.item import Condition
from hedon.study.verdict import UNDECIDED, place
from hedon_studies.rule import OPEN, count_test, mean_test, verdict_table

LEVEL = 0.05

Floats = NDArray[np.float64]


def _decided(
    over_worlds: OverWorlds, draw_worlds: Callable[[np.random.Generator, int], Floats], border: float
) -> Callable[[np.random.Generator], bool]:
    """Whether a claim about values above a border is decided, though the truth is the border."""
    claim = Claim("c", Condition("baseline"), "", lambda _: None, over_worlds, "0", low=border, steps=0)

    def draw(rng: np.random.Generator) -> bool:
        found = estimate(claim, draw_worlds(rng, int(rng.integers(6, 21))), [])
        return (found.verdict or place(found.low, found.high, claim.low, claim.high)) != UNDECIDED

    return draw


def _ordered(comparison: Comparison, heavy: bool) -> Callable[[np.random.Generator], bool]:
    """Whether an order of two conditions is decided that do not differ."""
    border = 0.0 if comparison == "difference" else 1.0

    def draw(rng: np.random.Generator) -> bool:
        groups = [(rng.standard_cauchy if heavy else rng.normal)(size=int(n)) for n in rng.integers(6, 21, 2)]
        values, others = (np.exp(each) for each in groups) if comparison == "ratio" else groups
        _, low, high = compare(comparison, values, others)
        return place(low, high, border, math.inf) != UNDECIDED

    return draw


def _extinct(rng: np.random.Generator) -> bool:
    """Whether the share of worlds that die out by the end is said to lie on one side of its true value."""
    worlds, rate = int(rng.integers(6, 21)), float(rng.uniform(0.3, 2.0))
    ends = rng.exponential(1.0 / rate, worlds)
    seen = rng.uniform(0.5, 2.0, worlds) if rng.random() < 0.5 else np.full(worlds, 1.0)
    share = extinct_share(np.minimum(ends, np.maximum(seen, 0.01)), ends < seen, 1.0)
    return place(share.low, share.high, 1.0 - math.exp(-rate), math.inf) != UNDECIDED


def _answered(kind: str) -> Callable[[np.random.Generator], bool]:
    """Whether a study says yes or no though nothing is there."""

    def draw(rng: np.random.Generator) -> bool:
        worlds = int(rng.integers(FOR_VERDICT, 61))
        if kind == "mean":
            test = mean_test("a", rng.standard_t(3, worlds), worlds, 0, above=True)
        else:
            test = count_test("a", int(rng.binomial(worlds, 0.5)), worlds, 0, 0.5, above=True)
        return verdict_table("t", [test]).rows["answer"][0] != OPEN

    return draw


_BORDER = "6 to 20 worlds; the truth is the border of the claim; {}"
_ALIKE = "6 to 20 worlds of each of two conditions that do not differ; {}"
_RULES: tuple[tuple[OverWorlds, str, Callable[[np.random.Generator, int], Floats], float], ...] = (
    ("mean", "normal values", lambda rng, n: rng.normal(3.0, 1.0, n), 3.0),
    ("ratio", "lognormal values", lambda rng, n: np.exp(rng.normal(0.0, 0.5, n)), 1.0),
    ("share", "a fair coin", lambda rng, n: np.where(rng.random(n) < 0.5, 1.0, -1.0), 0.5),
    ("spread", "scores of neutral genes", lambda rng, n: rng.normal(size=n), 1.0),
    ("distance", "scores of neutral genes", lambda rng, n: rng.normal(size=n), 1.0),
    ("walk", "scores of neutral genes", lambda rng, n: rng.normal(size=n), 0.0),
    ("modes", "one mode, normal or uniform", lambda rng, n: (rng.normal, rng.uniform)[n % 2](size=n), 0.0),
)
_ORDERS: tuple[tuple[Comparison, bool], ...] = (
    ("difference", False),
    ("ratio", False),
    ("spread", False),
    ("spread", True),
)
CALIBRATIONS = [
    Calibration(
        "verdict on modes" if name == "modes" else f"verdict on a {name}",
        ("topic:verdict", f"verdict:{name}"),
        _BORDER.format(data),
        "false alarms",
        LEVEL,
        _decided(name, worlds, border),
    )
    for name, data, worlds, border in _RULES
]
CALIBRATIONS += [
    Calibration(
        "verdict on a share of worlds that die out",
        ("topic:verdict", "verdict:extinction"),
        _BORDER.format("lives of worlds are exponential, half of the time censored before the step"),
        "false alarms",
        LEVEL,
        _extinct,
    ),
    *(
        Calibration(
            f"verdict on a {comparison} of two conditions",
            ("topic:verdict", f"verdict:order {comparison}"),
            _ALIKE.format("Cauchy tails" if heavy else "normal values, of the logarithm for a ratio"),
            "false alarms",
            LEVEL,
            _ordered(comparison, heavy),
            tolerance=0.03 if comparison == "spread" else 0.02,
            note="If one condition has few worlds and the other has many, the verdict calls equal spreads different in "
            "up to 8 % of cases."
            if comparison == "spread"
            else "",
        )
        for comparison, heavy in _ORDERS
    ),
    *(
        Calibration(
            f"answer of a study of the classics, {kind}",
            (f"rule:{kind}",),
            f"{FOR_VERDICT} to 60 worlds in which nothing is there",
            "false alarms",
            LEVEL,
            _answered(kind),
        )
        for kind in ("mean", "count")
    ),
]
