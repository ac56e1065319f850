"""Many worlds as arrays: a caller writes actions into one array and reads observations and rewards from others.

No step makes or copies an array: the engine reads and writes those that the groups of agents hold.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.layout import observation_columns
from hedon.config.problem import nearest
from hedon.config.species import ONLY, SpeciesConfig
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_STEPS, integer
from hedon.experiment.simulation import Simulation
from hedon.text import brief

ACTIONS = ("left", "right")
"""The two motors, in the order of the columns of `actions`."""
NOBODY = -1
"""In arrays of ids, where no agent lives."""


class Group:
    """The agents of one species in all worlds: a row for each slot, in which agents live one after another.

    Each array is allocated once. `observations.reshape(-1, entries)` is all agents as one table, without a copy.

    Attributes:
        columns: Names of the entries of an observation.
        actions: (worlds, slots, 2) float32, before the sigmoid: write here. 0 is the middle of the motors' range,
            and what a newborn does until told otherwise; rows without an agent change nothing.
        observations: (worlds, slots, entries) float32, as a network of the engine reads them; zeros where nobody
            lives.
        rewards: (worlds, slots) float32, what the agent that was in the slot before the step was paid by its own
            genome; 0 where there was none.
        ids: (worlds, slots) int32, the agent in each slot; -1 where nobody lives. No id is used again in a world.
        ids_before: the same before the last step.
    """

    def __init__(self, index: int, columns: tuple[str, ...], worlds: int, slots: int) -> None:
        self.columns = columns
        self.actions: NDArray[np.float32] = np.zeros((worlds, slots, len(ACTIONS)), np.float32)
        self.observations: NDArray[np.float32] = np.zeros((worlds, slots, len(columns)), np.float32)
        self.rewards: NDArray[np.float32] = np.zeros((worlds, slots), np.float32)
        self.ids: NDArray[np.int32] = np.full((worlds, slots), NOBODY, np.int32)
        self.ids_before = self.ids.copy()
        self._index = index

    @property
    def alive(self) -> NDArray[np.bool_]:
        """(worlds, slots) whether an agent lives there now."""
        return self.ids != NOBODY

    @property
    def died(self) -> NDArray[np.bool_]:
        """(worlds, slots) whether the agent that was there before the last step died in it."""
        return (self.ids_before != NOBODY) & (self.ids_before != self.ids)

    @property
    def born(self) -> NDArray[np.bool_]:
        """(worlds, slots) whether the agent that lives there now was born in the last step."""
        return (self.ids != NOBODY) & (self.ids_before != self.ids)

    def _tell(self, engine: Any) -> None:
        shape = (*self.ids.shape, len(ACTIONS))
        given: Any = self.actions
        good = isinstance(given, np.ndarray) and given.shape == shape and given.dtype == np.float32
        if not good or not given.flags.c_contiguous:
            raise ArgumentError(
                f"actions: must be the array of {shape} float32 that was there: write into it, actions[...] = …"
            )
        if not np.isfinite(self.actions).all():
            world, slot, motor = np.argwhere(~np.isfinite(self.actions))[0]
            place = f"actions[{world}, {slot}, {motor}] ({ACTIONS[motor]})"
            raise ArgumentError(f"{place} = {self.actions[world, slot, motor]}: must be a finite number")
        engine.command(self._index, self.actions)

    def _look(self, engine: Any) -> None:
        np.copyto(self.ids_before, self.ids)
        engine.show(self._index, self.observations, self.rewards, self.ids)
        if not np.array_equal(self.ids, self.ids_before):
            self.actions[self.born] = 0.0

    def _forget(self) -> None:
        for array in (self.actions, self.observations, self.rewards):
            array.fill(0)
        self.ids.fill(NOBODY)


class Batch:
    """Worlds whose agents, all or those of some species, are driven by the caller; the others learn by themselves.

    Example:
        >>> import hedon, hedon.env
        >>> worlds = hedon.env.batch(hedon.load_config("baseline"), seeds=[1, 2])
        >>> agents = worlds.groups["agent"]
        >>> agents.actions[...] = 0.5  # or a policy of agents.observations
        >>> worlds.step()
        >>> agents.rewards[agents.alive].mean()

    Attributes:
        config: The config, with the policy `external` for the species that are driven.
        groups: The driven agents, by the name of their species.
        simulation: The worlds themselves, to be read between steps; `reset` makes a new one.
    """

    def __init__(
        self, config: Config, seeds: Sequence[int], species: str | Sequence[str] | None, threads: int, kernel: str
    ) -> None:
        names = driven(config, species)
        self.config = with_callers(config, names)
        self._threads, self._kernel = threads, kernel
        self.simulation = Simulation(self.config, seeds, threads, kernel)
        self.groups = {
            name: Group(
                list(config.agents).index(name),
                observation_columns(config, name),
                len(self.simulation.seeds),
                config.agents[name].population.capacity,
            )
            for name in names
        }
        self._look()

    def reset(self, seeds: Sequence[int] | None = None) -> None:
        """Begins again, with the same seeds or with as many others. The groups keep their arrays.

        Raises:
            ArgumentError: There are more or fewer seeds than worlds, or one is out of bounds.
        """
        wanted = self.simulation.seeds if seeds is None else seeds
        if len(wanted) != len(self.simulation.seeds):
            raise ArgumentError(f"seeds: there must be {len(self.simulation.seeds)}, one per world, not {len(wanted)}")
        self.simulation = Simulation(self.config, wanted, self._threads, self._kernel)
        for group in self.groups.values():
            group._forget()
        self._look()

    def step(self, repeat: int = 1) -> None:
        """Advances every world, with the actions that the groups hold; then the arrays are of the new step.

        Args:
            repeat: Steps with the same actions. Rewards, and who was born or died, are those of the last of them.

        Raises:
            ArgumentError: An action is not a finite number, or `repeat` is not a positive whole number.
            EngineError: A world reports an error.
        """
        steps = integer("repeat", repeat, 1, MAX_STEPS)
        for group in self.groups.values():
            group._tell(self.simulation.engine)
        if steps > 1:
            self.simulation.run(steps - 1)
            self._look()
        self.simulation.run(1)
        self._look()

    def __getstate__(self) -> Any:
        raise TypeError("worlds that are driven cannot be copied or pickled: make a new one from its config")

    def _look(self) -> None:
        for group in self.groups.values():
            group._look(self.simulation.engine)


def batch(
    config: Config,
    seeds: Sequence[int],
    species: str | Sequence[str] | None = None,
    threads: int = 0,
    kernel: str = "",
) -> Batch:
    """Worlds that a program drives, as arrays.

    Args:
        config: Settings of the worlds.
        seeds: One world per seed, each in [0, 2^64).
        species: Whose agents the caller drives: a name, several, or by default those whose policy is `external`, or
            all where there are none. A config without `[species]` has the species `agent`.
        threads: As in `hedon.Simulation`; changes no result.
        kernel: As in `hedon.Simulation`.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        EngineError: As in `hedon.Simulation`.
    """
    return Batch(config, seeds, species, threads, kernel)


def driven(config: Config, species: str | Sequence[str] | None) -> tuple[str, ...]:
    """The names of the species that the caller drives.

    Raises:
        ArgumentError: There is no such species.
    """
    if not isinstance(config, Config):
        raise ArgumentError(f"config: must be a Config, as load_config gives it, not {brief(repr(config))}")
    known = list(config.agents)
    if species is None:
        external = [name for name, each in config.agents.items() if each.learning.policy == "external"]
        return tuple(external or known)
    wanted = [species] if isinstance(species, str) else list(species)
    for name in wanted:
        if name not in known:
            near = nearest(name, known) if isinstance(name, str) else None
            hint = f"; did you mean {near}?" if near else ""
            there = ", ".join(known)
            raise ArgumentError(f"species {brief(str(name))!r}: there is no such species (there are {there}){hint}")
    if not wanted:
        raise ArgumentError("species: there must be at least one")
    return tuple(name for name in known if name in wanted)


def with_callers(config: Config, names: Sequence[str]) -> Config:
    """The config with the policy `external` for these species."""

    def external(species: SpeciesConfig) -> SpeciesConfig:
        return replace(species, learning=replace(species.learning, policy="external"))

    if not config.species:
        return replace(config, learning=external(config.agents[ONLY]).learning)
    return replace(
        config, species={name: external(each) if name in names else each for name, each in config.species.items()}
    )
