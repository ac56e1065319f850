"""The house rules that a script can check: sizes of files, includes between parts, and what the step path may use."""

import re
from pathlib import Path

import pytest
from project_files import ROOT, project_files

LONGEST = 400

# What each part of the engine may include, besides itself.
ALLOWED = {
    "base": set(),
    "config": {"base"},
    "lanes": {"base"},
    "learning": {"base", "config"},
    "kernel": {"base", "config", "lanes", "learning"},
    "physics": {"base", "config"},
    "evolution": {"base", "config"},
    "world": {"base", "config", "physics", "evolution", "learning", "kernel"},
    "simulation": {"base", "config", "physics", "evolution", "learning", "kernel", "world"},
    "binding": {"base", "config", "physics", "evolution", "learning", "kernel", "world", "simulation"},
    "web": {"base", "config", "lanes", "physics", "evolution", "learning", "kernel", "world", "simulation"},
    "cuda": {"base", "config", "lanes", "learning", "kernel", "physics", "simulation"},
}
STEP_PATH = ("config", "physics", "evolution", "learning", "world", "kernel")
FORBIDDEN_IN_STEP = re.compile(
    r"#include <(vector|string|map|set|functional|memory|iostream|mutex|thread|chrono|random|algorithm)>"
    r"|\b(new|malloc|calloc|virtual|throw|try|dynamic_cast)\b[^\w]"
)
# nvcc knows none of GCC's builtins behind them: it silently took `std::countr_zero` for the constant 32.
UNKNOWN_TO_NVCC = re.compile(
    r"std::(bit_\w+|byteswap|count[lr]_(zero|one)|has_single_bit|popcount|rot[lr])\b|__builtin_(clz|ctz|ffs|parity|popcount)"
)


def code_without_comments(path: Path) -> str:
    return re.sub(r"//.*", "", path.read_text(encoding="utf-8"))


def test_no_file_is_too_long():
    long = {
        str(p.relative_to(ROOT)): n
        for p in project_files(".py", ".h", ".cpp", ".cu")
        if (n := len(p.read_text().splitlines())) > LONGEST
    }
    assert not long


@pytest.mark.parametrize("part", sorted(ALLOWED))
def test_engine_parts_include_only_what_they_may(part):
    files = [p for p in project_files(".h", ".cpp", ".cu") if p.parent == ROOT / "engine" / part]
    assert files
    for path in files:
        for target in re.findall(r'#include "([\w/]+)/[\w.]+"', path.read_text()):
            assert target == part or target in ALLOWED[part], f"{path.relative_to(ROOT)} includes {target}"


def test_the_step_path_owns_nothing_and_throws_nothing():
    for part in STEP_PATH:
        for path in (ROOT / "engine" / part).glob("*.h"):
            found = FORBIDDEN_IN_STEP.search(code_without_comments(path))
            assert found is None, f"{path.relative_to(ROOT)}: {found.group()}"


def test_every_engine_file_says_what_it_is_for():
    for path in project_files(".h", ".cpp"):
        first = path.read_text().splitlines()[0]
        twin = path.with_suffix(".h").exists() and path.suffix == ".cpp"
        assert first.startswith("///") or twin, path.relative_to(ROOT)


def test_no_file_has_notes_about_unfinished_work():
    words = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
    for path in project_files(".py", ".h", ".cpp", ".md", ".toml"):
        if path != Path(__file__):
            assert not words.search(path.read_text(encoding="utf-8")), path.relative_to(ROOT)


def test_test_files_have_unique_names():
    """Pytest imports them by name only, and stops if two share one."""
    names = [path.name for path in project_files(".py") if path.is_relative_to(ROOT / "tests")]
    assert len(names) == len(set(names))


def test_kernels_count_bits_with_functions_that_nvcc_knows():
    wrappers = {"device.h", "thread.h"}  # they call CUDA's own functions where it compiles
    of_processors = {"avx2.h", "avx512.h", "neon.h", "portable.h"}
    for part in (*STEP_PATH, "base", "lanes", "cuda"):
        for path in (ROOT / "engine" / part).glob("*.h"):
            found = UNKNOWN_TO_NVCC.search(code_without_comments(path))
            allowed = path.name in wrappers | of_processors
            assert found is None or allowed, f"{path.relative_to(ROOT)}: {found.group()}"
