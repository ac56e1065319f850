import subprocess
import sys

HEAVY = ("numpy", "polars", "pydantic", "matplotlib", "scipy", "rich", "hedon._engine")


def test_importing_the_command_line_loads_nothing_heavy() -> None:
    code = f"import sys, hedon.cli.main; print([name for name in {HEAVY} if name in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
