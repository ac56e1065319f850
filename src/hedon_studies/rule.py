"""The rule by which studies of classic claims answer: an effect with its interval, then yes, no or open.

A test has one number per world, or per pair of worlds, and a side on which the claim holds. With fewer than
`FOR_VERDICT` numbers the answer is open. Otherwise, if p is below `CHANCE` after Holm correction for all named tests of
the study, the answer is yes if the effect is on that side, and no if it is on the other. If p is not, it is open.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import ArrayLike

from hedon.analysis import ResultTable, make_table
from hedon.statistic import FOR_VERDICT, holm, mean_interval, share_interval

stats: Any = load("scipy.stats", suppress_warning=True)

CHANCE = 0.05
"""Corrected p at and above which an answer is open."""
YES, NO, OPEN = "yes", "no", "open"


@dataclass(frozen=True)
class Test:
    """The test of one claim. Numbers that cannot be computed are NaN.

    Attributes:
        name: Name of the claim.
        worlds: Number of worlds, or of pairs of worlds.
        values: Number of these with a value.
        extinct: Number of worlds that died out. They are included, if they have a value.
        above: Whether the claim holds above 0 instead of below.
        effect: The measured effect.
        low, high: Bounds of its 95 % interval.
        p: Two-sided p value of the effect.
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


def mean_test(name: str, values: ArrayLike, worlds: int, extinct: int, *, above: bool) -> Test:
    """Tests the mean of some values, with Student's interval.

    Args:
        name: Name of the claim.
        values: Value of each world, or pair of worlds, shape (values,).
        worlds: Number of worlds or pairs.
        extinct: Number of worlds that died out.
        above: Whether the claim holds above 0.
    """
    sample = np.asarray(values, np.float64)
    if len(sample) < 2:
        return Test(name, worlds, len(sample), extinct, above)
    interval = mean_interval(sample.tolist())
    mean, low, high = (np.nan if bound is None else bound for bound in (interval.mean, interval.low, interval.high))
    p = float(np.asarray(stats.ttest_1samp(sample, 0.0))[1])
    return Test(name, worlds, len(sample), extinct, above, mean, low, high, p)


def by_seed(rows: Sequence[Mapping[str, Any]], condition: str, key: str) -> dict[int, float]:
    """A measure of the worlds of one condition, with the seeds as keys; worlds in which it is not known are left out.

    Args:
        rows: Rows of worlds, each with "condition", "seed" and the measure.
        condition: Name of the condition.
        key: Name of the measure.
    """
    return {row["seed"]: row[key] for row in rows if row["condition"] == condition and row[key] is not None}


def pair_differences(rows: Sequence[Mapping[str, Any]], pair: tuple[str, str], key: str) -> list[float]:
    """By how much a measure is larger in one condition than in another, for each pair of worlds of equal seeds.

    Args:
        rows: As in `by_seed`.
        pair: The two conditions.
        key: Name of the measure.
    """
    first, second = (by_seed(rows, condition, key) for condition in pair)
    return [first[seed] - second[seed] for seed in sorted(first.keys() & second.keys())]


def pair_test(name: str, rows: Sequence[Mapping[str, Any]], pair: tuple[str, str], key: str) -> Test:
    """Tests whether a measure is larger in one condition than in another, in pairs of worlds of equal seeds.

    Args:
        name: Name of the claim.
        rows: As in `by_seed`, with "died out" as well.
        pair: The two conditions.
        key: Name of the measure.
    """
    first, second = ({row["seed"]: row for row in rows if row["condition"] == condition} for condition in pair)
    pairs = first.keys() & second.keys()
    extinct = sum(found[seed]["died out"] for found in (first, second) for seed in pairs)
    return mean_test(name, pair_differences(rows, pair, key), len(pairs), extinct, above=True)


def count_test(name: str, count: int, worlds: int, extinct: int, chance: float, *, above: bool) -> Test:
    """Tests the share of worlds with a property, minus the share expected by chance.

    Args:
        name: Name of the claim.
        count: Number of worlds with the property.
        worlds: Number of all worlds.
        extinct: Number of worlds that died out.
        chance: Share expected by chance.
        above: Whether the claim holds above that share.
    """
    if not worlds:
        return Test(name, worlds, 0, extinct, above)
    low, high = share_interval(count, worlds)
    p = float(stats.binomtest(count, worlds, chance).pvalue)
    return Test(name, worlds, worlds, extinct, above, count / worlds - chance, low - chance, high - chance, p)


def verdict_table(name: str, tests: Sequence[Test], note: str = "", named: int = 0) -> ResultTable:
    """A table of the answers of all named tests of a study, corrected for one another.

    Args:
        name: Name of the table.
        tests: The tests.
        note: Remark below the table.
        named: Number of tests that the study names, if more than these.
    """
    untested = [1.0] * (named - len(tests))
    corrected = holm([*(1.0 if np.isnan(test.p) else test.p for test in tests), *untested])[: len(tests)]
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
    rule = f"An answer is open with fewer than {FOR_VERDICT} values, or with p (Holm) of {CHANCE:g} or more."
    return make_table(name, "What the worlds say of the claims", rows, f"{rule} {note}".strip())


def _answer(test: Test, p: float) -> str:
    if test.values < FOR_VERDICT or not p < CHANCE:
        return OPEN
    return YES if (test.effect > 0) == test.above else NO
