"""A million random operations for each lane type of this machine, compared with references and portable hashes.

`tests/data/lanes.txt` has the hashes, as printed on a processor with AVX2. A result less than 2^-151 below the smallest
normal float is not hashed, because x86 and ARM differ there (`base/float_mode.h`). The program counts such results and
compares each with the one expected on its machine.
"""

import pytest
from machine_build import build_lanes, run
from project_files import ROOT

from hedon import _engine

HASHES = (ROOT / "tests" / "data" / "lanes.txt").read_text().splitlines()


@pytest.mark.parametrize("kernel", _engine.kernel.kernel_names())
def test_a_million_operations_have_the_same_bits_on_every_machine(kernel, tmp_path):
    check_lanes(run(None, build_lanes(None, kernel, tmp_path)), kernel)


def check_lanes(printed: list[str], lanes: str) -> None:
    """Compares the hashes that the program printed; the multiply-add of the portable lanes differs."""
    other = ("multiply_add ",) if lanes == "portable" else ()
    assert [line for line in printed if not line.startswith(other)] == [
        line for line in HASHES if not line.startswith(other)
    ]


def test_many_results_fall_where_machines_differ():
    """Otherwise these results would not be tested."""
    counts = {name: int(count) for name, _, count in map(str.split, HASHES)}
    assert counts["multiply"] > 10_000
    assert counts["multiply_add"] > 5_000
    assert counts["narrow"] > 10_000
    assert counts["add"] == counts["divide"] == counts["square_root"] == 0
