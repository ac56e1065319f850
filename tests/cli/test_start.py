import os
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from command import hedon

from hedon.record.manifest import load_manifest

HEAVY = ("numpy", "polars", "pydantic", "matplotlib", "scipy", "rich", "hedon._engine")


def test_importing_the_command_line_loads_nothing_heavy() -> None:
    code = f"import sys, hedon.cli.main; print([name for name in {HEAVY} if name in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


@pytest.mark.parametrize("module", ["typer", "hedon.cli.main", "hedon.config", "pydantic", "hedon.config.check"])
def test_ctrl_c_while_the_command_starts_leaves_no_traceback(module: str) -> None:
    code = f"""
import sys

class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupt())
sys.argv = ["hedon", "config", "check", "baseline"]
from hedon.cli.start import main
main()
"""
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert answer.returncode == 130
    assert answer.stderr.strip() in ("hedon: interrupted", "")  # by hedon, or by the command-line parser


def test_the_installed_command_calls_the_main_of_cli_start() -> None:
    (script,) = entry_points(group="console_scripts", name="hedon")
    assert script.value == "hedon.cli.start:main"


@pytest.mark.parametrize("command", ["report", "resume", "branch", "check"])
def test_a_path_that_no_file_system_accepts_gets_a_message(command: str) -> None:
    answer = hedon(command, "a" * 300)
    assert answer.returncode == 2
    assert answer.stderr.strip().endswith("File name too long")
    assert "Traceback" not in answer.stderr


def test_a_folder_whose_name_is_not_unicode_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    name = os.fsdecode(b"run\xff")
    for command in (
        ["run", "small", "--steps", "3", "--out", name],
        ["check", name],
        ["report", name],
        ["resume", name],
    ):
        answer = subprocess.run(["hedon", *command], cwd=tmp_path, capture_output=True, check=False)
        assert answer.returncode == 2
        assert b"must be UTF-8" in answer.stderr
        assert b"Traceback" not in answer.stderr
    assert not list(tmp_path.iterdir())


def test_arguments_that_are_not_unicode_leave_a_readable_manifest(tmp_path: Path) -> None:
    (tmp_path / os.fsdecode(b"in\xff")).mkdir()
    config = tmp_path / os.fsdecode(b"in\xff") / "my.toml"
    config.write_text('preset = "small"\npopulation.capacity = 8\npopulation.initial_count = 8\n')
    out = tmp_path / "run"
    command = ["hedon", "run", str(config), "--steps", "3", "--out", str(out), "--no-report"]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    assert str(load_manifest(out).command_line[2]).endswith("in\\udcff/my.toml")
    assert subprocess.run(["hedon", "check", str(out)], check=False).returncode == 0
