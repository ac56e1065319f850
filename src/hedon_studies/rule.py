"""How studies of the classics answer: an effect with its interval first, then yes, no or open by one rule.

A test has one number per world, or per pair of worlds, and a side on which the claim holds. Fewer than `FOR_VERDICT`
numbers leave it open. Otherwise it is yes if the effect lies on that side, no if on the other, with p below `CHANCE`
after Holm's correction for all named tests of the study; else it is open.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import ArrayLike

from hedon.analysis import ResultTable, make_table
from hedon.statistic import FOR_VERDICT, LEVEL, holm, mean_interval, share_interval

stats: Any = load("scipy.stats", suppress_warning=True)

CHANCE = 0.05
"""Chance, after correction, from which on an answer stays open."""
YES, NO, OPEN = "yes", "no", "open"


@dataclass(frozen=True)
class Test:
    """What the worlds tell of one claim.

    Attributes:
        name: of the claim.
        worlds: that it is made of.
        values: how many of these have a value.
        extinct: how many of these died out; they count.
        above: whether the claim holds above 0, rather than below.
        effect: measured; NaN where it cannot be, as what follows.
        low, high: bounds of its 95 % interval.
        p: two-sided chance of so large an effect if there is none.
    """

    name: str
    worlds: int
    values: int
    extinct: int
    above: bool
    effect: float = np.nan
    low: float = np.nan
    high: float = np.nan
    p: float = np.nan

    @property
    def said(self) -> str:
        """The effect with its interval, in words."""
        if np.isnan(self.effect):
            return f"not known from {self.worlds} {'world' if self.worlds == 1 else 'worlds'}"
        bounds = "" if np.isnan(self.low) else f" ({self.low:.3g} to {self.high:.3g})"
        return f"{self.effect:.3g}{bounds}"


def slope_test(name: str, x: ArrayLike, y: ArrayLike, extinct: int, *, above: bool) -> Test:
    """The slope of y over x by least squares, with Student's interval.

    Args:
        name: of the claim.
        x: one number per world, (worlds,).
        y: one number per world, (worlds,).
        extinct: how many of the worlds died out.
        above: whether the claim holds above 0.
    """
    across, values = np.asarray(x, np.float64), np.asarray(y, np.float64)
    if len(across) < 3 or np.ptp(across) == 0:
        return Test(name, len(across), len(across), extinct, above)
    slope, _, _, p, error = np.asarray(stats.linregress(across, values)).tolist()
    reach = float(stats.t.ppf((1 + LEVEL) / 2, len(across) - 2)) * error
    return Test(name, len(across), len(across), extinct, above, slope, slope - reach, slope + reach, p)


def mean_test(name: str, values: ArrayLike, worlds: int, extinct: int, *, above: bool) -> Test:
    """The mean of some values, with Student's interval.

    Args:
        name: of the claim.
        values: one per world, or per pair of worlds, (values,).
        worlds: how many worlds or pairs these are.
        extinct: how many of the worlds died out.
        above: whether the claim holds above 0.
    """
    known = np.asarray(values, np.float64)
    if len(known) < 2:
        return Test(name, worlds, len(known), extinct, above)
    found = mean_interval(known.tolist())
    mean, low, high = (np.nan if bound is None else bound for bound in (found.mean, found.low, found.high))
    p = float(np.asarray(stats.ttest_1samp(known, 0.0))[1])
    return Test(name, worlds, len(known), extinct, above, mean, low, high, p)


def count_test(name: str, count: int, worlds: int, extinct: int, chance: float, *, above: bool) -> Test:
    """The share of worlds that have something, less the share that chance gives, with its interval."""
    if not worlds:
        return Test(name, worlds, 0, extinct, above)
    low, high = share_interval(count, worlds)
    p = float(stats.binomtest(count, worlds, chance).pvalue)
    return Test(name, worlds, worlds, extinct, above, count / worlds - chance, low - chance, high - chance, p)


def verdict_table(name: str, tests: Sequence[Test], note: str = "", named: int = 0) -> ResultTable:
    """The answers to all named tests of a study, which are corrected for each other."""
    others = [1.0] * (named - len(tests))
    corrected = holm([*(1.0 if np.isnan(test.p) else test.p for test in tests), *others])[: len(tests)]
    rows: list[Mapping[str, Any]] = [
        {
            "claim": test.name,
            "answer": _answer(test, p),
            "effect": test.effect,
            "low": test.low,
            "high": test.high,
            "holds": "above 0" if test.above else "below 0",
            "p": test.p,
            "p (Holm)": p,
            "worlds": test.worlds,
            "with a value": test.values,
            "died out": test.extinct,
        }
        for test, p in zip(tests, corrected, strict=True)
    ]
    finite = [{k: None if isinstance(v, float) and np.isnan(v) else v for k, v in row.items()} for row in rows]
    rule = f"An answer is open with fewer than {FOR_VERDICT} values, or with p (Holm) of {CHANCE:g} or more."
    return make_table(name, "What the worlds say of the claims", finite, f"{rule} {note}".strip())


def _answer(test: Test, p: float) -> str:
    if test.values < FOR_VERDICT or not p < CHANCE:
        return OPEN
    return YES if (test.effect > 0) == test.above else NO
