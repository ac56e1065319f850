"""One world under PettingZoo's Parallel API, in which agents appear and disappear, or slots stand for agents."""

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

    A newborn enters `agents` with its first observation and a reward of 0. An agent that dies appears once more, in
    `terminations`, with its last reward and an observation of zeros, and is then removed. Agents of species that are
    not driven live in the same world by themselves and are not shown. There is no list of possible agents, because
    births cannot be foreseen.

    Libraries that require such a list, such as SuperSuit, can use slots as agents: `agent_slot_3` stands for all agents
    that live in a slot, exists from start to end, and observes zeros and earns 0 while the slot is empty. Its info
    tells whether an agent lives there now (`alive`), and whether one died (`died`) or was born (`born`) there in the
    step. All slots terminate when no agent is left.

    Args:
        config: Settings of the world. This argument and all others except `slots` work as in `hedon.make`.
        species: Species whose agents the caller drives.
        seed: Seed of the first world; None for a random one.
        actions: Meaning of the numbers in an action.
        repeat: World steps per environment step.
        max_steps: Steps after which all agents are truncated; 0 for no limit except extinction.
        slots: Whether slots stand for agents.
        render_mode: What `render` produces.
        threads: Number of threads; a world of usual size is fastest with one.
        record: Folder for the records, one run for each world that starts; call `close` at the end.
        frames: World steps between two recorded frames; 0 for none.
        overrides: Settings that replace those of the preset or file.

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
        """The underlying world, for reading only: `simulation.worlds[0]`."""
        return self._vector.simulation

    def observation_space(self, agent: str) -> Box:
        """Space of an agent's observations, with an entry per column in `Group.columns`; the same object each time."""
        return self._spaces_of(agent)[0]

    def action_space(self, agent: str) -> Box:
        """Space of an agent's actions: two numbers, left and right; the same object each time."""
        return self._spaces_of(agent)[1]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Values, dict[str, dict[str, Any]]]:
        """Starts a new world.

        Returns:
            Observations (entries,) and infos, by the names of the founders.

        Raises:
            ArgumentError: The seed is wrong, or `options` is not a dictionary.
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
        """Advances the world by `repeat` steps.

        Returns:
            Observations (entries,), rewards, terminations, truncations and infos, by the names of all agents alive
            before or after the step.

        Raises:
            ArgumentError: An action is for no living agent or is not two valid numbers, in which case no action is set;
                or `reset` was not called.
        """
        if not self._begun:
            raise ArgumentError("step: there are no agents yet: call reset first")
        if not self.agents:
            return {}, {}, {}, {}, {}
        self._tell(actions)
        rows_before = dict(self._row)
        groups = self._vector.groups
        self._vector.step(self._vector.actions)
        rewards = {name: float(group.rewards[0, row]) for name, (group, row) in rows_before.items()}
        self._list_agents()
        names = list(dict.fromkeys([*rows_before, *self._row]))
        departed = rows_before.keys() - self._row.keys()
        extinct = self._slots and not any(group.alive.any() for group in groups.values())
        truncated = any(group.truncated.any() for group in groups.values())
        observations = self._observations()
        for name in departed:
            observations[name] = np.zeros(len(rows_before[name][0].columns), np.float32)
        result = (
            observations,
            {name: rewards.get(name, 0.0) for name in names},
            {name: extinct or name in departed for name in names},
            {name: truncated and name not in departed for name in names},
            {name: self._info(name) for name in names},
        )
        if truncated or extinct:
            self.agents = []
        for name in departed:
            self._spaces.pop(name, None)
        return result

    def render(self) -> Any:
        """Draws the world: see `VectorEnv.render`."""
        return self._vector.render()

    def close(self) -> None:
        """Finishes the records and closes the window, if there are any."""
        self._vector.close()

    def __getstate__(self) -> dict[str, Any]:
        rows = {name: (self._species_of(group), row) for name, (group, row) in self._row.items()}
        return self.__dict__ | {"_row": rows, "agents": list(self.agents), "_spaces": dict(self._spaces)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._row = {name: (self._vector.groups[species], row) for name, (species, row) in state["_row"].items()}

    def _species_of(self, group: Group) -> str:
        return next(name for name, candidate in self._vector.groups.items() if candidate is group)

    def _tell(self, actions: Any) -> None:
        """Writes the actions into the arrays, or none of them if one is wrong."""
        if not isinstance(actions, Mapping):
            raise ArgumentError(
                f"actions = {brief(repr(actions))}: must be a dict of two numbers for each agent, {{}} for none"
            )
        action_by_agent = {name: self._action(name, action) for name, action in actions.items()}
        for name, action in action_by_agent.items():
            group, row = self._row[name]
            group.actions[0, row] = action

    def _action(self, name: Any, action: Any) -> NDArray[np.float32]:
        if name not in self._row:
            raise ArgumentError(f"actions: no agent {brief(str(name))!r} is alive")
        try:
            with np.errstate(over="ignore"):
                array = np.ma.asanyarray(action) if np.ma.isMaskedArray(action) else np.asarray(action)
                values = np.asarray(array, np.float32) if array.dtype.kind in "fiu" else np.empty(0, np.float32)
        except (TypeError, ValueError):
            array = values = np.empty(0, np.float32)
        group = self._row[name][0]
        is_valid = values.shape == (len(ACTIONS),) and np.isfinite(values).all() and not np.ma.is_masked(array)
        if not is_valid or not ((values >= group.low) & (values <= group.high)).all():
            text = brief(" ".join(str(action).split()))
            range_text = "" if group.open else f", from {group.low:g} to {group.high:g}"
            raise ArgumentError(f"actions[{name!r}] = {text}: must be two finite numbers, left and right{range_text}")
        return values

    def _list_agents(self) -> None:
        if not self._slots:
            living = [
                (int(group.ids[0, row]), species, group, int(row))
                for species, group in self._vector.groups.items()
                for row in np.flatnonzero(group.alive[0])
            ]
            living.sort(key=lambda entry: entry[0])
            self._row = {f"{species}_{identity}": (group, row) for identity, species, group, row in living}
        self.agents = list(self._row)

    def _info(self, name: str) -> dict[str, Any]:
        if not self._slots:
            return {}
        group, row = self._row[name]
        flags = {"alive": group.alive, "died": group.terminated, "born": group.born}
        return {flag: bool(array[0, row]) for flag, array in flags.items()}

    def _observations(self) -> Values:
        return {name: group.observations[0, row].copy() for name, (group, row) in self._row.items()}

    def _spaces_of(self, agent: str) -> tuple[Box, Box]:
        if agent not in self._spaces:
            species, _, number = str(agent).rpartition("_slot_" if self._slots else "_")
            digits = number.isascii() and number.isdigit()
            if species not in self._vector.groups or not digits or (self._slots and agent not in self._row):
                raise ArgumentError(f"agent {brief(str(agent))!r}: there is no such agent")
            # Two worlds with the same seed draw the same actions, also for agents born in them.
            seeds = np.random.SeedSequence([self._vector.simulation.seeds[0], int(number)]).generate_state(2)
            spaces = self._vector.spaces
            observation_space = spaces.box_of(species)
            observation_space.seed(int(seeds[0]))
            self._spaces[agent] = (observation_space, spaces.action_box(species, seed=int(seeds[1])))
        return self._spaces[agent]
