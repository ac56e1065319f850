"""The worlds that `tests/device.py` has as texts, for machines without hedon, match the presets.

After a change of settings, `PYTHONPATH=tests uv run python -m repository.test_device_text` writes them again.
"""

import os
import subprocess
import sys

import device
import pytest
from project_files import ROOT

from hedon.config.load import load_config
from hedon.view.engine_text import engine_text

TEXTS = ROOT / "tests" / "data" / "device"
PRESETS = ("baseline", "poison", "predator", "relocation")


@pytest.mark.parametrize("preset", PRESETS)
def test_a_text_matches_its_preset(preset: str):
    assert (TEXTS / f"{preset}.txt").read_text() == engine_text(load_config(preset), 1)


def test_without_a_device_one_sentence_is_said():
    hidden = os.environ | {"CUDA_VISIBLE_DEVICES": ""}
    command = [sys.executable, str(ROOT / "tests" / "device.py")]
    answer = subprocess.run(command, capture_output=True, text=True, check=False, env=hidden)
    assert (answer.returncode, answer.stderr.count("\n")) == (2, 1)
    assert "no CUDA device" in answer.stderr


@pytest.mark.long
@pytest.mark.parametrize("options", [(), ("--variants",)])
def test_the_script_runs_on_the_emulated_device(tmp_path, options: tuple[str, ...]):
    out = ("--out", str(tmp_path / "device.json"))
    command = [sys.executable, str(ROOT / "tests" / "device.py"), "--emulate", *options, *out]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stdout + answer.stderr


@pytest.mark.long
def test_its_program_is_built_for_a_device():
    """Built by nvcc; on a machine without a device, the program says so."""
    if device.build.find_nvcc() is None:
        pytest.skip("needs nvcc: uv sync --group cuda")
    program = device.build_default(emulated=False)
    hidden = os.environ | {"CUDA_VISIBLE_DEVICES": ""}
    answer = subprocess.run([str(program), "describe"], capture_output=True, text=True, check=False, env=hidden)
    assert (answer.returncode, "no CUDA device" in answer.stderr) == (2, True)


if __name__ == "__main__":
    for name in PRESETS:
        (TEXTS / f"{name}.txt").write_text(engine_text(load_config(name), 1))
