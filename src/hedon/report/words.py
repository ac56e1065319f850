"""The conclusions at the top of a report, in words: which weights were selected, and which may have drifted."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import Conditions, WorldRecord
from hedon.config.title import weight_title
from hedon.record.reader import Run
from hedon.statistic.law import normal_quantile
from hedon.text import p_phrase

LEVEL = 0.05
"""Largest p, corrected for all weights and tests, at which a weight is called selected."""
HINT = 0.2
"""Uncorrected p above which there is no sign of selection, so that the report estimates no time to a decision."""
UNLEARNED = (
    "These agents do not learn from their rewards, so selection cannot see the weights, unless a program acts by them."
)
UNKNOWN = (
    "What chance alone does to the weights is not known here: it is computed where children have one parent, founders "
    "are drawn from a law, mutations are independent, and the records are whole."
)


def answers(conditions: Conditions, tables: Mapping[str, ResultTable], runs: Sequence[Run]) -> dict[str, list[str]]:
    """One or two sentences for each weight, by condition: where it ended, what drift does, and the conclusion.

    The verdict comes from the test "direction" of the topic drift: the mean score against neutral genes along the same
    pedigrees, after Holm correction.
    """
    return {name: _answers(worlds, tables, runs) for name, worlds in conditions.items()}


def _answers(worlds: Sequence[WorldRecord], tables: Mapping[str, ResultTable], runs: Sequence[Run]) -> list[str]:
    tests, scores = (_rows(tables.get(name), worlds[0].condition) for name in ("drift", "drift_world"))
    if tests.is_empty() or scores.is_empty():
        return [UNKNOWN]
    corrected = tests.filter(pl.col("p_holm").is_not_null() & (pl.col("test") != "recorded"))  # another family of tests
    seconds = _seconds(worlds, runs)
    subject = _who(scores, worlds)
    sentences = [] if worlds[0].species_config.learning.policy == "ppo" else [UNLEARNED]
    for name in worlds[0].reward_names:
        row = corrected.filter((pl.col("weight") == name) & (pl.col("test") == "direction"))
        if not row.is_empty():
            sentence = f"{subject} {_ended(name, scores.filter(pl.col('weight') == name))}"
            sentences.append(f"{sentence}: {_verdict(row.row(0, named=True), corrected.height, seconds)}")
    return sentences or [UNKNOWN]


def _rows(table: ResultTable | None, condition: str) -> pl.DataFrame:
    if table is None or table.rows.is_empty():
        return pl.DataFrame()
    return table.rows.filter(pl.col("condition") == condition)


def _who(scores: pl.DataFrame, worlds: Sequence[WorldRecord]) -> str:
    """The agents whose weights are meant, as the start of a sentence."""
    extinct = any(world.extinct_step is not None for world in worlds)
    extinct_clause = ", or at the last record of a world that died out" if extinct else ""
    return f"Among the agents alive at the end{extinct_clause} (mean generation {_span(scores['generation'])}), the"


def _ended(name: str, scores: pl.DataFrame) -> str:
    """Where a weight ended, and how far drift would carry it."""
    title, means = weight_title(name), scores["mean"]
    title += "," if "," in title else ""
    low, high = scores["null_low"].mean(), scores["null_high"].mean()
    drift = f"drift would carry it to between {low:+z.2f} and {high:+z.2f}"
    if scores.height == 1:
        return f"mean {title} is {means[0]:+z.2f}, and {drift}"
    outside_count = scores.filter((pl.col("mean") < pl.col("null_low")) | (pl.col("mean") > pl.col("null_high"))).height
    verb = "lies" if outside_count == 1 else "lie"
    range_text = f"is {means.min():+z.2f} to {means.max():+z.2f} in {scores.height} worlds, on average"
    return f"mean {title} {range_text} {means.mean():+z.2f}; {drift}, and {outside_count} of them {verb} outside"


def _span(values: pl.Series) -> str:
    """The range of some numbers, with one decimal below ten."""
    numbers = values.to_numpy().astype(np.float64)
    low, high = (f"{value:.1f}" if value < 10 else f"{value:.0f}" for value in (numbers.min(), numbers.max()))
    return low if low == high else f"{low} to {high}"


def _verdict(test: Mapping[str, Any], tests: int, seconds: float | None) -> str:
    """The result of the test; if undecided, also how long new worlds must be to show the trend, if it is real."""
    score, chance = test["effect"], f"{p_phrase(test['p_holm'])}, corrected for {tests} tests against drift"
    if test["p_holm"] <= LEVEL:
        return f"selected {'for' if score > 0 else 'against'} ({chance})."
    if test["p"] > HINT:
        return f"selection is not shown ({chance}), and nothing speaks for it so far."
    # The effect of selection grows with time, that of drift with its square root; the same holds for sums over worlds.
    length_factor = (-normal_quantile(LEVEL / 2 / tests) / score) ** 2 / test["worlds"]
    longer_worlds = f"new worlds about {max(length_factor, 1.1):.2g} times as long"
    duration = "" if seconds is None else f" ({_minutes(max(length_factor, 1.1) * seconds)} on this machine)"
    return f"selection is not shown ({chance}). If the trend is real, {longer_worlds}{duration} would show it."


def _seconds(worlds: Sequence[WorldRecord], runs: Sequence[Run]) -> float | None:
    """Time that the steps of these worlds' runs took [s]; None if a run does not record it."""
    if any(world.config.driven for world in worlds):
        return None  # no command can continue them
    names = {world.run for world in worlds}
    durations = [run.manifest.run_seconds for run in runs if run.path.name in names]
    recorded = [time for time in durations if time]
    return sum(recorded) if recorded and len(recorded) == len(durations) else None


def _minutes(seconds: float) -> str:
    if seconds < 90:
        return f"{math.ceil(seconds):.0f} seconds"
    return f"{seconds / 60:.0f} minutes" if seconds < 7200 else f"{seconds / 3600:.1f} hours"
