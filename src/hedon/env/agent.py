"""The life of one agent as an environment of Gymnasium."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.copied import Copied
from hedon.env.argument import options_of
from hedon.env.group import Form, Group
from hedon.env.make import make
from hedon.env.vector import RENDER_MODES, VectorEnv
from hedon.error import ArgumentError, EngineError
from hedon.text import brief

Policy = Callable[[NDArray[np.float32]], NDArray[np.float32]]
"""From observations (agents, entries) to actions (agents, 2)."""


def one_group(worlds: VectorEnv) -> Group:
    """The agents of the only driven species. ArgumentError: there are several."""
    if len(worlds.groups) > 1:
        raise ArgumentError(f"species: must be one of {', '.join(worlds.groups)}, that of the agent")
    return next(iter(worlds.groups.values()))


def require_policy(others: Policy | None) -> Policy | None:
    """The policy of the others. ArgumentError: it is no function."""
    if others is not None and not callable(others):
        raise ArgumentError(f"others: must be a function from observations to actions, not {brief(repr(others))}")
    return others


def first_founder(group: Group, world: int) -> int:
    """The slot of the first founder of a world that has just begun. EngineError: there is none."""
    founders = np.flatnonzero(group.alive[world])
    if not len(founders):
        raise EngineError("the species has no founders: population.initial_count is 0")
    return int(founders[np.argmin(group.ids[world, founders])])


def answered(others: Policy, group: Group) -> NDArray[Any]:
    """What a policy answers for all agents, (worlds, slots, 2). ArgumentError: it is no table of actions."""
    shape = group.actions.shape
    answer = others(group.observations.reshape(-1, len(group.columns)))
    given = np.asarray(answer)
    table = (shape[0] * shape[1], shape[2])
    if given.shape != table or given.dtype.kind not in "fiu":
        said = f"{given.shape} {given.dtype}" if given.ndim else brief(repr(answer))
        raise ArgumentError(f"others: must return numbers of shape {table}, not {said}")
    given = given.reshape(shape)
    wrong = group.alive[..., None] & ~((given >= group.low) & (given <= group.high))
    if wrong.any():
        world, slot, motor = np.argwhere(wrong)[0]
        place = f"others: returned [{world * shape[1] + slot}, {motor}] = {given[world, slot, motor]}"
        raise ArgumentError(f"{place}: must be from {group.low:g} to {group.high:g}")
    return given.astype(np.float32)


class AgentEnv(Copied, gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """One agent among others: an episode is its life, from the beginning of a world to its death.

    The agent is the first founder of its species. Other species act by their `learning.policy`. Others of the same
    species act by `others`, since one species has one policy; give the agent a species of its own with a capacity of 1,
    and all others act and learn by themselves (docs/guide/environment.md).

    Args:
        config: Settings of the world, as for `hedon.make`, like all that follow but `others`.
        species: Of the agent: one name; None for the only one whose policy is `external`, or the only one.
        seed: Of the first world; None for one drawn by chance.
        actions: What their numbers are.
        repeat: Steps of the world in one step.
        max_steps: Steps of the world after which the episode is truncated.
        others: Acts for the others of the species, from observations (slots, entries) to actions (slots, 2);
            None to leave their motors in the middle of their range.
        render_mode: What `render` gives.
        threads: One world of usual size is fastest on one.
        record: Folder for the records of its worlds, one run for each that begins; call `close` at the end.
        frames: Steps of the world between two frames of the records; 0 for none.
        overrides: Settings that differ from those of the preset or file.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
    """

    metadata = {"render_modes": list(RENDER_MODES), "render_fps": 30}  # noqa: RUF012  # as Gymnasium declares it

    def __init__(
        self,
        config: Config | str | Path,
        species: str | None = None,
        seed: int | None = None,
        actions: Form = "unit",
        repeat: int = 1,
        max_steps: int = 0,
        others: Policy | None = None,
        render_mode: str | None = None,
        threads: int = 1,
        record: Path | str | None = None,
        frames: int = 0,
        overrides: Iterable[str] = (),
    ) -> None:
        self._vector = make(
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
        self._group = one_group(self._vector)
        self._others = require_policy(others)
        self._slot = -1
        self.render_mode = render_mode
        self.observation_space = self._vector.single_observation_space
        self.action_space = self._vector.single_action_space

    @property
    def simulation(self) -> Any:
        """The world itself, for reading: `simulation.worlds[0]`."""
        return self._vector.simulation

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins a new world and a new life.

        Returns:
            The observation (entries,), and the id and the slot of the agent.

        Raises:
            ArgumentError: A seed is wrong, or `options` is no dictionary.
            EngineError: No agent of the species is there when the world begins.
        """
        options_of(options)
        super().reset(seed=seed)
        self._vector.reset(None if seed is None else [seed])
        self._slot = first_founder(self._group, 0)
        return self._seen(), self._info()

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Advances the world by `repeat` steps.

        Returns:
            The observation (entries,), zeros after death; what the agent was paid, whether it has died, whether its
            time is over, and its id and slot.

        Raises:
            ArgumentError: The action is not two numbers that it can be, or `others` answered none; or there was no
                `reset`.
        """
        group, slot = self._group, self._slot
        if slot < 0:
            raise ArgumentError("step: there is no agent: call reset first")
        given = np.asarray(action)
        if given.shape != (2,) or given.dtype.kind not in "fiu":
            raise ArgumentError("action: must be two numbers, left and right")
        # A copy, so that an action that is refused leaves none behind.
        actions = group.actions.copy() if self._others is None else answered(self._others, group)
        actions[0, slot] = given
        self._vector.step(actions)
        died = bool(group.terminated[0, slot])
        seen = np.zeros(len(group.columns), np.float32) if died else self._seen()
        cut = bool(group.truncated[0, slot]) and not died
        told = seen, float(group.rewards[0, slot]), died, cut, self._info()
        if died:
            self._slot = -1
        return told

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_group"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._group = one_group(self._vector)

    def render(self) -> Any:
        """A picture of the world: see `VectorEnv.render`."""
        return self._vector.render()

    def close(self) -> None:
        """Ends the records and closes the window, if there are any."""
        self._vector.close()

    def _seen(self) -> NDArray[np.float32]:
        return self._group.observations[0, self._slot].copy()

    def _info(self) -> dict[str, Any]:
        return {"agent_id": int(self._group.ids_before[0, self._slot]), "slot": self._slot}
