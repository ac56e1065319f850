"""Compares the tests of all parts with what expected.md expects of them, number by number.

An expectation gives the range in which the mean lies, and whether the test shows a difference from 0: whether its p is
below `CHANCE`, after Holm correction for all secondary tests of the part. Until all worlds that were fixed beforehand
have run, the answer is open; so it is if a difference was expected and is not shown.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import polars as pl

from hedon.analysis import ResultTable, make_table
from hedon_studies.rule import CHANCE, NO, OPEN, YES
from hedon_studies.same_genes_another_learner.landscape import FOOD, REPEATS, SIGHT

NONE = "no expectation"


@dataclass(frozen=True)
class Expected:
    """What is expected of one test.

    Attributes:
        low, high: Range of the mean.
        shown: Whether the test shows a difference from 0; None if either would do.
        below: Name of another test whose mean is larger.
    """

    low: float = -math.inf
    high: float = math.inf
    shown: bool | None = True
    below: str = ""

    def __str__(self) -> str:
        if self.shown is False:
            return "no difference shown"
        if math.isinf(self.low) or math.isinf(self.high):
            text = f"below {self.high:.3g}" if math.isinf(self.low) else f"above {self.low:.3g}"
        else:
            text = f"{self.low:.3g} to {self.high:.3g}"
        return f"{text}, less than {self.below!r}" if self.below else text


PRIMARY, FAST_SIGHT = "primary: baseline to fast", f"{SIGHT}, fast, against drift [sd]"
LANDSCAPE: Mapping[str, Expected] = {
    PRIMARY: Expected(*REPEATS),
    "baseline to short": Expected(low=0),
    "baseline to long": Expected(high=0),
    "baseline to normalized": Expected(low=0, below=PRIMARY),
    "slow to baseline": Expected(-0.03, 0.06, shown=None),
    "hump, baseline": Expected(high=0),
    "hump, slow": Expected(high=0),
    "hump, fast": Expected(shown=False),
    "hump, long": Expected(high=0),
}
"""Expected in part A, by test; nothing is expected of the hump in the short arm."""
EVOLUTION: Mapping[str, Expected] = {
    "primary: direction, fast less slow [degrees]": Expected(2, 12),
    f"{SIGHT}, fast less slow": Expected(0.2, 0.6),
    f"{FOOD}, fast less slow": Expected(0, 0.7, shown=None),
    f"{SIGHT}, slow, against drift [sd]": Expected(low=0, below=FAST_SIGHT),
    f"{FOOD}, slow, against drift [sd]": Expected(low=0),
    FAST_SIGHT: Expected(low=0),
    f"{FOOD}, fast, against drift [sd]": Expected(low=0),
}
"""Expected in part B, by test."""
SWAP: Mapping[str, Expected] = {
    "primary: share of the fast-evolved, fast less slow learner": Expected(0.03, 0.2),
    "share of the fast-evolved less 1/2, fast learner": Expected(low=0),
    "share of the fast-evolved less 1/2, slow learner": Expected(high=0),
}
"""Expected in part C, by test."""
DECOY: Mapping[str, Expected] = {
    "primary: loss of intake, fast less slow learner": Expected(-0.15, -0.04),
    "loss of intake, fast-evolved less slow-evolved, slow learner": Expected(0.02, 0.12),
    "loss of intake, fast-evolved less slow-evolved, fast learner": Expected(shown=False),
    "the same difference, fast less slow learner": Expected(high=0),
    "loss of intake, slow-evolved, slow learner": Expected(low=0),
    "loss of intake, slow-evolved, fast learner": Expected(-0.02, 0.04, shown=None),
    "loss of intake, fast-evolved, slow learner": Expected(low=0),
    "loss of intake, fast-evolved, fast learner": Expected(-0.02, 0.04, shown=None),
}
"""Expected in part D, by test."""
BEHAVIOR: Mapping[str, Expected] = {
    "primary: early intake, sight less food": Expected(low=0),
    "early intake, sight": Expected(low=0),
    "early intake, food": Expected(-0.0002, 0.0002, shown=None),
    "late intake, food": Expected(high=0),
    "early steering, sight": Expected(low=0),
    "early steering, food": Expected(low=0),
}
"""Expected of the mechanism, by test; nothing is expected of late intake by sight. `early_values` has the others."""


def early_values(baseline: Mapping[str, float]) -> dict[str, Expected]:
    """What is expected of the early value of seen food: slopes change by less than a fifth of the baseline's.

    Args:
        baseline: Mean slope of the baseline, by test.
    """
    bounds = {test: abs(slope) / 5 for test, slope in baseline.items()}
    return {test: Expected(-bound, bound, shown=None) for test, bound in bounds.items()}


def answer(test: Mapping[str, Any], expected: Expected | None, effects: Mapping[str, float], *, complete: bool) -> str:
    """Whether a test came out as expected.

    Args:
        test: Row of the test.
        expected: What is expected of it; None for nothing.
        effects: Means of all tests, by name.
        complete: Whether all worlds of the part have run.

    Returns:
        `YES`, `NO`, `OPEN` or `NONE`.
    """
    if expected is None:
        return NONE
    p = test["p"] if test["p_holm"] is None else test["p_holm"]
    if not complete or math.isnan(p):
        return OPEN
    shown = p < CHANCE
    if expected.shown and not shown:
        return OPEN
    within = expected.low <= test["effect"] <= min(expected.high, effects.get(expected.below, math.inf))
    return YES if within and not (shown and expected.shown is False) else NO


def answer_table(
    name: str, tests: pl.DataFrame, expected: Mapping[str, Expected], note: str = "", *, complete: bool
) -> ResultTable:
    """A table of all tests of a part, with what was expected and whether it came out.

    Args:
        name: Name of the table.
        tests: Rows from `named_tests` of the part.
        expected: What is expected, by test.
        note: Remark below the table.
        complete: Whether all worlds of the part have run.
    """
    effects = dict(tests.select("test", "effect").iter_rows())
    rows = [
        {
            "test": test["test"],
            "expected": str(expected.get(test["test"], NONE)),
            "answer": answer(test, expected.get(test["test"]), effects, complete=complete),
            **{key: test[key] for key in ("effect", "low", "high", "p", "p_sign_flip", "p_holm", "worlds")},
        }
        for test in tests.iter_rows(named=True)
    ]
    rule = (
        "Answer: whether it came out as expected; open until all worlds that were fixed beforehand have run, or if a "
        f"difference was expected and p (Holm; for the primary test, p) is {CHANCE:g} or more."
    )
    return make_table(name, "The tests fixed beforehand", rows, f"{rule} {note}".strip())
