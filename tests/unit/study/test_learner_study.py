"""The study of same genes and another learner: its worlds, its answers, and its way from settings to a page."""

import json
import math
import re
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from command import hedon

from hedon.analysis import ResultTable
from hedon.config import digest
from hedon_studies.rule import NO, OPEN, YES
from hedon_studies.same_genes_another_learner import behavior, decoy, evolution, swap
from hedon_studies.same_genes_another_learner.answer import EVOLUTION, LANDSCAPE, NONE, Expected, answer
from hedon_studies.same_genes_another_learner.landscape import named_tests, read_arms
from hedon_studies.same_genes_another_learner.study import (
    EVOLUTION_SCALE,
    LANDSCAPE_SCALE,
    LANDSCAPES,
    LEARNERS,
    evolution_results,
    landscape_results,
)

NAME = "same-genes-another-learner"
RESULTS = Path(__file__).parents[3] / "docs" / "results"


def committed(part: str) -> ResultTable:
    """The table of the tests of a part, from the committed worlds."""
    if part == "landscape":
        results = landscape_results(read_arms(RESULTS / "learner"), complete=True)
    else:
        worlds = pl.read_csv(RESULTS / "learner" / "evolution" / evolution.WORLDS)
        results = evolution_results(worlds, complete=True)
    name = f"learner_{part}_verdict"
    return next(result for result in results if isinstance(result, ResultTable) and result.name == name)


