"""The lives of one agent in each of several worlds, as a Gymnasium vector environment."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.env.agent import Policy, answered, first_founder, one_group, require_policy
from hedon.env.argument import RESET_MASK, options_of
from hedon.env.group import Form
from hedon.env.make import make
from hedon.env.vector_base import Floats, WorldsVectorEnv
from hedon.error import ArgumentError


class AgentVectorEnv(WorldsVectorEnv):
    """One agent in each of several worlds: several `AgentEnv`, stepped together.

    `gymnasium.make_vec("hedon/baseline-v0", num_envs=8)` creates it. After an agent dies or reaches `max_steps`, the
    next step ignores its action and restarts its world, with a seed drawn from the first ones.

    Args:
        config: Settings of the worlds, as for `hedon.make`.
        num_envs: Number of worlds.
        species: Name of the agents' species. This argument and all that follow work as in `AgentEnv`.
        seed: Seed of the first world; the others get the following numbers. None for a random one.
        actions: Meaning of the numbers in an action.
        repeat: World steps per environment step.
        max_steps: World steps after which the episode is truncated.
        others: Policy of the other agents of the species, from observations (worlds · slots, entries) to actions.
        render_mode: What `render` produces.
        threads: Number of threads; 0 for one per 150 slots, or for all processors if the engine computes networks of
            some agents. Changes no result.
        record: Folder for the records, one run for each world that starts; call `close` at the end.
        frames: World steps between two recorded frames; 0 for none.
        overrides: Settings that replace those of the preset or file.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        EngineError: A new world has no agent of the species.
    """

    def __init__(
        self,
        config: Config | str | Path,
        num_envs: int = 1,
        species: str | None = None,
        seed: int | None = None,
        actions: Form = "unit",
        repeat: int = 1,
        max_steps: int = 0,
        others: Policy | None = None,
        render_mode: str | None = None,
        threads: int = 0,
        record: Path | str | None = None,
        frames: int = 0,
        overrides: Iterable[str] = (),
    ) -> None:
        worlds = make(
            config,
            num_envs,
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
        self.group = one_group(worlds)
        super().__init__(worlds, num_envs)
        self._others = require_policy(others)
        self._slots, self._over = np.full(num_envs, -1), np.zeros(num_envs, np.bool_)

    def reset(
        self, *, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Starts all worlds.

        Args:
            seed: Seed of the first world, with the following numbers for the others; or one seed per world.
            options: Must be empty; no option is known.

        Returns:
            The observations (worlds, entries), and a dictionary with the agents' ids.

        Raises:
            ArgumentError: A seed is wrong, or `options` is not a dictionary.
        """
        options_of(options)
        self.worlds.reset(seed)
        self._over = np.zeros(self.num_envs, np.bool_)
        self._choose(~self._over)
        return self._seen(), self._infos()

    def step(
        self, actions: NDArray[Any]
    ) -> tuple[Floats, NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Advances the worlds by `repeat` steps.

        Args:
            actions: (worlds, 2), left and right motor of each agent.

        Returns:
            Observations (worlds, entries), rewards (worlds,), deaths (worlds,), lives cut off at `max_steps` (worlds,),
            infos.

        Raises:
            ArgumentError: An action is not two valid numbers, `others` returned invalid actions, or `reset` was not
                called.
        """
        if self._slots[0] < 0:
            raise ArgumentError("step: there are no agents: call reset first")
        values = np.asarray(actions)
        if values.shape != (self.num_envs, 2) or values.dtype.kind not in "fiu":
            raise ArgumentError(f"actions: must be numbers of shape {(self.num_envs, 2)}, not {values.shape}")
        all_actions = self.group.actions.copy() if self._others is None else answered(self._others, self.group)
        rows = (np.arange(self.num_envs), self._slots)
        all_actions[rows] = values
        self.worlds.step(all_actions)
        restarting = self._over
        if restarting.any():
            self.worlds.reset(options={RESET_MASK: restarting})
            self._choose(restarting)
            rows = (rows[0], self._slots)
        rewards = np.where(restarting, np.float32(0), self.group.rewards[rows])
        terminated = ~restarting & self.group.terminated[rows]
        truncated = ~restarting & ~terminated & self.group.truncated[rows]
        self._over = terminated | truncated
        return np.where(terminated[:, None], np.float32(0), self._seen()), rewards, terminated, truncated, self._infos()

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "group"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.group = one_group(self.worlds)

    def _choose(self, restarting: NDArray[np.bool_]) -> None:
        for world in np.flatnonzero(restarting).tolist():
            self._slots[world] = first_founder(self.group, world)

    def _seen(self) -> Floats:
        return self.group.observations[np.arange(self.num_envs), self._slots]

    def _infos(self) -> dict[str, Any]:
        return {"agent_id": self.group.ids_before[np.arange(self.num_envs), self._slots]}
