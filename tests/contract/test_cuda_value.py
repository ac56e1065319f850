"""Worlds on an emulated CUDA device are values: copies continue there and on the processor with the same bits."""

import pytest
from cuda_emulation import emulated as emulated
from world_copy import LIVELY, PAIR, WAYS, digests
from worlds import make_simulation

BOTH = pytest.mark.parametrize("settings", [LIVELY, PAIR], ids=["one", "pair"])


@BOTH
@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_a_copy_on_the_device_goes_on_alone(emulated: str, way, settings):
    there = make_simulation(*settings, seeds=(3, 8), backend=emulated)
    there.run(21)
    other = way(there)
    assert other.engine.device_count > 0
    at = digests(there)
    there.run(50)
    assert digests(other) == at
    other.run(50)
    assert digests(other) == digests(there) != at


@BOTH
def test_saved_worlds_continue_on_the_other_backend(emulated: str, settings):
    here, there = (make_simulation(*settings, seeds=(3, 8), backend=each) for each in ("avx2", emulated))
    here.run(21)
    there.run(21)
    kept = here.save(), there.save()
    here.run(50)
    there.run(50)
    end = digests(here)
    assert digests(there) == end
    here.restore(kept[1])
    there.restore(kept[0])
    here.run(50)
    there.run(50)
    assert digests(here) == digests(there) == end
