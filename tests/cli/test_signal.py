"""Signals end every command that runs worlds in the same way: with the shell's exit code and without loss."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from command import hedon

SWEEP = """
base = "small"
seeds = "1-2"
steps = 2000000

[factor]
"energy.basic_cost" = [0.001, 0.002]
"""
LONG = ("--steps", "2000000")
COMMANDS = {
    "run": ("run", "small", *LONG, "--out", "made"),
    "resume": ("resume", "begun", *LONG),
    "branch": ("branch", "begun", *LONG, "--out", "made"),
    "assay": ("assay", "landscape", "small", "--seeds", "1", *LONG, "--out", "made"),
    "sweep": ("sweep", "run", "cost.toml", "--out", "made", "--workers", "1"),
    "study": ("study", "run", "weights-baseline", "--seeds", "1", *LONG, "--runs", "made", "--out", "page"),
}
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@pytest.fixture(scope="module")
def begun(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a sweep file and a finished run."""
    folder = tmp_path_factory.mktemp("signal")
    (folder / "cost.toml").write_text(SWEEP)
    answer = hedon("run", "small", "--steps", "1024", "--out", "begun", "--no-report", cwd=folder)
    assert answer.returncode == 0, answer.stderr
    return folder


def _heed() -> None:
    """Restores the default signal handlers in a new process, even if this one ignores some."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def _parts(folder: Path) -> int:
    return len(list(folder.rglob("population/part-*.parquet")))


@pytest.mark.parametrize("command", COMMANDS)
def test_a_signal_ends_it_with_the_code_of_the_shell(command, begun, tmp_path):
    folder = tmp_path / "work"
    subprocess.run(["cp", "-r", str(begun), str(folder)], check=True)
    number = SIGNALS[list(COMMANDS).index(command) % len(SIGNALS)]
    before, words = _parts(folder), [*COMMANDS[command]]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    process = subprocess.Popen(["hedon", *words], cwd=folder, env=os.environ, preexec_fn=_heed, **pipes)
    try:
        end = time.monotonic() + 240
        while _parts(folder) == before and process.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
        process.send_signal(number)
        printed, errors = process.communicate(timeout=240)
    finally:
        process.kill()
    assert process.returncode == 128 + number, (printed, errors)
    assert "Interrupted" in printed
    assert "Traceback" not in errors
    states = [json.loads(path.read_text())["status"] for path in folder.rglob("manifest.json")]
    assert "interrupted" in states
    assert set(states) <= {"interrupted", "finished"}
