"""Moments and observations in files under HEDON_SCRATCH: no result changes, and each error is one sentence."""

import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from resumed_run import WINDOW, assert_same_run, small_run
from worlds import make_simulation

from hedon.error import EngineError
from hedon.experiment import memory
from hedon.experiment.memory import COLD, MemoryNeedError, memory_needed, require_memory
from hedon.experiment.resume import resume
from hedon.experiment.simulation import SCRATCH_VARIABLE


def kept_files(folder: Path) -> list[str]:
    """The unnamed files in this folder that this process holds open."""
    found = []
    for number in os.listdir("/proc/self/fd"):
        with suppress(FileNotFoundError):  # the descriptor of the listing itself
            found.append(os.readlink(f"/proc/self/fd/{number}"))
    return [name for name in found if name.startswith(str(folder)) and name.endswith("(deleted)")]


@pytest.mark.parametrize("threads", [1, 2])
def test_files_change_no_result(threads: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settings = (f"world.rollout_steps={WINDOW}", "learning.minibatch_size=32", "birth.kappa=0.01")
    plain = make_simulation(*settings, threads=threads)
    monkeypatch.setenv(SCRATCH_VARIABLE, str(tmp_path))
    other = make_simulation(*settings, threads=threads)
    assert len(kept_files(tmp_path)) == len(other.worlds)
    assert not list(tmp_path.iterdir())
    for _ in range(3):  # in the second and third rounds, observations replace earlier ones
        plain.run(WINDOW + 7)
        other.run(WINDOW + 7)
        assert [world.digest() for world in plain.worlds] == [world.digest() for world in other.worlds]
    other.engine.restore(0, plain.engine.save(0))
    plain.run(WINDOW)
    other.run(WINDOW)
    assert plain.worlds[0].digest() == other.worlds[0].digest()
    del other
    assert not kept_files(tmp_path)


def test_a_run_with_files_equals_a_run_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small_run(tmp_path / "plain", 5 * WINDOW)
    monkeypatch.setenv(SCRATCH_VARIABLE, str(tmp_path))
    small_run(tmp_path / "other", 2 * WINDOW + 9)
    resume(tmp_path / "other", 5 * WINDOW)
    assert_same_run(tmp_path / "plain", tmp_path / "other")


def test_memory_is_needed_only_for_what_is_not_in_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(SCRATCH_VARIABLE, raising=False)
    config = make_simulation().config
    need = memory_needed(config, 1, 1)
    enough = sum(need.values()) - need[COLD]
    assert need[COLD] > 0.7 * (need["networks"] + need[COLD] + need["the rest of rollouts"])
    monkeypatch.setattr(memory, "memory_present", lambda: enough)
    with pytest.raises(MemoryNeedError, match=rf"{COLD} .*, or set {SCRATCH_VARIABLE} to a folder"):
        require_memory(config, 1, 1)
    monkeypatch.setenv(SCRATCH_VARIABLE, str(tmp_path))
    require_memory(config, 1, 1)
    monkeypatch.setattr(memory, "memory_present", lambda: enough - 1)
    with pytest.raises(MemoryNeedError, match=r"the number of seeds \(1\)$"):
        require_memory(config, 1, 1)


@pytest.mark.parametrize("place", ["missing", "a file"])
def test_an_invalid_folder_is_refused(place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / place
    if place == "a file":
        folder.write_text("")
    monkeypatch.setenv(SCRATCH_VARIABLE, str(folder))
    with pytest.raises(
        EngineError, match=rf"{SCRATCH_VARIABLE}: no file .* can be made in '{folder}': (No such|Not a d)"
    ):
        make_simulation()
    command = ["hedon", "run", "baseline", "--steps", "1024", "--out", str(tmp_path / "run")]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (answer.returncode, "Traceback" in answer.stderr, SCRATCH_VARIABLE in answer.stderr) == (2, False, True)
    assert not (tmp_path / "run").exists()


def test_a_disk_with_too_little_room_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(SCRATCH_VARIABLE, str(tmp_path))
    free = os.statvfs(tmp_path).f_bavail * os.statvfs(tmp_path).f_frsize
    worlds = free // memory_needed(make_simulation().config, 1, 1)[COLD] + 1000
    monkeypatch.setattr(memory, "memory_present", lambda: 10**18)
    with pytest.raises(
        MemoryNeedError, match=r"the run needs \d+\.\d GB there, and \d+\.\d GB are free: lower population"
    ):
        require_memory(make_simulation().config, worlds, 1)


@pytest.mark.long
def test_every_golden_digest_holds_with_files(tmp_path: Path) -> None:
    """All presets and mechanisms, one species and several, on processors and on the emulated device."""
    given = os.environ | {SCRATCH_VARIABLE: str(tmp_path)}
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        str(Path(__file__).parents[1] / "golden"),
    ]
    answer = subprocess.run(command, capture_output=True, text=True, check=False, env=given)
    assert answer.returncode == 0, answer.stdout
