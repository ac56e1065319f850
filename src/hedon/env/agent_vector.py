"""The lives of one agent in each of several worlds as a vector environment of Gymnasium."""

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
    """One agent in each of several worlds: `AgentEnv` for as many worlds as there are environments, stepped together.

    `gymnasium.make_vec("hedon/baseline-v0", num_envs=8)` makes it. When an agent dies, or its time is over, its world
    begins again in the next step, whose action is ignored, with a seed drawn from the first ones.

    Args:
        config: Settings of the worlds, as for `hedon.make`.
        num_envs: How many worlds.
        species: As for `AgentEnv`, like all that follow.
        seed: Of the first world, whose followers have the next numbers; None for one drawn by chance.
        actions: What their numbers are.
        repeat: Steps of the worlds in one step.
        max_steps: Steps of a world after which the episode is truncated.
        others: Acts for the others of the species, from observations (worlds · slots, entries) to actions.
        render_mode: What `render` gives.
        threads: As in `hedon.Simulation`; changes no result.
        record: Folder for the records of its worlds, one run for each that begins; call `close` at the end.
        frames: Steps of the world between two frames of the records; 0 for none.
        overrides: Settings that differ from those of the preset or file.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        EngineError: A world begins without an agent of the species.
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
        """Begins all worlds.

        Args:
            seed: Of the first world, whose followers have the next numbers; or one for each world.
            options: None are known.

        Returns:
            The observations (worlds, entries), and the agents' ids.

        Raises:
            ArgumentError: A seed is wrong, or `options` is no dictionary.
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
            Observations (worlds, entries), rewards (worlds,), deaths (worlds,), lives that time ended (worlds,), infos.

        Raises:
            ArgumentError: An action is not two numbers that it can be, or `others` answered none; or there was no
                `reset`.
        """
        if self._slots[0] < 0:
            raise ArgumentError("step: there are no agents: call reset first")
        given = np.asarray(actions)
        if given.shape != (self.num_envs, 2) or given.dtype.kind not in "fiu":
            raise ArgumentError(f"actions: must be numbers of shape {(self.num_envs, 2)}, not {given.shape}")
        every = self.group.actions.copy() if self._others is None else answered(self._others, self.group)
        rows = (np.arange(self.num_envs), self._slots)
        every[rows] = given
        self.worlds.step(every)
        begins = self._over
        if begins.any():
            self.worlds.reset(options={RESET_MASK: begins})
            self._choose(begins)
            rows = (rows[0], self._slots)
        rewards = np.where(begins, np.float32(0), self.group.rewards[rows])
        died = ~begins & self.group.terminated[rows]
        cut = ~begins & ~died & self.group.truncated[rows]
        self._over = died | cut
        return np.where(died[:, None], np.float32(0), self._seen()), rewards, died, cut, self._infos()

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "group"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.group = one_group(self.worlds)

    def _choose(self, begins: NDArray[np.bool_]) -> None:
        for world in np.flatnonzero(begins).tolist():
            self._slots[world] = first_founder(self.group, world)

    def _seen(self) -> Floats:
        return self.group.observations[np.arange(self.num_envs), self._slots]

    def _infos(self) -> dict[str, Any]:
        return {"agent_id": self.group.ids_before[np.arange(self.num_envs), self._slots]}
