"""A report on an unfinished run begins with the steps that its numbers cover."""

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest
from synthetic_run import INTERVAL, write_run
from typer.testing import CliRunner

from hedon.analysis.world.record import WorldRecord
from hedon.cli.main import app
from hedon.record.reader import open_run
from hedon.report.analysis import analyze
from hedon.report.run import narrow_intervals


def test_a_report_on_a_killed_run_says_that_its_tables_end_at_two_steps(tmp_path: Path) -> None:
    killed = write_run(tmp_path / "killed", intervals=8, worlds=2, snapshot=False, status="running", unsaved=3)
    done = CliRunner().invoke(app, ["report", str(killed), "--figures", "none"])
    assert done.exit_code == 0, done.output
    sentence = (
        "The run killed has not finished (status running): births, deaths, foods eaten and agents alive are those up "
        f"to step {8 * INTERVAL:,}; lifetimes, weights and whatever else is of single agents, those up to step "
        f"{5 * INTERVAL:,}."
    )
    pages = [(killed / name).read_text(encoding="utf-8") for name in ("report.html", "report.md")]
    for text in (done.output, *pages):
        assert sentence in text
    for text in pages:
        assert text.index(sentence) < text.index("what evolved?"), "it comes first"
    again = CliRunner().invoke(app, ["analyze", str(killed), "--only", "lifetime"])
    assert sentence in again.output


@pytest.mark.parametrize("status", ["running", "interrupted", "failed"])
def test_a_report_on_a_run_whose_tables_end_together_names_one_step(tmp_path: Path, status: str) -> None:
    run = open_run(write_run(tmp_path / "a", intervals=3, worlds=2, snapshot=False, extinct=1, status=status))
    assert analyze([run], ["food"]).unfinished == [
        f"The run a has not finished (status {status}): this is of what its records hold up to step {3 * INTERVAL:,}."
    ]


def test_a_finished_run_needs_no_such_sentence(tmp_path: Path) -> None:
    assert not analyze([open_run(write_run(tmp_path / "a", intervals=3, snapshot=False))], ["food"]).unfinished


def test_intervals_that_are_too_narrow_are_reported() -> None:
    """If some worlds died out, and there are enough worlds for an interval."""

    def told(ends: list[int | None]) -> list[str]:
        worlds = [cast(WorldRecord, SimpleNamespace(extinct_step=end)) for end in ends]
        return narrow_intervals({"poor": worlds})

    assert told([None, 100, None, None, 50]) == [
        "2 of 5 worlds of poor died out, so intervals of its numbers alive are too narrow: with one world in five at 0 "
        "they miss the mean in 24 % of cases with five worlds, in 11 % with ten."
    ]
    assert told([None, 100, None, None]) == []
    assert told([None] * 5) == told([100] * 5) == []
