"""With a full disk, a read-only disk or a folder in use, data stays intact and a message says what to do.

Each condition is real. Mounting file systems requires root; without it, those tests are skipped.
"""

import gc
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import killed_run
import pytest
from resumed_run import assert_same_run, small_run

from hedon.experiment.resume import resume
from hedon.record.checkpoint import load_checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import MANIFEST, TABLE_FOLDERS, checkpoint_paths, part_paths
from hedon.record.manifest import load_manifest
from hedon.record.reader import open_run

STEPS = 400


def mount(*arguments):
    return subprocess.run(["mount", *map(str, arguments)], capture_output=True, text=True, check=False)


@pytest.fixture
def disk(tmp_path):
    """A small separate file system, in a folder with an awkward name."""
    folder = tmp_path / "Größe und 空間"
    folder.mkdir()
    if mount("-t", "tmpfs", "-o", "size=40m", "tmpfs", folder).returncode != 0:
        pytest.skip("cannot mount a file system here: it takes root and the right to mount")
    yield folder
    gc.collect()  # errors caught by a test may still hold arrays in a checkpoint's file
    subprocess.run(["umount", folder], check=True)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("left alone") / "run"
    small_run(folder, STEPS, frames=20)
    return folder


def cli(*arguments):
    command = [sys.executable, "-c", "from hedon.cli.main import main; main()", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def readable(folder: Path) -> None:
    """Requires that all data in the folder is intact."""
    run = open_run(folder)
    assert run.damaged_parts() == []
    run.agents()
    run.frames().collect()
    for path in checkpoint_paths(folder):
        load_checkpoint(path)


def test_a_full_disk_ends_the_run_and_free_space_lets_it_continue(disk, whole):
    folder = disk / "run"
    filler = disk / "filler"
    small_run(folder, 50, frames=20)
    free = os.statvfs(disk).f_bavail * os.statvfs(disk).f_frsize
    filler.write_bytes(bytes(free - 3_000_000))  # leaves less than a checkpoint takes
    with pytest.raises(RecordError, match=r"cannot write records to .*No space left on device.*hedon resume"):
        resume(folder, steps=STEPS, checkpoint_seconds=0)
    readable(folder)
    answer = cli("resume", folder, "--steps", STEPS)
    assert answer.returncode == 2
    assert "No space left on device" in answer.stderr
    assert "Traceback" not in answer.stderr
    readable(folder)
    filler.unlink()
    resume(folder, steps=STEPS)
    assert_same_run(folder, whole)


def test_a_completely_full_disk_is_reported_at_the_start(disk):
    free = os.statvfs(disk).f_bavail * os.statvfs(disk).f_frsize
    (disk / "filler").write_bytes(bytes(free))
    with pytest.raises(RecordError, match="No space left on device"):
        small_run(disk / "run", 50)
    (disk / "filler").unlink()
    assert small_run(disk / "run", 50).status == "finished", "the remains of the first attempt are in the way"


def test_a_read_only_disk_can_still_be_read(disk):
    folder = disk / "run"
    small_run(folder, 50)
    assert mount("-o", "remount,ro", disk).returncode == 0
    for answer in (cli("resume", folder, "--steps", 100), cli("run", "--out", disk / "new", "--steps", 10)):
        assert answer.returncode == 2
        assert "Read-only file system" in answer.stderr
        assert "cannot write the run's folder" in answer.stderr
        assert "Traceback" not in answer.stderr
    readable(folder)


def test_a_folder_in_use_names_its_process_and_is_free_after_a_kill(tmp_path):
    folder = tmp_path / "run"
    process = killed_run.start(folder)
    assert process.pid is not None
    end = time.monotonic() + 30
    while not checkpoint_paths(folder):
        assert time.monotonic() < end
    os.kill(process.pid, signal.SIGSTOP)
    words = rf"in use by another run \(process {process.pid} on {socket.gethostname()}\)"
    with pytest.raises(RecordError, match=words):
        resume(folder)
    with pytest.raises(RecordError, match=words):
        small_run(folder, 10)
    os.kill(process.pid, signal.SIGKILL)
    process.join()
    assert resume(folder).status == "finished"


def test_a_folder_left_by_a_killed_start_is_not_a_run(tmp_path):
    for name in TABLE_FOLDERS:
        (tmp_path / "run" / name).mkdir(parents=True)
    (tmp_path / "run" / "config.toml").write_text("half a con")
    assert small_run(tmp_path / "run", 50).status == "finished"


def test_a_missing_manifest_is_named_and_nothing_is_touched(tmp_path):
    folder = tmp_path / "run"
    small_run(folder, 50)
    text = (folder / MANIFEST).read_text()
    (folder / MANIFEST).unlink()
    with pytest.raises(RecordError, match=f"not a run folder: it has no {MANIFEST}"):
        resume(folder, steps=100)
    with pytest.raises(RecordError, match="already holds a run"):
        small_run(folder, 50)
    (folder / MANIFEST).write_text(text)
    assert resume(folder, steps=100).status == "finished"


def test_files_left_half_written_by_a_crash_are_removed(tmp_path):
    folder = tmp_path / "run"
    small_run(folder, 50)
    left = [folder / "checkpoints" / ".step-0000000060.npz.tmp", folder / "agents" / ".part-000009.parquet.tmp"]
    for path in left:
        path.write_bytes(b"half")
    resume(folder, steps=100)
    assert not any(path.exists() for path in left)
    assert part_paths(folder, "agents")
    assert load_manifest(folder).steps_done == (100, 100)
