"""Two processes cannot make the same batches of a sweep in one folder at the same time."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from sweep_case import planned, sweep_file

from hedon.ensemble.batch import WORK, batch_job
from hedon.ensemble.lock import lock
from hedon.ensemble.store import Store
from hedon.error import HedonError

START = "from hedon.cli.start import main; main()"


def command(*words: str | Path) -> list[str]:
    return [sys.executable, "-c", START, *map(str, words)]


def test_a_second_process_on_a_folder_is_refused_with_one_sentence(tmp_path):
    file, place = sweep_file(tmp_path, 200_000), tmp_path / "shared"
    first = subprocess.Popen(command("sweep", "run", file, "--out", place, "--workers", "1"), stdout=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + 120
        while not list((place / WORK).glob("*/manifest.json")):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        second = subprocess.run(command("sweep", "resume", place, "--part", "2/3"), capture_output=True, text=True)
    finally:
        first.send_signal(signal.SIGTERM)
        first.wait(120)
    assert second.returncode == 2
    assert f"(process {first.pid} on " in second.stderr
    said = " ".join(second.stderr.split())
    assert f"hedon: {place} is being made by another process" in said, said
    assert said.endswith("wait for it, stop it first, or give each its --part"), said
    with lock(Store(str(place)), (1, 1)):
        """A process that has ended no longer holds its lock."""


def test_parts_without_a_common_batch_can_run_together(tmp_path):
    store = Store(str(tmp_path / "parts"))
    with lock(store, (3, 10)):
        for other in ((4, 10), (2, 2), (4, 20)):
            with lock(store, other):
                pass
        for other in ((3, 10), (1, 1), (1, 2), (13, 20), (2, 3)):
            with pytest.raises(HedonError, match="is being made by another process"), lock(store, other):
                pass
    with lock(store, (1, 1)):
        pass


def test_a_batch_waits_for_the_process_left_behind_by_its_killed_sweep(tmp_path):
    """The process of a batch briefly outlives its sweep, and still holds the lock on its folder."""
    plan, store = planned(sweep_file(tmp_path, 640), str(tmp_path / "left"))
    batch = next(plan.batches())
    task = batch_job(store.location, plan, batch, tmp_path / "left" / WORK / batch.name, 1e9)
    holder = (
        "import sys, time; from pathlib import Path; from hedon.record.lock import FolderLock\n"
        "with FolderLock(Path(sys.argv[1])): print(flush=True); time.sleep(1.5)"
    )
    left = subprocess.Popen([sys.executable, "-c", holder, str(task.folder)], stdout=subprocess.PIPE)
    assert left.stdout is not None
    left.stdout.readline()
    assert task.make(1, None) == "finished"
    assert left.wait() == 0
