"""Runs killed at any moment lose nothing from before a checkpoint and end with the same bits.

HEDON_KILLS sets how many times runs are killed; the default keeps the test short.
"""

import os
import random
import signal
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import killed_run
import pytest
from resumed_run import assert_same_run

from hedon.record.atomic import write_atomically
from hedon.record.folder import checkpoint_paths, holds_run
from hedon.record.reader import open_run

KILLS = int(os.environ.get("HEDON_KILLS", "10"))
DELAY = 0.6
"""Longest delay before a signal: about the time a run takes to start and do a few hundred steps [s]."""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """An undisturbed run."""
    folder = tmp_path_factory.mktemp("left alone") / "run"
    killed_run.go(folder, checkpoint_seconds=1e9)
    run = open_run(folder)
    assert run.manifest.status == "finished"
    assert run.population()["deaths"].sum() > 20
    assert run.frames().collect()["step"].n_unique() == killed_run.STEPS // 50
    return folder


def is_writing(pid: int, place: Path) -> bool:
    """Whether a process has an unnamed or temporary file open in a folder."""
    links = []
    with suppress(OSError):  # the process ended
        for name in os.listdir(f"/proc/{pid}/fd"):
            with suppress(OSError):  # the file was closed in the meantime
                links.append(os.readlink(f"/proc/{pid}/fd/{name}"))
    return any(link.startswith(f"{place}/") and link.endswith((".tmp", "(deleted)")) for link in links)


def hit(process, folder: Path, way: str, draw: random.Random) -> None:
    """Sends signals to a run at a random moment, or when it is writing."""
    time.sleep(draw.uniform(0.0, DELAY))
    if way.startswith("in "):
        place = folder / way.removeprefix("in ")
        while process.is_alive() and not is_writing(process.pid, place):
            pass
    number = {"SIGTERM": signal.SIGTERM, "Ctrl-C": signal.SIGINT, "Ctrl-C twice": signal.SIGINT}.get(
        way, signal.SIGKILL
    )
    if process.is_alive():
        os.kill(process.pid, number)
    if way == "Ctrl-C twice":
        time.sleep(draw.uniform(0.0, 0.02))
        if process.is_alive():
            os.kill(process.pid, number)
    process.join(60)
    assert not process.is_alive()


def check_between(folder: Path, before: list[int]) -> list[int]:
    """Checks what must always hold for a run; returns the steps of its checkpoints."""
    kept = [int(path.stem.removeprefix("step-")) for path in checkpoint_paths(folder)]
    assert not before or kept[-1] >= before[-1], "a checkpoint was lost"
    assert len(kept) <= 3  # while the oldest is being removed
    if holds_run(folder):
        run = open_run(folder)
        population, agents = run.population(), run.agents()
        assert not population.select("world", "step").is_duplicated().any()
        assert not agents.select("world", "agent_id").is_duplicated().any()
        assert run.damaged_parts() == []
    return kept


WAYS = ("SIGKILL", "SIGTERM", "Ctrl-C", "Ctrl-C twice", "in checkpoints", "in agents", "in population", "in frames")


@pytest.mark.repeated
def test_runs_survive_being_killed_at_any_moment(tmp_path, whole, capsys):
    draw = random.Random(7)
    ways, exits, finished, folder, kept = Counter(), Counter(), 0, tmp_path / "run0", []
    for trial in range(KILLS):
        way = WAYS[trial % len(WAYS)]
        process = killed_run.start(folder)
        hit(process, folder, way, draw)
        ways[way] += 1
        exits[process.exitcode] += 1
        assert process.exitcode != killed_run.FAULT
        kept = check_between(folder, kept)
        if holds_run(folder) and open_run(folder).manifest.status == "finished":
            assert_same_run(folder, whole)
            finished, folder, kept = finished + 1, tmp_path / f"run{trial + 1}", []
    killed_run.go(folder)
    assert_same_run(folder, whole)
    with capsys.disabled():
        told = ", ".join(f"{way} {count}" for way, count in ways.items())
        print(f"\n{KILLS} kills ({told}), {exits[-signal.SIGKILL]} at once; {finished + 1} runs came to the same end")
    assert exits[-signal.SIGKILL] >= KILLS // 4, "most kills came too late"


def test_a_file_that_is_being_written_is_detected(tmp_path):
    """Otherwise, the kills "in" a folder above would come at arbitrary moments."""
    seen = []
    write_atomically(tmp_path / "file", lambda file: seen.append(is_writing(os.getpid(), tmp_path)))
    assert seen == [True]
    assert not is_writing(os.getpid(), tmp_path)
