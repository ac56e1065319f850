"""The engine's type stubs, which editors and the type checker read, match the engine."""

import subprocess
import sys
from pathlib import Path

STUBS = Path(__file__).parents[2] / "src" / "hedon" / "_engine"


def test_the_stubs_are_current(tmp_path):
    """After changing the bindings, run `make stubs`."""
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-r", "-m", "hedon._engine", "-O", str(tmp_path)]
    subprocess.run(command, check=True)
    fresh = {path.name: path.read_text() for path in (tmp_path / "_engine").iterdir()}
    committed = {path.name: path.read_text() for path in STUBS.glob("*.pyi")}
    assert fresh == committed
