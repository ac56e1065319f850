"""Messages of `hedon run --backend` without a device, whether or not its library is built."""

import os
import subprocess
from pathlib import Path

import pytest
from command import hedon

from hedon import _engine
from hedon.experiment.argument import INSTRUCTION_SETS


def call(*arguments: object) -> subprocess.CompletedProcess[str]:
    hidden = os.environ | {"CUDA_VISIBLE_DEVICES": ""}
    return subprocess.run(["hedon", *map(str, arguments)], capture_output=True, text=True, check=False, env=hidden)


@pytest.mark.parametrize(
    ("backend", "expected"), [("cuda", "cannot be used: "), ("cdua", "--backend 'cdua': is none of ")]
)
def test_without_a_device_one_sentence_is_said(tmp_path: Path, backend: str, expected: str):
    answer = call("run", "baseline", "--backend", backend, "--out", tmp_path / "run")
    assert answer.returncode == 2
    assert expected in answer.stderr
    assert "Traceback" not in answer.stderr
    assert not (tmp_path / "run").exists()


def test_the_help_and_the_error_list_the_same_backends(tmp_path: Path):
    every = "avx512, avx2, neon, portable, cuda"
    shown = " ".join(hedon("run", "--help", COLUMNS="200").stdout.replace("│", " ").split())
    assert f"Instruction set or device: {every};" in shown
    answer = hedon("run", "baseline", "--backend", "quantum", cwd=tmp_path)
    assert (answer.returncode, answer.stderr) == (2, f"hedon: --backend 'quantum': is none of {every}\n")


def test_an_instruction_set_of_other_processors_is_refused(tmp_path: Path):
    here = _engine.kernel.kernel_names()
    assert set(here) < set(INSTRUCTION_SETS)
    other = next(name for name in INSTRUCTION_SETS if name not in here)
    answer = hedon("run", "baseline", "--backend", other, cwd=tmp_path)
    assert answer.returncode == 2
    assert answer.stderr == f"hedon: --backend {other}: this processor does not have it; it has {', '.join(here)}\n"
