"""What is shown while a sweep runs."""

import io
import re

import pytest
from rich.console import Console
from sweep_case import planned, sweep_file

from hedon.cli.display.sweep import SweepDisplay
from hedon.experiment.plan import Moment
from hedon.jobs.work import Outcome
from hedon.sweep.work import make_task


@pytest.mark.parametrize("terminal", [False, True])
def test_progress_and_speed_are_shown_with_moments_and_without(tmp_path, terminal):
    """A batch of another process tells its moments; one of a cluster only its end."""
    plan, store = planned(sweep_file(tmp_path, 1000), str(tmp_path / "place"))
    told, untold = (make_task(store.location, plan, batch, tmp_path, 1.0) for batch in plan.batches())
    stream = io.StringIO()
    with SweepDisplay(Console(file=stream, width=200, force_terminal=terminal), 2, 4000) as display:
        display.update(told, Moment(first=200, step=600, steps=1000, seconds=1.0, rows=(), extinct=(), window=64))
        display.end(told, Outcome("failed", "it broke"))
        display.end(untold, Outcome("finished"))
    text = stream.getvalue()
    assert "0 of 2 batches, 30 % of their world-steps" in text, "both worlds of the first are at step 600"
    assert re.search(r"[1-9][\d,]* world-steps/s, .* left", text)
    assert "c00000-r00001 failed: it broke" in text or "c00001-r00001 failed: it broke" in text
    last = re.findall(r"2 of 2 batches, 50 % of their world-steps, (\S+) world-steps/s(.*)", text)[-1]
    assert last[0] != "0"
    assert "left" not in last[1]


def test_a_cluster_that_tells_no_moments_has_a_speed(tmp_path):
    plan, store = planned(sweep_file(tmp_path, 1_000_000), str(tmp_path / "place"))
    stream = io.StringIO()
    with SweepDisplay(Console(file=stream, width=200), 2, 4_000_000) as display:
        display.end(make_task(store.location, plan, plan.batches()[0], tmp_path, 1.0), Outcome("finished"))
    assert re.search(
        r"1 of 2 batches, 50 % of their world-steps, [1-9][\d,]+ world-steps/s, \d+ s left", stream.getvalue()
    )
