"""Estimates how long runs take on this machine, measured with worlds as they are in the middle of a run."""

import time
from dataclasses import dataclass

from hedon.config import Config
from hedon.experiment.simulation import Simulation

TYPICAL_ALIVE = 150
"""Agents of a typical world; a new one has too few for an estimate."""
MOST_WORLDS = 16
"""Most worlds that are measured at the same time; further threads are assumed to be as fast as these."""


@dataclass(frozen=True)
class Speed:
    """How fast a machine is.

    Attributes:
        rate: steps of all worlds together [world-steps/s].
        threads: number of threads that the rate is for, with one world on each.
        agents: mean number alive in a world.
    """

    rate: float
    threads: int
    agents: float


def measure_speed(config: Config, threads: int) -> Speed:
    """Times one window of worlds of a setting, each on its own thread; takes seconds.

    All agents are there from the first step and learn at the end; no agent is born in between.
    """
    worlds = min(threads, MOST_WORLDS)
    count = min(TYPICAL_ALIVE, *(own.population.capacity for own in config.species.values()))
    peopled = config.with_("population.initial_count", count).with_("birth.kappa", 0.0)
    simulation = Simulation(peopled, range(1, worlds + 1), worlds)
    window = config.world.rollout_steps
    simulation.run(1)  # touches all memory for the first time
    begun = time.perf_counter()
    simulation.run(window)
    seconds = time.perf_counter() - begun
    agents = sum(world.alive for world in simulation.worlds) / worlds
    return Speed(threads * window / seconds, threads, agents)
