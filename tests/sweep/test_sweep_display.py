"""What is shown while a sweep runs."""

import io
import re

import pytest
from rich.console import Console
from sweep_case import planned, sweep_file

from hedon.cli.display.job import JobDisplay
from hedon.ensemble.batch import batch_job
from hedon.ensemble.condition import describe
from hedon.ensemble.job import Outcome
from hedon.experiment.plan import Moment


@pytest.mark.parametrize("terminal", [False, True])
def test_progress_and_speed_are_shown_with_moments_and_without(tmp_path, terminal):
    """A batch in another process reports its progress; one on a cluster only its end."""
    plan, store = planned(sweep_file(tmp_path, 1000), str(tmp_path / "place"))
    jobs = [batch_job(store.location, plan, batch, tmp_path / batch.name, 1.0) for batch in plan.batches()]
    told, untold = jobs
    moment = Moment(200, 600, 1000, 1.0, ({"alive": 7}, {"alive": 5}), (None, None), 64)
    stream = io.StringIO()
    with JobDisplay(Console(file=stream, width=200, force_terminal=terminal), jobs) as display:
        display.update(told, moment)
        display.end(told, Outcome("failed", "it broke"))
        display.end(untold, Outcome("finished"))
    text = stream.getvalue()
    lines = "".join(text.split())  # a long folder name wraps to the next line
    assert "30.0 %, 0 of 2 runs done" in text, "both worlds of the first are at step 600"
    assert re.search(r"[1-9][\d,]* world-steps/s, .* left", text)
    assert "basic_cost=0.001,seeds1-2:failed,step600,itbroke" in lines
    assert "basic_cost=0.01,seeds1-2:finished" in lines


def test_a_world_has_died_out_if_no_species_is_left(tmp_path):
    plan, store = planned(sweep_file(tmp_path, 1000), str(tmp_path / "place"))
    job = batch_job(store.location, plan, next(plan.batches()), tmp_path / "batch", 1.0)
    rows = tuple({"alive": alive} for alive in (0, 5, 0, 0))  # two worlds of two species
    stream = io.StringIO()
    with JobDisplay(Console(file=stream, width=200), [job]) as display:
        display.update(job, Moment(500, 1000, 1000, 1.0, rows, (700, None, None, 900), 64))
        display.end(job, Outcome("finished"))
    assert job.seeds == (1, 2)
    assert "step 1,000, seed 2 died out\n" in stream.getvalue()
    assert "seed 1 died out" not in stream.getvalue()
    assert "died out / 5 / died out / died out alive" in stream.getvalue()


def test_the_start_of_the_workers_does_not_count_toward_the_time_left(tmp_path, monkeypatch):
    now = [100.0]
    monkeypatch.setattr("hedon.cli.display.job.time.monotonic", lambda: now[0])
    plan, store = planned(sweep_file(tmp_path, 1000), str(tmp_path / "place"))
    jobs = [batch_job(store.location, plan, batch, tmp_path / batch.name, 1.0) for batch in plan.batches()]
    stream = io.StringIO()
    with JobDisplay(Console(file=stream, width=200), jobs) as display:
        now[0] += 50  # the workers start
        display.update(jobs[0], Moment(0, 500, 1000, 2.0, ({"alive": 7}, {"alive": 5}), (None, None), 64))
    assert "25.0 %, 0 of 2 runs done, 500 world-steps/s, 6 s left" in stream.getvalue()


def test_many_batches_without_progress_have_a_speed_and_are_not_listed_one_by_one(tmp_path):
    costs = f'[factor]\n"energy.basic_cost" = {[i / 1e4 for i in range(1, 31)]}\n'
    plan, store = planned(sweep_file(tmp_path, 1000, seeds=1, rest=costs), str(tmp_path / "place"))
    jobs = [batch_job(store.location, plan, batch, tmp_path / batch.name, 1.0) for batch in plan.batches()]
    stream = io.StringIO()
    with JobDisplay(Console(file=stream, width=200), jobs) as display:
        for job in jobs[:-1]:
            display.end(job, Outcome("finished"))
        display.end(jobs[-1], Outcome("failed", "it broke"))
    lines = stream.getvalue().splitlines()
    assert re.fullmatch(r"3.3 %, 1 of 30 runs done, [1-9][\d,]+ world-steps/s, .* left", lines[0])
    assert re.fullmatch(r"96.7 %, 30 of 30 runs done, [1-9][\d,]+ world-steps/s", lines[1])
    assert lines[2:] == [f"{jobs[-1].label}: failed, it broke"]


def test_batches_are_described_by_their_settings_in_the_shortest_distinct_names():
    assert describe({"energy.basic_cost": 0.002, "preset": "poor"}, (4,)) == 'basic_cost=0.002, preset="poor", seed 4'
    same = {"food.normal.growth_rate": 0.5, "food.poison.growth_rate": 2}
    assert describe(same, (1, 2, 3, 9)) == "normal.growth_rate=0.5, poison.growth_rate=2, seeds 1-3,9"
    assert describe({}, (1,)) == "seed 1"
