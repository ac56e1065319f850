"""The life of one agent as a Gymnasium environment."""

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
"""Maps observations (agents, entries) to actions (agents, 2)."""


def one_group(worlds: VectorEnv) -> Group:
    """The agents of the only driven species. Raises ArgumentError if there are several."""
    if len(worlds.groups) > 1:
        raise ArgumentError(f"species: must be one of {', '.join(worlds.groups)}, that of the agent")
    return next(iter(worlds.groups.values()))


def require_policy(others: Policy | None) -> Policy | None:
    """Returns the policy of the other agents. Raises ArgumentError if it is not callable."""
    if others is not None and not callable(others):
        raise ArgumentError(f"others: must be a function from observations to actions, not {brief(repr(others))}")
    return others


def first_founder(group: Group, world: int) -> int:
    """Slot of the first founder of a new world. Raises EngineError if there is none."""
    founders = np.flatnonzero(group.alive[world])
    if not len(founders):
        raise EngineError("the species has no founders: population.initial_count is 0")
    return int(founders[np.argmin(group.ids[world, founders])])


def answered(others: Policy, group: Group) -> NDArray[Any]:
    """A policy's actions for all agents, (worlds, slots, 2). Raises ArgumentError if they form no table of actions."""
    shape = group.actions.shape
    answer = others(group.observations.reshape(-1, len(group.columns)))
    actions = np.asarray(answer)
    table = (shape[0] * shape[1], shape[2])
    if actions.shape != table or actions.dtype.kind not in "fiu":
        description = f"{actions.shape} {actions.dtype}" if actions.ndim else brief(repr(answer))
        raise ArgumentError(f"others: must return numbers of shape {table}, not {description}")
    actions = actions.reshape(shape)
    is_invalid = group.alive[..., None] & ~((actions >= group.low) & (actions <= group.high))
    if is_invalid.any():
        world, slot, motor = np.argwhere(is_invalid)[0]
        place = f"others: returned [{world * shape[1] + slot}, {motor}] = {actions[world, slot, motor]}"
        raise ArgumentError(f"{place}: must be from {group.low:g} to {group.high:g}")
    return actions.astype(np.float32)


class AgentEnv(Copied, gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """One agent among others: an episode is its life, from the start of a world to its death.

    The agent is the first founder of its species. Other species act according to their `learning.policy`. The other
    agents of its species act according to `others`, since a species has one policy. To let all others act and learn by
    themselves, give the agent its own species with a capacity of 1 (docs/guide/environment.md).

    Args:
        config: Settings of the world. This argument and all others except `others` work as in `hedon.make`.
        species: Name of the agent's species; None for the only one whose policy is `external`, or the only one.
        seed: Seed of the first world; None for a random one.
        actions: Meaning of the numbers in an action.
        repeat: World steps per environment step.
        max_steps: World steps after which the episode is truncated.
        others: Policy of the other agents of the species, from observations (slots, entries) to actions (slots, 2);
            None to keep their motors in the middle of their range.
        render_mode: What `render` produces.
        threads: Number of threads; a world of usual size is fastest with one.
        record: Folder for the records, one run for each world that starts; call `close` at the end.
        frames: World steps between two recorded frames; 0 for none.
        overrides: Settings that replace those of the preset or file.

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
        """The underlying world, for reading only: `simulation.worlds[0]`."""
        return self._vector.simulation

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Starts a new world and a new life.

        Returns:
            The observation (entries,), and a dictionary with the agent's id and slot.

        Raises:
            ArgumentError: The seed is wrong, or `options` is not a dictionary.
            EngineError: The new world has no agent of the species.
        """
        options_of(options)
        super().reset(seed=seed)
        self._vector.reset(None if seed is None else [seed])
        self._slot = first_founder(self._group, 0)
        return self._seen(), self._info()

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Advances the world by `repeat` steps.

        Returns:
            The observation (entries,), zeros after death; the agent's reward; whether it died; whether it reached
            `max_steps`; and a dictionary with its id and slot.

        Raises:
            ArgumentError: The action is not two valid numbers, `others` returned invalid actions, or `reset` was not
                called.
        """
        group, slot = self._group, self._slot
        if slot < 0:
            raise ArgumentError("step: there is no agent: call reset first")
        values = np.asarray(action)
        if values.shape != (2,) or values.dtype.kind not in "fiu":
            raise ArgumentError("action: must be two numbers, left and right")
        # Copied so that a refused action leaves no trace.
        actions = group.actions.copy() if self._others is None else answered(self._others, group)
        actions[0, slot] = values
        self._vector.step(actions)
        terminated = bool(group.terminated[0, slot])
        observation = np.zeros(len(group.columns), np.float32) if terminated else self._seen()
        truncated = bool(group.truncated[0, slot]) and not terminated
        result = observation, float(group.rewards[0, slot]), terminated, truncated, self._info()
        if terminated:
            self._slot = -1
        return result

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_group"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._group = one_group(self._vector)

    def render(self) -> Any:
        """Draws the world: see `VectorEnv.render`."""
        return self._vector.render()

    def close(self) -> None:
        """Finishes the records and closes the window, if there are any."""
        self._vector.close()

    def _seen(self) -> NDArray[np.float32]:
        return self._group.observations[0, self._slot].copy()

    def _info(self) -> dict[str, Any]:
        return {"agent_id": int(self._group.ids_before[0, self._slot]), "slot": self._slot}
