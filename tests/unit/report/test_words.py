"""The first sentences of a report follow from the numbers of the topic drift."""

import math
import re
from pathlib import Path

import polars as pl
import pytest
from scipy import stats
from synthetic_run import write_run

from hedon.analysis.result import make_table
from hedon.record.reader import open_run
from hedon.report.analysis import Analysis, analyze
from hedon.report.run import write_report
from hedon.report.words import UNKNOWN, UNLEARNED, answers


@pytest.fixture(scope="module")
def analysis(tmp_path_factory: pytest.TempPathFactory) -> Analysis:
    return analyze([open_run(write_run(tmp_path_factory.mktemp("words") / "run", intervals=10, worlds=1))])


def told(analysis: Analysis, score: float, means: tuple[float, ...] = (0.5,)) -> str:
    """The sentence about the weight of food with this mean score, among five other tests."""
    condition = next(iter(analysis.conditions))
    row = {"condition": condition, "weight": "w_normal"}
    p = float(2 * stats.norm.sf(abs(score) * len(means) ** 0.5))
    outcome = {"test": "direction", "worlds": len(means), "effect": score, "p": p, "p_holm": min(6 * p, 1.0)}
    other = {"condition": condition, "weight": "another", "worlds": 1, "effect": 0.0, "p": 1.0, "p_holm": 1.0}
    others = [
        other | {"test": test} for test in ("direction", "distance", "held", "distance", "held", "recorded", "recorded")
    ]
    ends = [
        row | {"mean": mean, "null_low": -0.2, "null_high": 0.3, "generation": 8.26 + 2 * i}
        for i, mean in enumerate(means)
    ]
    tables = {
        "drift": make_table("drift", "", [row | outcome, *others]),
        "drift_world": make_table("drift_world", "", ends),
    }
    return answers(analysis.conditions, tables, analysis.runs)[condition][0]


def test_a_weight_beyond_chance_is_selected(analysis):
    assert told(analysis, 3.5) == (
        "Among the agents alive at the end (mean generation 8.3), the mean weight of normal food is +0.50, and drift "
        "would carry it to between -0.20 and +0.30: selected for (p = 0.0028, corrected for 6 tests against drift)."
    )
    assert "selected against (" in told(analysis, -3.5, (-0.5,))


def test_a_weight_that_may_have_drifted_comes_with_the_time_that_would_decide(analysis):
    said = told(analysis, 1.5)
    times = (stats.norm.isf(0.05 / 12) / 1.5) ** 2  # the run took ten seconds
    wait = f"({math.ceil(times * 10)} seconds on this machine)"
    assert f"If the trend is real, new worlds about {times:.2g} times as long {wait} would show it." in said
    assert "nothing speaks for it" in told(analysis, 0.0)
    assert "nothing speaks for it" in told(analysis, 1.2)  # not even without correction


def test_for_several_worlds_the_number_beyond_chance_is_given(analysis):
    said = told(analysis, 2.0, (0.5, 0.1, -0.4))
    assert "(mean generation 8.3 to 12), the mean weight of normal food is -0.40 to +0.50 in 3 worlds" in said
    assert "on average +0.07" in said
    assert "and 2 of them lie outside: selected for" in said
    said = told(analysis, 2.0, (0.5, -0.001, 0.2))
    assert "is +0.00 to +0.50 in 3 worlds" in said, "a zero has no minus sign"
    assert "and 1 of them lies outside: selected for" in said


def test_agents_that_do_not_learn_are_named(tmp_path: Path):
    still = write_run(tmp_path / "run", intervals=5, worlds=1)
    (still / "config.toml").write_text('preset = "baseline"\n[learning]\npolicy = "random"\n')
    said = next(iter(analyze([open_run(still)], ["drift"]).answers.values()))
    assert said[0] == UNLEARNED
    assert len(said) == 3


def test_unknown_results_are_stated_as_such(analysis):
    assert answers(analysis.conditions, {}, analysis.runs) == {name: [UNKNOWN] for name in analysis.conditions}
    assert analyze(analysis.runs, ["food"]).answers == {}


def test_the_report_begins_with_the_answer_and_its_picture(tmp_path: Path, analysis: Analysis):
    files = {file.name: file for file in write_report(*analysis.runs, folder=tmp_path)}
    said = next(iter(analysis.answers.values()))
    assert len(said) == 2
    rows = analysis.tables["drift_world"].rows
    for name, line in zip(("w_normal", "w_action"), said, strict=True):
        assert f"{rows.filter(pl.col('weight') == name)['mean'][0]:+z.2f}" in line
    page, text = (files[name].read_text(encoding="utf-8") for name in ("report.html", "report.md"))
    assert re.search(r"what evolved\?</h2>\s*<ul><li>Among the agents", page)
    order = [
        text.index(part)
        for part in ("- Among the agents alive at the end", "figures/history.svg", "figures/weights.svg", "## Tables")
    ]
    assert order == sorted(order)
