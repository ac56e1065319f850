"""Programs for other machines give the same bits as on this one: lanes, floats close to denormals, whole lives.

The lives are the golden cases that need no Python: those with Python rules or with data besides settings are omitted.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from golden_case import SEED, STEPS, cases
from machine_build import MACHINES, Machine, build_lanes, build_life, need, run
from mechanism import mechanisms
from project_files import ROOT
from test_lanes import check_lanes

from hedon.config.load import load_config
from hedon.view.engine_text import engine_text

pytestmark = pytest.mark.long

DIGESTS = json.loads((ROOT / "tests" / "golden" / "digest.json").read_text())
WHOLE_STEPS = 1000 + STEPS
RUNNING = [machine for machine in MACHINES.values() if machine.runs]
FORMATS = {
    "aarch64-macos": bytes.fromhex("cffaedfe0c000001"),  # 64-bit Mach-O, then the processor
    "x86_64-macos": bytes.fromhex("cffaedfe07000001"),
}


@pytest.fixture(scope="module")
def texts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The golden cases as text files, by name."""
    folder = tmp_path_factory.mktemp("texts")
    called = {name for name, each in mechanisms().items() if each.founders or each.networks}
    found = {}
    for name, case in cases().items():
        kind, _, rest = name.partition(".")
        if rest in called:
            continue
        given = load_config("baseline", rest.partition(".")[2]) if kind == "whole" else case(folder, "").config
        text = engine_text(given, SEED)
        if re.search(r"\.rules\[\d\]=1", text):
            continue
        found[name] = folder / f"{name}.txt"
        found[name].write_text(text)
    return found


@pytest.fixture(params=RUNNING, ids=lambda machine: machine.name)
def machine(request: pytest.FixtureRequest) -> Iterator[Machine]:
    need(request.param)
    return request.param


def digests(machine: Machine, texts: dict[str, Path], steps: int, *how: str) -> dict[str, str]:
    """The digests of lives, by case name."""
    kernel, threads, flush = how
    program = build_life(machine)
    lines = run(machine, program, kernel, threads, str(steps), flush, *map(str, texts.values()))
    return dict(zip(texts, lines, strict=True))


def recorded(names: dict[str, Path], table: str = "wide") -> dict[str, str]:
    return {name: DIGESTS[table][name]["state"] for name in names}


def of_kind(texts: dict[str, Path], *kinds: str) -> dict[str, Path]:
    return {name: path for name, path in texts.items() if name.startswith(kinds)}


def test_lanes_and_floats_have_the_same_bits_as_on_x86(machine: Machine, tmp_path: Path):
    for lanes in machine.lanes:
        check_lanes(run(machine, build_lanes(machine, lanes, tmp_path)), lanes)


def test_the_best_kernel_is_the_first(machine: Machine):
    names = run(machine, build_life(machine), "kernels")
    assert [name for name in names if name != "avx512"] == list(machine.lanes)


def test_lives_have_the_golden_digests(machine: Machine, texts: dict[str, Path]):
    short = of_kind(texts, "preset", "plain", "mechanism", "combination")
    assert len(short) > 150
    assert digests(machine, short, STEPS, machine.fused, "1", "flush") == recorded(short)


def test_a_whole_window_has_the_golden_digest_on_three_threads(machine: Machine, texts: dict[str, Path]):
    whole = of_kind(texts, "whole")
    assert len(whole) == 2
    assert digests(machine, whole, WHOLE_STEPS, machine.fused, "3", "flush") == recorded(whole)


def test_keeping_denormals_changes_no_bit(machine: Machine, texts: dict[str, Path]):
    """So flushing before rounding instead of after it changes no bit either."""
    some = of_kind(texts, "preset", "combination", "mechanism.smell", "mechanism.frozen")
    assert digests(machine, some, STEPS, machine.fused, "2", "keep") == recorded(some)


def test_the_portable_kernel_has_its_own_digests(machine: Machine, texts: dict[str, Path]):
    some = of_kind(texts, "preset")
    assert digests(machine, some, STEPS, "portable", "1", "flush") == recorded(some, "portable")


@pytest.mark.parametrize("name", FORMATS)
def test_the_engine_compiles_for_macos(name: str):
    need(MACHINES[name])
    assert build_life(MACHINES[name]).read_bytes()[:8] == FORMATS[name]
