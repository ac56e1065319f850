"""Units compiled for one instruction set define nothing but their table.

The linker could keep an inline function emitted by such a unit for the whole program,
which would then crash on processors without that instruction set.
"""

from __future__ import annotations

import platform
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CMAKE = (ROOT / "CMakeLists.txt").read_text()
IS_X86 = platform.machine() in ("x86_64", "AMD64")
IS_ARM = platform.machine() in ("aarch64", "arm64")


def unit_flags(name: str) -> list[str]:
    """The compiler flags that CMakeLists.txt sets for this unit."""
    if name in ("portable", "neon"):
        return []
    found = re.search(rf'engine/kernel/{name}\.cpp PROPERTIES\s+COMPILE_OPTIONS "([^"]+)"', CMAKE)
    assert found, f"CMakeLists.txt gives no flags to {name}.cpp"
    return found[1].split(";")


@pytest.mark.parametrize("level", [pytest.param("-O0", marks=pytest.mark.long), "-O3"])
@pytest.mark.parametrize(
    "name",
    [
        "portable",
        *(
            pytest.param(n, marks=pytest.mark.skipif(not IS_X86, reason="not an x86 processor"))
            for n in ("avx2", "avx512")
        ),
        pytest.param("neon", marks=pytest.mark.skipif(not IS_ARM, reason="not an ARM processor")),
    ],
)
def test_unit_defines_only_its_table(name: str, level: str, tmp_path: Path):
    unit = tmp_path / "unit.o"
    flags = ["-std=c++20", level, "-ffp-contract=off", "-fno-exceptions", "-fno-rtti", *unit_flags(name)]
    source = ROOT / "engine" / "kernel" / f"{name}.cpp"
    subprocess.run(["c++", *flags, "-I", ROOT / "engine", "-c", source, "-o", unit], check=True)
    listing = subprocess.run(
        ["nm", "--extern-only", "--defined-only", "--format=posix", unit],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    symbols = [line.split()[:2] for line in listing.splitlines()]
    assert [kind for _, kind in symbols] in (["D"], ["R"]), listing
    assert f"{name.upper()}_KERNEL" in symbols[0][0]


def test_intrinsics_stay_in_the_lanes():
    suffixes = {".h", ".cpp", ".cu"}
    sources = [p for p in (ROOT / "engine").rglob("*") if p.suffix in suffixes and p.parent.name != "lanes"]
    assert sources
    assert [p.name for p in sources if re.search(r"\b_mm\d*_|immintrin|arm_neon", p.read_text())] == []


def test_kernels_include_no_standard_library():
    paths = [*(ROOT / "engine" / "lanes").iterdir(), *(ROOT / "engine" / "kernel").glob("*.h")]
    assert len(paths) > 10
    for path in paths:
        included = re.findall(r"#include <([^>]+)>", path.read_text())
        assert set(included) <= {"cstdint", "immintrin.h", "arm_neon.h"}, path.name
