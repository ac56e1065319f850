"""The engine compared with the rules in plain Python, in worlds of one mechanism and of several random ones."""

from itertools import islice

import pytest
from mechanism import Mixture, alone, mechanisms, worlds
from mechanism_data import founders_of, networks_of
from reference_step import Judge, command

from hedon.error import EngineError, HedonError
from hedon.experiment.simulation import Simulation

SEED, DRAW = 5, 1
STEPS = 48
"""One window of 32 steps and half of the next."""
TOGETHER = 6
"""Number of mechanisms in a random world."""
BATCH = 5
REFUSED = 1
"""Number of worlds in a batch that may be refused, if founders do not fit or schedules end too soon."""


def judge_world(world: Mixture, folder) -> bool:
    """Judges a world for a while; returns whether it is possible. The engine stops worlds whose bodies are pushed
    too far into one another."""
    try:
        config = world.config(folder)
        simulation = Simulation(config, [SEED], threads=1)
    except HedonError:
        return False
    judge = Judge(simulation, SEED)
    judge.begin()
    founders, networks = founders_of(world, config), networks_of(world, config)
    if founders is not None:
        simulation.set_founders(founders)
    if networks is not None:
        simulation.set_networks(networks)
    try:
        while simulation.worlds[0].step < STEPS and not simulation.worlds[0].extinct:
            command(simulation)
            judge.step()
    except EngineError as error:
        if not str(error).startswith("overlap_too_deep"):
            raise
        return False
    return True


@pytest.mark.long
@pytest.mark.parametrize("name", mechanisms())
def test_every_mechanism_follows_the_rules(name, tmp_path):
    assert judge_world(alone(mechanisms()[name]), tmp_path)


@pytest.mark.parametrize("batch", [0, *(pytest.param(n, marks=pytest.mark.long) for n in range(1, 60))])
def test_random_worlds_follow_the_rules(batch, tmp_path):
    drawn = [world for world, _ in islice(worlds(DRAW, TOGETHER), BATCH * batch, BATCH * (batch + 1))]
    assert sum(judge_world(world, tmp_path) for world in drawn) >= BATCH - REFUSED, drawn
