"""Runs the tests that depend on compiler, interpreter and libraries with each of these: `python tests/matrix.py`.

For Python 3.11 and 3.13, each with g++ and with Clang, it creates an environment in `build/matrix`, builds the engine
with warnings as errors, and tests digests, units and the command line. Missing tools are reported and skipped. Clang is
the first one of version 15 or newer in PATH, or else that of the package `ziglang`. Finally, it runs tests with the
oldest libraries that `pyproject.toml` allows.
"""

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from itertools import product
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from release.wheel import has_python, uv, zig  # noqa: E402

PYTHONS = ("3.11", "3.13")
OLDEST_CLANG = 15
TESTS = ("tests/golden", "tests/machine", "tests/unit", "tests/cli", "tests/contract/test_kernel_agreement.py")
OF_LIBRARIES = (
    *(f"tests/unit/{part}" for part in ("analysis", "cli", "config", "figure", "record", "report", "statistic")),
    *(f"tests/contract/{part}.py" for part in ("test_frozen", "test_resume")),
    "tests/cli/test_run.py",
)


def clang() -> str:
    """The command of a Clang that can build the engine; empty if there is none."""
    for name in ("clang++", *(f"clang++-{number}" for number in range(30, OLDEST_CLANG - 1, -1))):
        if path := shutil.which(name):
            said = subprocess.run([path, "-dumpversion"], capture_output=True, text=True, check=False).stdout
            if (number := re.match(r"\d+", said)) and int(number[0]) >= OLDEST_CLANG:
                return path
    # By default, Zig uses every feature of this particular processor.
    return f"{zig()} c++ -mcpu=baseline" if find_spec("ziglang") else ""


def passes(python: str, name: str, compiler: str) -> bool:
    """Builds and tests with one Python and one compiler."""
    place = ROOT / "build" / "matrix" / f"{python}-{name}"
    environment = {each: value for each, value in os.environ.items() if each != "VIRTUAL_ENV"}
    environment |= {"UV_PROJECT_ENVIRONMENT": str(place / "env"), "CXX": compiler}
    options = ["--config-setting", f"build-dir={place / 'engine'}", "--config-setting", "cmake.define.HEDON_STRICT=ON"]
    if "ziglang" in compiler:
        options += ["--config-setting", "cmake.define.HEDON_ZIG=ON"]
    sync = [uv(), "sync", "--quiet", "--python", python, "--extra", "rules", "--reinstall-package", "hedon", *options]
    test = [uv(), "run", "--no-sync", "--python", python, "pytest", "--numprocesses", "auto", *TESTS]
    return all(subprocess.run(each, cwd=ROOT, env=environment, check=False).returncode == 0 for each in (sync, test))


def passes_with_oldest(python: str) -> bool:
    """Tests with the oldest allowed libraries; packages that only tests need are the newest that accept these."""
    place = ROOT / "build" / "matrix" / "oldest"
    program, oldest = place / "env" / "bin" / "python", place / "oldest.txt"
    environment = os.environ | {"VIRTUAL_ENV": str(place / "env"), "PYTHONPATH": "tests"}
    environment["PATH"] = f"{program.parent}{os.pathsep}{environment['PATH']}"

    def done(*command: str) -> bool:
        return subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode == 0

    install = (uv(), "pip", "install", "--quiet", "--python", str(program))
    if not done(uv(), "venv", "--quiet", "--clear", "--python", python, str(place / "env")):
        return False
    if not done(*install, "--resolution", "lowest-direct", f"{ROOT}[rules]"):
        return False
    installed = subprocess.check_output([uv(), "pip", "freeze", "--python", str(program)], text=True).splitlines()
    oldest.write_text("\n".join(line for line in installed if not line.startswith("hedon")))
    if not done(
        *install, "--constraint", str(oldest), "hypothesis", "pandas", "psutil", "pyarrow", "pytest", "pytest-xdist"
    ):
        return False
    return done(str(program), "-m", "pytest", "--numprocesses", "auto", *OF_LIBRARIES)


def main() -> int:
    """Tries every pair of Python and compiler; returns an exit status."""
    compilers = {"g++": shutil.which("g++") or "", "clang": clang()}
    advice = {"g++": "apt-get install g++", "clang": "apt-get install clang-16, or uv sync --group viewer"}
    failed, tried = [], 0
    for python, (name, compiler) in product(PYTHONS, compilers.items()):
        if not has_python(python):
            print(f"matrix: no Python {python} here: uv python install {python}", flush=True)
        elif not compiler:
            print(f"matrix: no {name} here: {advice[name]}", flush=True)
        else:
            print(f"matrix: Python {python}, {compiler}", flush=True)
            tried += 1
            failed += [] if passes(python, name, compiler) else [f"Python {python} with {name}"]
    print(f"matrix: Python {PYTHONS[0]}, the oldest libraries", flush=True)
    failed += [] if passes_with_oldest(PYTHONS[0]) else ["the oldest libraries"]
    print(f"matrix: {tried} of {len(PYTHONS) * len(compilers)} tried, failed: {', '.join(failed) or 'none'}")
    return 1 if failed or not tried else 0


if __name__ == "__main__":
    sys.exit(main())
