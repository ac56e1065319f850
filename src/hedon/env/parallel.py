"""One world as an environment of PettingZoo's Parallel API, whose agents appear and vanish, or are its slots."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pettingzoo
from gymnasium.spaces import Box
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.copied import Copied
from hedon.env.argument import options_of
from hedon.env.group import ACTIONS, Form, Group
from hedon.env.make import make
from hedon.env.vector import RENDER_MODES, VectorEnv
from hedon.error import ArgumentError
from hedon.text import brief

Values = dict[str, NDArray[np.float32]]


class ParallelEnv(Copied, pettingzoo.ParallelEnv[str, Any, Any]):
    """A world whose agents the caller drives. An agent's name is its species and its id: `agent_17`.

    A newborn comes into `agents` with its first observation and a reward of 0. An agent that dies
    appears once more, in `terminations`, with its last reward and an observation of zeros, and is gone. Agents of
    species that are not driven live in the same world by themselves and are not shown. There is no list of possible
    agents: nobody knows who will be born.

    Libraries that want such a list, as SuperSuit does, get slots for agents: `agent_slot_3` stands for all who live in
    a slot, is there from the beginning to the end, and observes zeros and earns 0 while it is empty. Its info says
    whether someone lives there now (`alive`), and whether someone has died (`died`) or was born (`born`) there in the
    step. All terminate when nobody is left.

    Args:
        config: Settings of the world, as for `hedon.make`, like all that follow but `slots`.
        species: Whose agents the caller drives.
        seed: Of the first world; None for one drawn by chance.
        actions: What their numbers are.
        repeat: Steps of the world in one step.
        max_steps: Steps after which all agents are truncated; 0 for no end but extinction.
        slots: Whether slots are the agents.
        render_mode: What `render` gives.
        threads: One world of usual size is fastest on one.
        record: Folder for the records of its worlds, one run for each that begins; call `close` at the end.
        frames: Steps of the world between two frames of the records; 0 for none.
        overrides: Settings that differ from those of the preset or file.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
    """

    def __init__(
        self,
        config: Config | str | Path,
        species: str | Sequence[str] | None = None,
        seed: int | None = None,
        actions: Form = "unit",
        repeat: int = 1,
        max_steps: int = 0,
        slots: bool = False,
        render_mode: str | None = None,
        threads: int = 1,
        record: Path | str | None = None,
        frames: int = 0,
        overrides: Iterable[str] = (),
    ) -> None:
        self.metadata = {"name": "hedon_v1", "render_modes": list(RENDER_MODES), "is_parallelizable": True}
        self._vector: VectorEnv = make(
            config,
            1,
            seed,
            species,
            actions,
            repeat,
            max_steps,
            render_mode,
            threads,
            record=record,
            frames=frames,
            overrides=overrides,
        )
        self.render_mode = render_mode
        self.agents: list[str] = []
        self._begun, self._slots = False, slots
        self._row: dict[str, tuple[Group, int]] = {}
        self._spaces: dict[str, tuple[Box, Box]] = {}
        if slots:
            self._row = {
                f"{name}_slot_{row}": (group, row)
                for name, group in self._vector.groups.items()
                for row in range(group.ids.shape[1])
            }
            self.possible_agents = list(self._row)

    @property
    def simulation(self) -> Any:
        """The world itself, for reading: `simulation.worlds[0]`."""
        return self._vector.simulation

    def observation_space(self, agent: str) -> Box:
        """What an agent can observe, an entry for each column that `Group.columns` names; the same object each time."""
        return self._spaces_of(agent)[0]

    def action_space(self, agent: str) -> Box:
        """What an agent can do: two numbers, left and right; the same object each time."""
        return self._spaces_of(agent)[1]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Values, dict[str, dict[str, Any]]]:
        """Begins again.

        Returns:
            By the names of the founders: observations (entries,), and infos.

        Raises:
            ArgumentError: A seed is wrong, or `options` is no dictionary.
        """
        options_of(options)
        self._vector.reset(None if seed is None else [seed])
        self._spaces.clear()
        self._begun = True
        self._list_agents()
        return self._observations(), {name: self._info(name) for name in self.agents}

    def step(
        self, actions: Mapping[str, NDArray[np.float32]]
    ) -> tuple[Values, dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Advances by one step.

        Returns:
            By the names of all who lived before the step or live after it: observations (entries,), rewards,
            terminations, truncations, infos.

        Raises:
            ArgumentError: An action is for nobody alive, or is not two numbers that it can be, and then none is told;
                or there was no `reset`.
        """
        if not self._begun:
            raise ArgumentError("step: there are no agents yet: call reset first")
        if not self.agents:
            return {}, {}, {}, {}, {}
        self._tell(actions)
        before = dict(self._row)
        groups = self._vector.groups
        self._vector.step(self._vector.actions)
        rewards = {name: float(group.rewards[0, row]) for name, (group, row) in before.items()}
        self._list_agents()
        names = list(dict.fromkeys([*before, *self._row]))
        gone = before.keys() - self._row.keys()
        over = self._slots and not any(group.alive.any() for group in groups.values())
        done = any(group.truncated.any() for group in groups.values())
        observations = self._observations()
        for name in gone:
            observations[name] = np.zeros(len(before[name][0].columns), np.float32)
        result = (
            observations,
            {name: rewards.get(name, 0.0) for name in names},
            {name: over or name in gone for name in names},
            {name: done and name not in gone for name in names},
            {name: self._info(name) for name in names},
        )
        if done or over:
            self.agents = []
        for name in gone:
            self._spaces.pop(name, None)
        return result

    def render(self) -> Any:
        """A picture of the world: see `VectorEnv.render`."""
        return self._vector.render()

    def close(self) -> None:
        """Ends the records and closes the window, if there are any."""
        self._vector.close()

    def __getstate__(self) -> dict[str, Any]:
        rows = {name: (self._species_of(group), row) for name, (group, row) in self._row.items()}
        return self.__dict__ | {"_row": rows, "agents": list(self.agents), "_spaces": dict(self._spaces)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._row = {name: (self._vector.groups[own], row) for name, (own, row) in state["_row"].items()}

    def _species_of(self, group: Group) -> str:
        return next(name for name, each in self._vector.groups.items() if each is group)

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
        group = self._row[name][0]
        good = given.shape == (len(ACTIONS),) and np.isfinite(given).all() and not np.ma.is_masked(array)
        if not good or not ((given >= group.low) & (given <= group.high)).all():
            said = brief(" ".join(str(action).split()))
            within = "" if group.open else f", from {group.low:g} to {group.high:g}"
            raise ArgumentError(f"actions[{name!r}] = {said}: must be two finite numbers, left and right{within}")
        return given

    def _list_agents(self) -> None:
        if not self._slots:
            living = [
                (int(group.ids[0, row]), species, group, int(row))
                for species, group in self._vector.groups.items()
                for row in np.flatnonzero(group.alive[0])
            ]
            living.sort(key=lambda each: each[0])
            self._row = {f"{species}_{identity}": (group, row) for identity, species, group, row in living}
        self.agents = list(self._row)

    def _info(self, name: str) -> dict[str, Any]:
        if not self._slots:
            return {}
        group, row = self._row[name]
        told = {"alive": group.alive, "died": group.terminated, "born": group.born}
        return {what: bool(array[0, row]) for what, array in told.items()}

    def _observations(self) -> Values:
        return {name: group.observations[0, row].copy() for name, (group, row) in self._row.items()}

    def _spaces_of(self, agent: str) -> tuple[Box, Box]:
        if agent not in self._spaces:
            species, _, number = str(agent).rpartition("_slot_" if self._slots else "_")
            digits = number.isascii() and number.isdigit()
            if species not in self._vector.groups or not digits or (self._slots and agent not in self._row):
                raise ArgumentError(f"agent {brief(str(agent))!r}: there is no such agent")
            # So that two worlds with one seed draw the same actions, also for those who are born in them.
            seeds = np.random.SeedSequence([self._vector.simulation.seeds[0], int(number)]).generate_state(2)
            spaces = self._vector.spaces
            observed = spaces.box_of(species)
            observed.seed(int(seeds[0]))
            self._spaces[agent] = (observed, spaces.action_box(species, seed=int(seeds[1])))
        return self._spaces[agent]
