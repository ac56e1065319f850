"""Digests of short lives: results that change do so knowingly.

After a change that is meant to change results: `PYTHONPATH=tests python -m golden.test_digest` writes new ones. AVX2
and AVX-512 have the same bits, so a machine with one of them writes the table of both.
"""

import json
from pathlib import Path

import pytest
from worlds import RELEASED, make_simulation

from hedon import _engine

GOLDEN = Path(__file__).with_name("digest.json")
PRESETS = ("baseline", "small", "relocation", "poison")
STEPS = 1100  # one whole window with its learning, and the beginning of the next


def digest(preset: str, fidelity: str, weights: str, kernel: str) -> str:
    """The digest of one short life."""
    acting = f'learning.acting_weights="{weights}"'
    settings = RELEASED if fidelity == "released" else ()
    simulation = make_simulation(*settings, acting, preset=preset, seeds=(1,), threads=2, kernel=kernel)
    simulation.run(STEPS)
    return simulation.worlds[0].digest()


def cases() -> list[tuple[str, str, str]]:
    """Conditions whose lives are recorded."""
    lives = [*((preset, "corrected") for preset in PRESETS), ("baseline", "released")]
    return [(*life, weights) for weights in ("float32", "bfloat16") for life in lives]


@pytest.mark.parametrize("kernel", _engine.kernel.kernel_names())
@pytest.mark.parametrize(("preset", "fidelity", "weights"), cases())
def test_short_lives_keep_their_bits(preset, fidelity, weights, kernel):
    recorded = json.loads(GOLDEN.read_text())[kernel]
    assert digest(preset, fidelity, weights, kernel) == recorded[f"{preset}-{fidelity}-{weights}"]


def test_both_wide_instruction_sets_have_one_table():
    recorded = json.loads(GOLDEN.read_text())
    assert recorded["avx512"] == recorded["avx2"]


if __name__ == "__main__":
    table = {kernel: {"-".join(case): digest(*case, kernel) for case in cases()} for kernel in ("avx2", "portable")}
    GOLDEN.write_text(json.dumps({"avx512": table["avx2"], **table}, indent=2) + "\n")
