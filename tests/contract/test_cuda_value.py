"""Worlds of a device as values: a copy goes on there, and on the processor, with the same bits."""

import pickle
from copy import deepcopy

import pytest
from cuda_emulation import emulated as emulated

from hedon import Simulation, load_config

SMALL = (
    "world.rollout_steps=16",
    "learning.minibatch_size=8",
    "learning.update_epochs=1",
    "population.capacity=8",
    "population.initial_count=4",
)
CONFIG = load_config("baseline", overrides=SMALL)
WAYS = {
    "clone": lambda simulation: simulation.clone(),
    "deepcopy": deepcopy,
    "pickle": lambda simulation: pickle.loads(pickle.dumps(simulation)),
}


def digests(simulation: Simulation) -> list[str]:
    return [world.digest() for world in simulation.worlds]


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
@pytest.mark.parametrize("steps", [9, 20])
def test_a_copy_on_a_device_goes_on_alone(way, steps, emulated):
    one = Simulation(CONFIG, seeds=(1, 2), backend=emulated)
    one.run(steps)
    other = way(one)
    at = digests(one)
    assert digests(other) == at
    one.run(12)
    assert digests(other) == at
    other.run(12)
    assert digests(other) == digests(one) != at


@pytest.mark.parametrize("back", [False, True], ids=["to the processor", "to the device"])
def test_what_is_saved_on_one_goes_on_on_the_other(back, emulated):
    backends = ("avx2", emulated) if back else (emulated, "avx2")
    one, other = (Simulation(CONFIG, seeds=(1, 2), backend=backend) for backend in backends)
    one.run(20)
    other.run(3)
    other.restore(one.save())
    for each in (one, other):
        each.run(12)
    assert digests(one) == digests(other)
