"""The order of expectations and worlds in provenance.csv agrees with the history of the repository."""

import re
import subprocess
from datetime import datetime

import polars as pl
import pytest
from project_files import ROOT
from result_page import page, table

RUNS = table("provenance.csv").with_columns(pl.col(pl.String).fill_null("")).to_dicts()
BEFORE, AFTER, NOT_SHOWN = "before", "after", "not shown"


def git(*arguments: str) -> str | None:
    """What git prints, or None if it fails."""
    result = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, encoding="utf-8")
    return None if result.returncode else result.stdout


def has_history() -> bool:
    return (ROOT / ".git").exists() and (git("rev-parse", "--is-shallow-repository") or "").strip() == "false"


history = pytest.mark.skipif(not has_history(), reason="this checkout has no history")
each_run = pytest.mark.parametrize("run", RUNS, ids=[run["run"] for run in RUNS])


def contains(revision: str, commit: str) -> bool:
    return git("merge-base", "--is-ancestor", commit, revision) is not None


def shown_order(started: str, committed: str, includes: bool) -> str:
    """The order of a run and its expectation.

    Args:
        started: When the first world started, ISO 8601; empty if no record was kept.
        committed: When the expectation was committed.
        includes: Whether the revision that the worlds recorded contains the expectation.
    """
    if started:
        return BEFORE if datetime.fromisoformat(committed) < datetime.fromisoformat(started) else AFTER
    return BEFORE if includes else NOT_SHOWN


@history
@each_run
def test_the_expectation_is_in_its_commit(run):
    commit, file = run["expectation"], run["expectation_in"]
    shown = git("show", "-s", "--format=%cI", commit)
    assert shown is not None, f"no commit {commit}"
    assert datetime.fromisoformat(shown.strip()) == datetime.fromisoformat(run["expectation_committed"])
    assert contains("HEAD", commit)
    change = git("show", "--format=", commit, "--", file)
    assert change, f"{commit} did not change {file}"
    if file.endswith(".md"):
        added = [line[1:].lstrip("# ") for line in change.splitlines() if line.startswith("+")]
        assert any(line.startswith(run["heading"]) for line in added)


@history
@each_run
def test_the_order_is_what_the_history_shows(run):
    revision = run["revision"]
    assert not revision or contains("HEAD", revision)
    includes = bool(revision) and contains(revision, run["expectation"])
    order = shown_order(run["started"], run["expectation_committed"], includes)
    # Only the text itself shows that worlds were already running.
    assert run["order"] == order or (run["order"], order) == (AFTER, NOT_SHOWN)


@history
@each_run
def test_the_start_is_recorded_where_the_table_says(run):
    where = run["started_in"]
    assert bool(where) == bool(run["started"])
    if where:
        record = git("show", where) if ":" in where else (ROOT / where).read_text(encoding="utf-8")
        assert record is not None, f"no {where}"
        assert run["started"] in record


@pytest.mark.parametrize(
    "path",
    [
        "learner/runs.csv",
        "learner/evolution/worlds.csv",
        "learner/swap/worlds.csv",
        "learner/decoy/worlds.csv",
        "learner/behavior/runs.csv",
        "lifespan/runs.csv",
        "mating/runs.csv",
        "optimal-reward/runs.csv",
        "two-needs/runs.csv",
        "two-needs/follow-up.csv",
        "full-six/worlds.csv",
    ],
)
def test_the_start_is_that_of_the_first_world(path):
    first = table(path)["started"].min()
    assert [run["started"] for run in RUNS if run["started_in"] == f"docs/results/{path}"] == [first]


def test_the_page_lists_the_runs_whose_order_is_not_shown():
    text = page("provenance.md")
    part = text[text.index("The order is **not shown**") : text.index("Up to version 0.3")]
    listed = [name for line in part.splitlines() for name in re.findall(r"`([^`]+)`", line.split("`: ")[0] + "`")]
    assert sorted(listed) == sorted(run["run"] for run in RUNS if run["order"] == NOT_SHOWN)


@each_run
def test_the_page_has_the_revision_and_the_time_of_each_expectation(run):
    text = page("provenance.md")
    assert run["revision"][:7] in text
    committed = datetime.fromisoformat(run["expectation_committed"])
    assert re.search(rf"\b{committed.day}(st|nd|rd|th), (\d\d:\d\d(; | and ))*{committed:%H:%M}", text)


def test_an_order_needs_evidence():
    early, late = "2026-11-25T10:00:00+00:00", "2026-11-25T11:00:00+00:00"
    assert shown_order(late, early, False) == BEFORE
    assert shown_order(early, late, True) == AFTER
    assert shown_order("", early, True) == BEFORE
    assert shown_order("", early, False) == NOT_SHOWN