def rows_of_page(heading: str) -> list[list[str]]:
    """The cells of the table of tests below a heading."""
    text = (RESULTS / "learner.md").read_text(encoding="utf-8").replace("*", "")
    table = text[text.index(heading) :]
    lines = table[table.index("| test") :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def answer_in(cell: str) -> str:
    """The answer in the last cell of a row, as a word."""
    return NONE if cell == "\N{EN DASH}" else re.split(r"[:,]", cell)[0]


def test_its_worlds_are_the_committed_ones() -> None:
    runs = pl.read_csv(RESULTS / "learner" / "runs.csv")
    digests = {arm: digest(condition.config("corrected")) for arm, condition in LANDSCAPES.items()}
    assert digests == dict(runs.select("arm", "config_digest").iter_rows())
    assert set(runs["steps"]) == {LANDSCAPE_SCALE.steps}
    assert set(runs["seeds"]) == {f"{LANDSCAPE_SCALE.seeds[0]}-{LANDSCAPE_SCALE.seeds[-1]}"}
    worlds = pl.read_csv(RESULTS / "learner" / "evolution" / evolution.WORLDS)
    evolving = {arm: digest(condition.config("corrected")) for arm, condition in LEARNERS.items()}
    assert evolving == dict(worlds.select("arm", "config_digest").unique().iter_rows())
    assert set(worlds["seed"]) <= set(EVOLUTION_SCALE.seeds)
    assert set(worlds["steps"]) == {EVOLUTION_SCALE.steps}


def test_each_expectation_is_of_a_test() -> None:
    assert set(LANDSCAPE) == set(named_tests(read_arms(RESULTS / "learner"))["test"]) - {"hump, short"}
    assert list(EVOLUTION) == committed("evolution").rows["test"].to_list()


def test_the_answers_from_the_committed_founders_are_those_of_the_page() -> None:
    table = committed("landscape")
    assert table.note.endswith("The landscapes repeat the pilots.")
    names = {"short horizon": "short", "long horizon": "long", "normalized advantages": "normalized"}
    answers = {}
    for name, *_, came in rows_of_page("## The tests fixed beforehand"):
        for long, short in names.items():
            name = name.replace(long, short)
        answers[name] = answer_in(came)
    assert answers == dict(table.rows.select("test", "answer").iter_rows())
    assert list(answers.values()).count(YES) == 8


def test_the_answers_from_the_committed_evolution_are_those_of_the_page() -> None:
    came = [answer_in(cells[-1]) for cells in rows_of_page("## Evolution under a slow and a fast learner")]
    assert came == committed("evolution").rows["answer"].to_list() == [YES] * 7


def committed_tests(part: str) -> pl.DataFrame:
    """The tests of a part with their answers, from its committed worlds."""
    folder = RESULTS / "learner" / part
    if part == "behavior":
        return behavior.answers(pl.read_parquet(folder / behavior.ROWS))
    return {"swap": swap.PART, "decoy": decoy.PART}[part].answers(pl.read_csv(folder / evolution.WORLDS))


def p_text(test: dict) -> str:
    p = test["p"] if test["p_holm"] is None else test["p_holm"]
    rounded = "< 0.0001" if p < 0.0001 else f"{p:.1g}" if p < 0.01 else f"{p:.2f}"
    return f"{rounded} (one test)" if test["p_holm"] is None else rounded


PAGE_PARTS = [("swap", "## The swap"), ("decoy", "## Decoys"), ("behavior", "## Why the direction changes")]


@pytest.mark.parametrize(("part", "heading"), PAGE_PARTS)
def test_the_page_has_the_tests_of_each_part(part: str, heading: str) -> None:
    expected = []
    for test in committed_tests(part).iter_rows(named=True):
        per_thousand_steps = part == "behavior" and "intake" in test["test"]
        scale, digits = (1000, 2) if per_thousand_steps else (1, 3)
        effect, low, high = (f"{scale * test[name]:.{digits}f}" for name in ("effect", "low", "high"))
        shown = f"{effect} ({low} … {high})" if effect.startswith("-") else f"+{effect} ({low} … {high})"
        expected.append((shown.replace("-", "\N{MINUS SIGN}"), p_text(test), test["answer"]))
    assert [(cells[2], cells[3], answer_in(cells[4])) for cells in rows_of_page(heading)] == expected


def test_the_page_compares_the_early_slopes_of_two_learners() -> None:
    early = pl.read_parquet(RESULTS / "learner" / "behavior" / behavior.ROWS).filter(behavior.WINDOWS["early"])
    means = early.group_by("measure", "learner").agg(pl.col(behavior.GENES.values()).mean())
    slope = {(measure, learner): genes for measure, learner, *genes in means.iter_rows()}
    ratios = {name: np.divide(slope[name, "fast"], slope[name, "baseline"]) for name in ("value", "steering")}
    page = " ".join((RESULTS / "learner.md").read_text(encoding="utf-8").split())
    sight, food = 100 * abs(ratios["value"] - 1)
    assert f"the slopes of value differ by {sight:.0f} and {food:.0f} % from the baseline's" in page
    sight, food = ratios["steering"]
    assert f"{sight:.1f} (sight) and {food:.1f} (food) times as large as the baseline's" in page
    sight, food = slope["steering", "baseline"]
    assert sight / food == pytest.approx(3, abs=0.2)
    assert "the baseline's slope on sight is three times its slope on food" in page


def test_the_page_counts_the_contests_that_each_kind_of_reward_wins() -> None:
    page = " ".join((RESULTS / "learner.md").read_text(encoding="utf-8").split())
    worlds = pl.read_csv(RESULTS / "learner" / "swap" / evolution.WORLDS).sort("pair")
    fast, slow = (worlds.filter(treatment=name)["share"] for name in ("fast", "slow"))
    assert f"it is above 0 in {(fast > slow).sum()} of {len(fast)} pairs" in page
    wins, losses = (fast > 0.5).sum(), (slow > 0.5).sum()
    assert (
        f"the majority in {wins} of {len(fast)} contests with the fast learner, and in {losses} with the slow" in page
    )


def test_the_paper_has_the_effects_of_each_part() -> None:
    paper = " ".join((RESULTS.parent / "paper" / "paper.md").read_text(encoding="utf-8").split())
    direction, *_ = committed("evolution").rows.iter_rows(named=True)
    assert f"points {direction['effect']:.1f}° ({direction['low']:.1f} … {direction['high']:.1f}) further" in paper
    share, fast, slow = committed_tests("swap").iter_rows(named=True)
    assert f"is {share['effect']:.3f} ({share['low']:.3f} … {share['high']:.3f}, 60 pairs)" in paper
    for test in (fast, slow):
        assert " ".join(f"{0.5 + test[key]:.3f}" for key in ("effect", "low", "high")) in re.sub(r"[(…] ?", "", paper)
    losses = {test["test"]: test["effect"] for test in committed_tests("decoy").iter_rows(named=True)}
    own, others = (100 * losses[f"loss of intake, {genes}-evolved, slow learner"] for genes in ("slow", "fast"))
    assert f"{own:.0f} % of its intake with its own rewards and {others:.0f} % with the fast learner's" in paper
    tests = {test["test"]: test for test in committed_tests("behavior").iter_rows(named=True)}
    for name in ("early intake, sight", "early intake, food", "late intake, food"):
        size, *bounds = (1000 * abs(tests[name][key]) for key in ("effect", "low", "high"))
        assert f"{size:.2f} ({min(bounds):.2f} … {max(bounds):.2f})" in paper


def row(effect: float, p: float, p_holm: float | None = None) -> dict:
    return {"test": "a", "effect": effect, "p": p, "p_holm": p_holm, "worlds": 30}


@pytest.mark.parametrize(
    ("expected", "test", "wanted"),
    [
        (None, row(1.0, 0.001), NONE),
        (Expected(low=0), row(1.0, 0.001), YES),
        (Expected(low=0), row(-1.0, 0.001), NO),
        (Expected(low=0), row(1.0, 0.001, 0.2), OPEN),
        (Expected(low=0), row(1.0, 0.2), OPEN),
        (Expected(high=0), row(-1.0, 0.001, 0.01), YES),
        (Expected(0.05, 0.16), row(0.2, 0.001), NO),
        (Expected(-1, 1, shown=None), row(0.5, 0.9), YES),
        (Expected(-1, 1, shown=None), row(2.0, 0.9), NO),
        (Expected(shown=False), row(0.5, 0.9), YES),
        (Expected(shown=False), row(0.5, 0.9, 0.01), NO),
        (Expected(low=0, below="b"), row(1.0, 0.001), YES),
        (Expected(low=0, below="b"), row(3.0, 0.001), NO),
        (Expected(low=0), row(1.0, math.nan), OPEN),
    ],
)
def test_an_answer_follows_from_the_expectation(expected: Expected | None, test: dict, wanted: str) -> None:
    assert answer(test, expected, {"a": test["effect"], "b": 2.0}, complete=True) == wanted
    assert answer(test, expected, {"a": test["effect"], "b": 2.0}, complete=False) == (
        wanted if expected is None else OPEN
    )


def run(folder: Path, *words: str) -> dict[str, list[dict]]:
    """Runs the study and checks its page, and returns its tables."""
    made = hedon("study", "run", *words, cwd=folder)
    assert made.returncode == 0, made.stderr
    page = json.loads((folder / "studies" / NAME / "study.json").read_text(encoding="utf-8"))
    tables = {key: table["rows"] for key, table in page["tables"].items()}
    answers = {entry["answer"] for name, table in tables.items() if name.endswith("_verdict") for entry in table}
    assert answers <= {OPEN, NONE}
    for item in page["items"]:
        assert (folder / "studies" / NAME / "figures" / f"{item['name']}.svg").stat().st_size > 10_000
    return tables


@pytest.mark.more
def test_it_goes_from_settings_to_a_page(tmp_path: Path) -> None:
    tables = run(tmp_path, NAME, "--seeds", "1-2", "--steps", "128")
    assert len(tables["learner_landscape_verdict"]) == 10
    assert {entry["worlds"] for entry in tables["learner_landscape_verdict"][:5]} == {2}
    assert len(tables["learner_landscape_world"]) == 12
    assert len(tables["learner_evolution_world"]) == 4
    shown = hedon("study", "report", "learner-landscape", "--seeds", "3", "--steps", "128", cwd=tmp_path)
    assert shown.returncode == 0, shown.stderr
    listed = hedon("study", "list", cwd=tmp_path)
    assert NAME in listed.stdout
    assert listed.stderr == ""


@pytest.mark.long
def test_a_quick_trial_of_it_makes_one_short_world_of_each_learner(tmp_path: Path) -> None:
    tables = run(tmp_path, NAME, "--quick")
    assert len(tables["world"]) == 8
