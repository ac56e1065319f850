"""Machines other than this one: how to compile for each of them, and how to run the programs here.

Zig's Clang, a pinned package, compiles for all of them; g++ for ARM serves as a second compiler. QEMU runs ARM programs
and Wine runs Windows programs; programs for macOS can only be compiled.
"""

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import pytest
from project_files import ROOT

from release.wheel import zig

NATIVE = ROOT / "tests" / "native"
OPTIONS = ("-std=c++20", "-O3", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-fno-math-errno", "-Iengine")
LANES = {
    "avx512": ("-mavx512f", "-mavx512dq", "-mavx512bw", "-mavx512vl", "-mfma"),
    "avx2": ("-mavx2", "-mfma"),
    "neon": (),
    "portable": (),
}
"""The lane types, each with the compiler options for its processor."""


@dataclass(frozen=True)
class Machine:
    """A machine that programs are built for.

    Attributes:
        name: Name of its build folder.
        lanes: Lane types that its processor supports, the best first.
        target: Its name in Zig; empty if `compiler` is used.
        compiler: Compiler to use instead of Zig's.
        runner: Program that runs its programs here; empty if they run directly.
        package: Debian packages of the compiler and the runner.
        runs: Whether its programs can run here.
        suffix: File suffix of its programs.
    """

    name: str
    lanes: tuple[str, ...]
    target: str = ""
    compiler: str = ""
    runner: tuple[str, ...] = ()
    package: str = ""
    runs: bool = True
    suffix: str = ""

    @property
    def fused(self) -> str:
        """Its lane type with the same bits on all machines."""
        return self.lanes[0]


MACHINES = {
    each.name: each
    for each in (
        Machine("aarch64-linux", ("neon", "portable"), "aarch64-linux-musl", "", ("qemu-aarch64",), "qemu-user"),
        Machine(
            "aarch64-linux-g++",
            ("neon", "portable"),
            compiler="aarch64-linux-gnu-g++",
            runner=("qemu-aarch64",),
            package="g++-aarch64-linux-gnu qemu-user",
        ),
        Machine(
            "x86_64-windows", ("avx2", "portable"), "x86_64-windows-gnu", "", ("wine",), "wine wine64", suffix=".exe"
        ),
        Machine("x86_64-macos", ("avx2", "portable"), "x86_64-macos", runs=False),
        Machine("aarch64-macos", ("neon", "portable"), "aarch64-macos", runs=False),
    )
}


def need(machine: Machine) -> None:
    """Skips the test if a required tool is not installed, and names the package that provides it."""
    if machine.target and find_spec("ziglang") is None:
        pytest.skip("needs Zig's compiler: uv sync --group viewer")
    for tool in filter(None, (machine.compiler, *machine.runner)):
        if shutil.which(tool) is None:
            pytest.skip(f"needs {tool}: apt-get install {machine.package}")


def build_life(machine: Machine) -> Path:
    """Builds the whole engine with the program `native/life.cpp`, using CMake."""
    folder = ROOT / "build" / "machine" / machine.name
    if machine.target:
        how = [f"--toolchain={ROOT / 'cmake/zig.cmake'}", f"-DHEDON_ZIG={zig()}"]
        how += [f"-DHEDON_TARGET={machine.target}"]
    else:
        how = ["-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=aarch64", "-DCMAKE_EXE_LINKER_FLAGS=-static"]
        how += [f"-DCMAKE_CXX_COMPILER={machine.compiler}"]
    options = ["-DHEDON_PYTHON=OFF", "-DHEDON_LIFE=ON", "-DHEDON_STRICT=ON"]
    _call("cmake", "-S", str(ROOT), "-B", str(folder), "-G", "Ninja", *how, *options)
    _call("cmake", "--build", str(folder), "--target", "life")
    return folder / f"life{machine.suffix}"


def build_lanes(machine: Machine | None, lanes: str, folder: Path) -> Path:
    """Builds the program `native/lanes.cpp` with a lane type; for this machine if none is given."""
    out = folder / f"lanes-{lanes}{machine.suffix if machine else ''}"
    if machine is None:
        compiler = ["c++"]
    elif machine.target:
        compiler = [str(zig()), "c++", "-target", machine.target]
    else:
        compiler = [machine.compiler, "-static"]
    defined = [f'-DHEDON_LANES="lanes/{lanes}.h"', f"-DHEDON_FUSES={int(lanes != 'portable')}"]
    _call(*compiler, *OPTIONS, *LANES[lanes], *defined, str(NATIVE / "lanes.cpp"), "-o", str(out))
    return out


def run(machine: Machine | None, program: Path, *arguments: str) -> list[str]:
    """Runs a program and returns the lines that it prints."""
    runner = machine.runner if machine else ()
    return _call(*runner, str(program), *arguments).splitlines()


def _call(*command: str) -> str:
    environment = os.environ | {"WINEDEBUG": "-all"}  # keeps Wine's messages out of the program's output
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout[-2000:]}{done.stderr[-4000:]}"
    return done.stdout


if __name__ == "__main__":
    print(build_life(MACHINES[sys.argv[1]]))
