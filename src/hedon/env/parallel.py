"""One world as an environment of PettingZoo's Parallel API, whose agents appear and vanish."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from hedon.config.config import Config
from hedon.env.batch import Batch, batch
from hedon.env.group import ACTIONS, NOBODY, Group
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_STEPS, integer
from hedon.text import brief

Values = dict[str, NDArray[np.float32]]


class World(ParallelEnv[str, Any, Any]):
    """A world whose agents the caller drives. An agent's name is its species and its id: `agent_17`.

    A newborn comes into `agents` with its first observation and a reward of 0. Who dies is told so once, by
    `terminations`, with its last reward and an observation of zeros, and is gone. Agents of species that are not
    driven live in the same world by themselves and are not shown. There is no list of possible agents: nobody knows
    who will be born.

    Args:
        config: Settings of the world.
        species: As for `hedon.env.batch`.
        seed: Seed of the world until `reset` is given one.
        max_steps: Steps after which all agents are truncated; 0 for no end but extinction.
        threads: As in `hedon.Simulation`; one world of usual size is fastest on one.
    """

    def __init__(
        self,
        config: Config,
        species: str | Sequence[str] | None = None,
        seed: int = 0,
        max_steps: int = 0,
        threads: int = 1,
    ) -> None:
        self.metadata = {"name": "hedon_v0", "render_modes": [], "is_parallelizable": True}
        self.render_mode = None
        self.max_steps = integer("max_steps", max_steps, 0, MAX_STEPS)
        self._batch: Batch = batch(config, [seed], species, threads)
        self.agents: list[str] = []
        self._begun = False
        self._row: dict[str, tuple[Group, int]] = {}
        self._spaces: dict[str, tuple[Box, Box]] = {}

    @property
    def simulation(self) -> Any:
        """The world itself, for reading: `simulation.worlds[0]`."""
        return self._batch.simulation

    def observation_space(self, agent: str) -> Box:
        """Any numbers, one for each column that `Group.columns` names; the same object for the same agent."""
        return self._spaces_of(agent)[0]

    def action_space(self, agent: str) -> Box:
        """Two numbers before the sigmoid, left and right; samples are standard normals, as of a new network."""
        return self._spaces_of(agent)[1]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Values, dict[str, dict[str, Any]]]:
        """Begins again: with this seed, or with that of the last time.

        Args:
            seed: Of the new world; None for the same world again.
            options: None are known; PettingZoo has the argument.

        Returns:
            By the names of the founders: observations (entries,), and empty infos.
        """
        self._batch.reset(None if seed is None else [seed])
        self._spaces.clear()
        self._begun = True
        self._list_agents()
        return self._observations(), {name: {} for name in self.agents}

    def step(
        self, actions: Mapping[str, NDArray[np.float32]]
    ) -> tuple[Values, dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Advances by one step.

        Args:
            actions: (2,) for each agent that is told something new; the others go on as they were told last.

        Returns:
            By the names of all who lived before the step or live after it: observations (entries,), rewards,
            terminations, truncations, infos.

        Raises:
            ArgumentError: An action is for nobody alive, or is not two finite numbers, and then none is told; or there
                was no `reset`.
        """
        if not self._begun:
            raise ArgumentError("step: there are no agents yet: call reset first")
        if not self.agents:
            return {}, {}, {}, {}, {}
        self._tell(actions)
        before = dict(self._row)
        self._batch.step()
        rewards = {name: float(group.rewards[0, row]) for name, (group, row) in before.items()}
        self._list_agents()
        names = list(dict.fromkeys([*before, *self._row]))
        done = bool(self.max_steps) and self._batch.simulation.worlds[0].step >= self.max_steps
        observations = self._observations()
        for name in before.keys() - self._row.keys():
            observations[name] = np.zeros(len(before[name][0].columns), np.float32)
        result = (
            observations,
            {name: rewards.get(name, 0.0) for name in names},
            {name: name not in self._row for name in names},
            {name: done and name in self._row for name in names},
            {name: {} for name in names},
        )
        if done:
            self.agents = []
        for name in before.keys() - self._row.keys():
            self._spaces.pop(name, None)
        return result

    def _tell(self, actions: Any) -> None:
        """Writes the actions into the arrays: all of them, or none where one is wrong."""
        if not isinstance(actions, Mapping):
            raise ArgumentError(
                f"actions = {brief(repr(actions))}: must be a dict of two numbers for each agent, {{}} for none"
            )
        given = {name: self._action(name, action) for name, action in actions.items()}
        for name, action in given.items():
            group, row = self._row[name]
            group.actions[0, row] = action

    def _action(self, name: Any, action: Any) -> NDArray[np.float32]:
        if name not in self._row:
            raise ArgumentError(f"actions: no agent {brief(str(name))!r} is alive")
        try:
            with np.errstate(over="ignore"):
                array = np.ma.asanyarray(action) if np.ma.isMaskedArray(action) else np.asarray(action)
                given = np.asarray(array, np.float32) if array.dtype.kind in "fiu" else np.empty(0, np.float32)
        except (TypeError, ValueError):
            array = given = np.empty(0, np.float32)
        if given.shape != (len(ACTIONS),) or not np.isfinite(given).all() or np.ma.is_masked(array):
            said = brief(" ".join(str(action).split()))
            raise ArgumentError(f"actions[{name!r}] = {said}: must be two finite numbers, left and right")
        return given

    def _list_agents(self) -> None:
        living = [
            (int(group.ids[0, row]), species, group, int(row))
            for species, group in self._batch.groups.items()
            for row in np.flatnonzero(group.ids[0] != NOBODY)
        ]
        living.sort(key=lambda each: each[0])
        self._row = {f"{species}_{identity}": (group, row) for identity, species, group, row in living}
        self.agents = list(self._row)

    def _observations(self) -> Values:
        return {name: group.observations[0, row].copy() for name, (group, row) in self._row.items()}

    def _spaces_of(self, agent: str) -> tuple[Box, Box]:
        if agent not in self._spaces:
            species, _, identity = str(agent).rpartition("_")
            if species not in self._batch.groups or not (identity.isascii() and identity.isdigit()):
                raise ArgumentError(f"agent {brief(str(agent))!r}: there is no such agent")
            entries = len(self._batch.groups[species].columns)
            # So that two worlds with one seed draw the same actions, also for those who are born in them.
            seed = [self._batch.simulation.seeds[0], int(identity)]
            seeds = np.random.SeedSequence(seed).generate_state(2)
            self._spaces[agent] = (
                Box(-np.inf, np.inf, (entries,), np.float32, seed=int(seeds[0])),
                Box(-np.inf, np.inf, (len(ACTIONS),), np.float32, seed=int(seeds[1])),
            )
        return self._spaces[agent]


def parallel_env(
    config: Config,
    species: str | Sequence[str] | None = None,
    seed: int = 0,
    max_steps: int = 0,
    threads: int = 1,
) -> World:
    """Makes a world with PettingZoo's Parallel API.

    Args:
        config: As for `World`, like all that follow.
        species: Whose agents the caller drives.
        seed: Of the world until `reset` is given one.
        max_steps: Steps after which all agents are truncated; 0 for no end but extinction.
        threads: Changes no result.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
    """
    return World(config, species, seed, max_steps, threads)
