"""Concurrent runs end as they would alone, even after interruptions, and a failing run does not harm the others."""

import io
import os
import signal
from pathlib import Path

import pytest
from resumed_run import SMALL, assert_same_run, small_run
from rich.console import Console

from hedon.cli.display.job import JobDisplay
from hedon.config import load_config
from hedon.ensemble.job import Job, Outcome
from hedon.ensemble.process import make_here, next_share
from hedon.ensemble.run_job import RunJob
from hedon.experiment.plan import Moment, RunPlan
from hedon.record.lock import FolderLock
from hedon.record.manifest import load_manifest

STEPS = 640


class Interrupting(JobDisplay):
    """A display that sends Ctrl-C when a run reaches a given step."""

    def __init__(self, jobs: list[RunJob], at_step: int) -> None:
        super().__init__(Console(file=io.StringIO()), jobs)
        self._at_step = at_step
        self.pressed = False

    def update(self, job: Job, moment: Moment) -> None:
        super().update(job, moment)
        if moment.step >= self._at_step and not self.pressed:
            self.pressed = True
            os.kill(os.getpid(), signal.SIGINT)


def a_job(folder: Path, *, steps: int = STEPS, growth: float = 0.2) -> RunJob:
    config = load_config("baseline", overrides=(*SMALL, f"food.normal.growth_rate={growth}"))
    return RunJob(RunPlan(config, (1, 2), steps, folder), 2 * steps)


def printed_display(jobs: list[RunJob]) -> tuple[io.StringIO, JobDisplay]:
    stream = io.StringIO()
    return stream, JobDisplay(Console(file=stream, width=200), jobs)


def test_concurrent_runs_equal_runs_made_alone(tmp_path: Path) -> None:
    jobs = [a_job(tmp_path / "a"), a_job(tmp_path / "b", growth=1.0)]
    stream, display = printed_display(jobs)
    with display:
        outcomes = make_here(jobs, 4, display)
    assert outcomes == {job.folder: Outcome("finished") for job in jobs}
    small_run(tmp_path / "alone-a", STEPS)
    small_run(tmp_path / "alone-b", STEPS, overrides=("food.normal.growth_rate=1.0",))
    for name in ("a", "b"):
        assert_same_run(tmp_path / name, tmp_path / f"alone-{name}")
        assert f"{tmp_path / name}: finished, step {STEPS}" in stream.getvalue()


def test_an_interrupted_plan_continues_to_the_same_end(tmp_path: Path) -> None:
    steps = 6400
    jobs = [a_job(tmp_path / "a", steps=steps), a_job(tmp_path / "b", steps=steps)]
    outcomes = make_here(jobs, 2, Interrupting(jobs, 1))
    assert outcomes == {tmp_path / "a": Outcome("interrupted")}, "the second run had not started and must not start"
    done = load_manifest(tmp_path / "a").steps_done[0]
    assert 0 < done < steps
    assert done % 64 == 0, "a single Ctrl-C must end a run at the end of a window"
    assert not (tmp_path / "b").exists()
    again = [a_job(tmp_path / "a", steps=steps)]
    assert make_here(again, 2, printed_display(again)[1]) == {tmp_path / "a": Outcome("finished")}
    small_run(tmp_path / "alone", steps)
    assert_same_run(tmp_path / "a", tmp_path / "alone")


def test_a_run_that_fails_leaves_the_others_alone(tmp_path: Path) -> None:
    jobs = [a_job(tmp_path / "held"), a_job(tmp_path / "free")]
    stream, display = printed_display(jobs)
    with FolderLock(tmp_path / "held"):
        outcomes = make_here(jobs, 1, display)
    assert outcomes[tmp_path / "held"].status == "failed"
    assert "in use by another run" in outcomes[tmp_path / "held"].fault
    assert outcomes[tmp_path / "free"] == Outcome("finished")
    assert "held: failed" in stream.getvalue()


@pytest.mark.parametrize(
    ("worlds", "threads", "shares"),
    [
        ((5, 5, 5, 10), 16, [5, 5, 5]),
        ((5, 5), 16, [5, 11]),
        ((5, 5), 2, [2]),
        ((2, 10, 1), 4, [2]),
        ((1, 1, 1), 2, [1, 1]),
        ((), 2, []),
    ],
)
def test_each_world_has_a_thread_and_the_last_run_gets_the_rest(
    worlds: tuple[int, ...], threads: int, shares: list[int]
) -> None:
    config = load_config("baseline")
    waiting = [RunJob(RunPlan(config, range(n), 1, Path(str(i))), n) for i, n in enumerate(worlds)]
    begun: list[int] = []
    while share := next_share(waiting, begun, threads):
        begun.append(share)
        waiting.pop(0)
    assert begun == shares


def test_an_empty_list_of_jobs_does_nothing() -> None:
    stream, display = printed_display([])
    with display:
        assert make_here([], 2, display) == {}
    assert stream.getvalue() == ""
