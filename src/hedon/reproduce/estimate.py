"""How long will it take on this machine? Measured with worlds as they are in the middle of a run."""

import time
from dataclasses import dataclass, replace

from hedon.config import Config
from hedon.experiment.simulation import Simulation

TYPICAL_ALIVE = 150
"""Agents of a typical world; a fresh one has too few to tell."""
MOST_WORLDS = 16
"""Worlds measured side by side at most: more threads are taken to be as fast each."""


@dataclass(frozen=True)
class Speed:
    """What a machine makes.

    Attributes:
        rate: steps of all worlds together [world-steps/s].
        threads: that it was counted for, a world on each.
        agents: alive in a world, mean.
    """

    rate: float
    threads: int
    agents: float


def measure_speed(config: Config, threads: int) -> Speed:
    """Times one window of worlds of a setting, each on a thread of its own; takes seconds.

    Everybody is there from the first step, learns at the end, and nobody is born meanwhile.

    Args:
        config: the setting.
        threads: to be used in the end.
    """
    worlds = min(threads, MOST_WORLDS)
    count = min(TYPICAL_ALIVE, config.population.capacity)
    population, birth = replace(config.population, initial_count=count), replace(config.birth, kappa=0.0)
    peopled = replace(config, population=population, birth=birth)
    simulation = Simulation(peopled, range(1, worlds + 1), worlds)
    window = config.learning.rollout_steps
    simulation.run(1)  # the first touch of all memory
    begun = time.perf_counter()
    simulation.run(window)
    seconds = time.perf_counter() - begun
    agents = sum(world.alive for world in simulation.worlds) / worlds
    return Speed(threads * window / seconds, threads, agents)
