"""Worlds of an emulated CUDA device are values: they go on there and on the processor with the same bits."""

import copy
import pickle
import platform
from collections.abc import Callable
from typing import Any

import pytest
from cuda_emulation import emulated as emulated
from worlds import make_simulation

pytestmark = pytest.mark.skipif(platform.machine() != "x86_64", reason="compares with AVX2")

SHORT = (
    "world.rollout_steps=16",
    "learning.minibatch_size=8",
    "learning.update_epochs=2",
    "birth.kappa=0.05",
    "hazard.alpha_age=0.01",
    "population.capacity=24",
    "population.initial_count=12",
)
PAIR = (*SHORT, "species.wise.body.radius=10", "species.led.body.radius=10")
WAYS: dict[str, Callable[[Any], Any]] = {
    "clone": lambda held: held.clone(),
    "deepcopy": copy.deepcopy,
    "pickle": lambda held: pickle.loads(pickle.dumps(held)),
}


def digests(held: Any) -> list[str]:
    return [world.digest() for world in getattr(held, "simulation", held).worlds]


@pytest.mark.parametrize("settings", [SHORT, PAIR], ids=["one", "pair"])
@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_a_copy_on_the_device_goes_on_alone(emulated: str, way, settings):
    there = make_simulation(*settings, seeds=(3, 8), backend=emulated)
    there.run(21)
    other = way(there)
    assert other.engine.device_count > 0
    at = digests(there)
    there.run(20)
    assert digests(other) == at
    other.run(20)
    assert digests(other) == digests(there) != at


@pytest.mark.parametrize("settings", [SHORT, PAIR], ids=["one", "pair"])
def test_kept_worlds_go_on_on_the_other_side(emulated: str, settings):
    here, there = (make_simulation(*settings, seeds=(3, 8), backend=each) for each in ("avx2", emulated))
    here.run(21)
    there.run(21)
    kept = here.save(), there.save()
    here.run(20)
    there.run(20)
    end = digests(here)
    assert digests(there) == end
    here.restore(kept[1])
    there.restore(kept[0])
    here.run(20)
    there.run(20)
    assert digests(here) == digests(there) == end
