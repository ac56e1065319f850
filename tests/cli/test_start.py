import subprocess
import sys
from importlib.metadata import entry_points

import pytest

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
    assert answer.stderr.strip() in ("hedon: interrupted", "")  # by us, or by the parser of commands


def test_the_installed_command_begins_there() -> None:
    (script,) = entry_points(group="console_scripts", name="hedon")
    assert script.value == "hedon.cli.start:main"


@pytest.mark.parametrize("command", ["report", "resume", "branch", "check", "replay-fault"])
def test_a_path_that_no_file_system_takes_is_a_message(command: str) -> None:
    answer = subprocess.run(["hedon", command, "a" * 300], capture_output=True, text=True, check=False)
    assert answer.returncode == 2
    assert answer.stderr.strip().endswith("aaa: File name too long")
