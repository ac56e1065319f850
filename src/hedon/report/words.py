"""What a report answers in words, before all figures: which weights are selected, and which may have drifted."""

import math
from collections.abc import Mapping, Sequence

import polars as pl
from scipy import stats

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import Conditions, WorldRecord
from hedon.config.title import weight_title
from hedon.record.reader import Run

LEVEL = 0.05
"""Chance at or below which a weight is called selected, corrected for all weights and tests."""
HOPELESS = 100.0
"""So many times the steps, or more, are not called a way to decide it."""
UNKNOWN = (
    "What chance alone does to the weights is not known here: it is computed where children have one parent, founders "
    "are drawn from a law, mutations are independent, and the records are whole."
)


def answers(conditions: Conditions, tables: Mapping[str, ResultTable], runs: Sequence[Run]) -> dict[str, list[str]]:
    """By condition, a sentence or two for each weight: where it ended, what chance does, and what follows.

    The verdict is that of the test "direction" of the topic drift: the mean score against neutral genes along the same
    pedigrees, with Holm's correction.

    Args:
        conditions: Worlds by condition.
        tables: By name, those of the topic drift among them.
        runs: That the worlds are of.
    """
    return {name: _answers(worlds, tables, runs) for name, worlds in conditions.items()}


def _answers(worlds: Sequence[WorldRecord], tables: Mapping[str, ResultTable], runs: Sequence[Run]) -> list[str]:
    tests, scores = (_rows(tables.get(name), worlds[0].condition) for name in ("drift", "drift_world"))
    if tests.is_empty() or scores.is_empty():
        return [UNKNOWN]
    corrected = tests.filter(pl.col("p_holm").is_not_null())
    seconds = _seconds(worlds, runs)
    told = []
    for name in worlds[0].reward_names:
        row = corrected.filter((pl.col("weight") == name) & (pl.col("test") == "direction"))
        if not row.is_empty():
            ended = _ended(name, scores.filter(pl.col("weight") == name))
            told.append(f"{ended}: {_verdict(row['effect'][0], row['p_holm'][0], corrected.height, seconds)}")
    return told or [UNKNOWN]


def _rows(table: ResultTable | None, condition: str) -> pl.DataFrame:
    if table is None or table.rows.is_empty():
        return pl.DataFrame()
    return table.rows.filter(pl.col("condition") == condition)


def _ended(name: str, scores: pl.DataFrame) -> str:
    """Where a weight ended, and how far chance alone carries it."""
    title, means = weight_title(name), scores["mean"]
    low, high = scores["null_low"].mean(), scores["null_high"].mean()
    chance = f"chance alone reaches {low:+.2f} to {high:+.2f}"
    if scores.height == 1:
        return f"The {title} ended at {means[0]:+.2f}, and {chance}"
    outside = scores.filter((pl.col("mean") < pl.col("null_low")) | (pl.col("mean") > pl.col("null_high"))).height
    where = f"ended between {means.min():+.2f} and {means.max():+.2f} in {scores.height} worlds, on average at"
    return f"The {title} {where} {means.mean():+.2f}; {chance}, and {outside} of them lie outside"


def _verdict(score: float, p: float, tests: int, seconds: float | None) -> str:
    """What the test says; where it does not decide, how many times the steps would, if all goes on like this.

    Args:
        score: mean over worlds, in standard deviations of drift.
        p: corrected chance of it.
        tests: for how many p is corrected.
        seconds: that the steps took; None if it is not known.
    """
    chance = f"p = {p:.2g}, corrected for {tests} tests"
    if p <= LEVEL:
        return f"selected {'for' if score > 0 else 'against'} ({chance})."
    # What selection adds grows with time, what drift adds with its square root.
    needed = float(stats.norm.isf(LEVEL / 2 / tests))
    times = (needed / score) ** 2 if score else math.inf
    if times >= HOPELESS:
        return f"selection is not shown ({chance}), and nothing speaks for it so far."
    after = f"about {max(times, 1.1):.2g} times the steps"
    wait = "" if seconds is None else f", {_minutes((max(times, 1.1) - 1) * seconds)} more on this machine,"
    return f"selection is not shown ({chance}). If it goes on like this, {after}{wait} decide it."


def _seconds(worlds: Sequence[WorldRecord], runs: Sequence[Run]) -> float | None:
    """What the steps of the runs of these worlds took; None where a run does not say it [s]."""
    names = {world.run for world in worlds}
    times = [run.manifest.run_seconds for run in runs if run.path.name in names]
    known = [time for time in times if time]
    return sum(known) if known and len(known) == len(times) else None


def _minutes(seconds: float) -> str:
    if seconds < 90:
        return f"{math.ceil(seconds):.0f} seconds"
    return f"{seconds / 60:.0f} minutes" if seconds < 7200 else f"{seconds / 3600:.1f} hours"
