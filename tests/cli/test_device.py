"""`hedon run --backend`: what is said where there is no device, whether its library is built or not."""

import os
import subprocess
from pathlib import Path

import pytest


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
