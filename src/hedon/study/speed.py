"""Estimates how long runs take on this machine, from a measurement with worlds as populated as in mid-run."""

import time
from dataclasses import dataclass

from hedon.config import Config
from hedon.experiment.simulation import Simulation

TYPICAL_ALIVE = 150
"""Number of agents in a typical world; a new world has too few for an estimate."""
MOST_WORLDS = 16
"""Largest number of worlds measured at the same time; further threads are assumed to be equally fast."""


@dataclass(frozen=True)
class Speed:
    """The speed of a machine.

    Attributes:
        rate: Steps of all worlds together [world-steps/s].
        threads: Number of threads for which the rate holds, with one world on each.
        agents: Mean number of agents alive in a world.
    """

    rate: float
    threads: int
    agents: float


def measure_speed(config: Config, threads: int) -> Speed:
    """Measures the time for one window of worlds of a condition, each on its own thread; this takes seconds.

    All agents exist from the first step and learn at the end; none are born in between.
    """
    worlds = min(threads, MOST_WORLDS)
    count = min(TYPICAL_ALIVE, *(species.population.capacity for species in config.species.values()))
    populated = config.with_("population.initial_count", count).with_("birth.kappa", 0.0)
    simulation = Simulation(populated, range(1, worlds + 1), worlds)
    window = config.world.rollout_steps
    simulation.run(1)  # so that all memory has been touched before the measurement
    started = time.perf_counter()
    simulation.run(window)
    seconds = time.perf_counter() - started
    agents = sum(world.alive for world in simulation.worlds) / worlds
    return Speed(threads * window / seconds, threads, agents)
