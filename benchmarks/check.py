"""Checks that what was measured gave a correct result; otherwise its time is not printed."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from hedon.experiment.simulation import Simulation
from hedon.experiment.world import World

CHECKED_ROWS = 1000
"""Networks that are checked at a time, since each check copies them."""


class CheckError(Exception):
    """A measurement with a wrong result: a fault of hedon or of the machine, not of the user."""


def require(holds: bool, what: str) -> None:
    """Raises an error if a condition is false.

    Args:
        holds: The condition.
        what: What is wrong if it is false, as a sentence without a period.

    Raises:
        CheckError: The condition is false.
    """
    if not holds:
        raise CheckError(what)


def require_finite(what: str, *arrays: ArrayLike) -> None:
    """Raises an error if a number is infinite or NaN.

    Raises:
        CheckError: A number is not finite.
    """
    require(all(np.isfinite(array).all() for array in arrays), f"{what}: not all numbers are finite")


def check_world(world: World) -> None:
    """Raises an error unless agents are alive in a world, are inside its walls, and all numbers are finite.

    Raises:
        CheckError: It names the seed and what is wrong.
    """
    name = f"the world of seed {world.seed} at step {world.step}"
    require(not world.extinct, f"{name} has died out")
    agents, living, arena = world.agents(), world.living, world.config.arena
    require_finite(f"{name}, bodies", agents["x"], agents["y"], agents["angle"], agents["energy"])
    inside = (agents["x"] > 0) & (agents["x"] < arena.width) & (agents["y"] > 0) & (agents["y"] < arena.height)
    require(bool(inside.all()), f"{name} has {np.sum(~inside)} agents outside its walls")
    for array in ("params", "first_moment", "second_moment"):
        numbers = world.view(array)
        for some in np.array_split(living, len(living) // CHECKED_ROWS + 1):
            require_finite(f"{name}, {array}", numbers[some])


def check_same_lives(simulations: Iterable[Simulation]) -> None:
    """Raises an error if worlds with the same seed and instruction set differ; threads must not change them.

    Raises:
        CheckError: It names the seed, the instruction set and the numbers of threads.
    """
    seen: dict[tuple[str, int], tuple[str, int]] = {}
    for simulation in simulations:
        for world in simulation.worlds:
            key = (simulation.engine.backend, world.seed)
            digest, threads = seen.setdefault(key, (world.digest(), simulation.engine.threads))
            require(
                digest == world.digest(),
                f"the world of seed {world.seed} on {key[0]} differs between {threads} and "
                f"{simulation.engine.threads} threads",
            )
