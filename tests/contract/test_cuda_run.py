"""Whole runs on the emulated device: records, checkpoints, resuming on either backend, checking the folder."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from cuda_emulation import emulated as emulated
from project_files import ROOT
from sweep_case import assert_same_table, sweep_file, table_of

from hedon.check.run import check_run
from hedon.config.load import load_config
from hedon.experiment.device import EMULATION_VARIABLE
from hedon.experiment.plan import RunPlan
from hedon.experiment.resume import lock, resume
from hedon.experiment.run import run
from hedon.experiment.simulation import BACKEND_VARIABLE
from hedon.record.manifest import load_manifest

SETTINGS = (
    "world.rollout_steps=32",
    "learning.minibatch_size=16",
    "learning.update_epochs=1",
    "population.capacity=8",
    "population.initial_count=4",
    "hazard.alpha_age=0.005",
)


def test_a_run_moves_from_device_to_processor_with_the_same_bits(
    emulated: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    config = load_config("baseline", overrides=SETTINGS)

    def plan(name: str, steps: int, kernel: str) -> RunPlan:
        return RunPlan(config, (1, 2), steps, tmp_path / name, 1, backend=kernel)

    run(plan("mixed", 40, emulated))
    with monkeypatch.context() as asked:
        asked.setenv(BACKEND_VARIABLE, emulated)
        resume(tmp_path / "mixed", 75, 1)
    monkeypatch.delenv(EMULATION_VARIABLE)
    with lock(tmp_path / "mixed", 100) as found:
        assert any("continuing on the processor, with the same bits" in note for note in found.notes)
    mixed = resume(tmp_path / "mixed", 100, 1)
    whole = run(plan("whole", 100, "avx2"))
    assert mixed.world_digests == whole.world_digests
    assert mixed.records_digest == whole.records_digest
    assert check_run(tmp_path / "mixed").findings == ()
    kernels = [session.backend for session in mixed.sessions]
    assert kernels[:2] == [emulated, emulated]
    assert kernels[2] in ("avx2", "avx512")


def cli(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["hedon", *map(str, arguments)], capture_output=True, text=True, check=False)


def settings() -> list[str]:
    return [f"--set={setting}" for setting in SETTINGS]


@pytest.mark.long
def test_commands_work_on_the_device_as_on_the_processor(emulated: str, tmp_path: Path):
    """Run, Ctrl-C, resume without naming the device, branch, and check both folders."""
    folder = tmp_path / "run"
    command = ["hedon", "run", "baseline", "--backend", emulated, "--seeds", "1-3", "--steps", "3200", *settings()]
    process = subprocess.Popen([*command, "--out", str(folder), "--checkpoint", "0"], stdout=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while len(list(folder.glob("population/*"))) == 0 and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[0]
    assert process.returncode == 0
    assert "Interrupted after step" in said
    done = max(load_manifest(folder).steps_done)
    for arguments in (("resume", folder, "--steps", done + 40), ("branch", folder, "--steps", done + 72)):
        assert cli(*arguments, "--no-report").returncode == 0
    (branched,) = tmp_path.glob("run-branch*")
    for place in (folder, branched):
        assert cli("check", place).returncode == 0
        assert {session.backend for session in load_manifest(place).sessions} == {emulated}


def test_benchmarks_measure_a_device_and_compare_its_bits(emulated: str, tmp_path: Path):
    command = [sys.executable, "-m", "benchmarks", "--quick"]
    given = {"cwd": ROOT, "capture_output": True, "text": True, "check": False}
    answer = subprocess.run([*command, "--device", emulated, "--json", str(tmp_path / "bench.json")], **given)
    assert answer.returncode == 0, answer.stderr
    rows = json.loads((tmp_path / "bench.json").read_text())["parts"]["device"]
    assert [(row["worlds"], row["devices"]) for row in rows] == [(1, 1), (2, 2)]
    assert all(row[f"{kernel}_seconds"] > 0 for row in rows for kernel in ("step", "learn", "close", "copying"))
    wrong = subprocess.run([*command, "device"], **given)
    assert (wrong.returncode, "--device cuda" in wrong.stderr) == (2, True)


@pytest.mark.long
def test_a_sweep_on_a_device_gives_the_same_table_as_on_the_processor(
    emulated: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    file = sweep_file(tmp_path, steps=96, seeds=1, worlds=1)
    for place, kernel in (("device", emulated), ("here", "avx2")):
        monkeypatch.setenv(BACKEND_VARIABLE, kernel)
        answer = cli("sweep", "run", file, "--workers", 1, "--out", tmp_path / place)
        assert answer.returncode == 0, answer.stderr
    assert_same_table(table_of(str(tmp_path / "device")), table_of(str(tmp_path / "here")))
