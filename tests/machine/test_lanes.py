"""A million random operations of each lane type of this machine: references, and hashes that every machine has.

`tests/data/lanes.txt` has them, as a processor with AVX2 printed them. A result that lies within 2^-151 below the
smallest normal float is not hashed: x86 and ARM differ there (`base/float_mode.h`); the program counts how many there
were, and compares each with what its machine must have.
"""

import pytest
from machine_build import build_lanes, run
from project_files import ROOT

from hedon import _engine

HASHES = (ROOT / "tests" / "data" / "lanes.txt").read_text().splitlines()


@pytest.mark.parametrize("kernel", _engine.kernel.kernel_names())
def test_a_million_operations_have_the_bits_of_every_machine(kernel, tmp_path):
    check_lanes(run(None, build_lanes(None, kernel, tmp_path)), kernel)


def check_lanes(printed: list[str], lanes: str) -> None:
    """Compares what the program printed; the portable lanes have another multiply-add."""
    other = ("multiply_add ",) if lanes == "portable" else ()
    assert [line for line in printed if not line.startswith(other)] == [
        line for line in HASHES if not line.startswith(other)
    ]


def test_many_results_lie_where_machines_differ():
    """Else nothing would be said of them."""
    counts = {name: int(count) for name, _, count in map(str.split, HASHES)}
    assert counts["multiply"] > 10_000
    assert counts["multiply_add"] > 5_000
    assert counts["narrow"] > 10_000
    assert counts["add"] == counts["divide"] == counts["square_root"] == 0
