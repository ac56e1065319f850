"""Slots of worlds as Stable-Baselines3 environments; install it with `pip install stable-baselines3`."""

import time
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from stable_baselines3.common.vec_env import VecEnv  # pyright: ignore[reportMissingImports]

from hedon.copied import Copied
from hedon.env.group import Group
from hedon.env.slot_life import SlotLives
from hedon.env.vector import VectorEnv
from hedon.error import ArgumentError


class SlotVecEnv(VecEnv, Copied):
    """Each slot of a species in each world is an environment; one network acts for all agents and learns from all.

    This class needs Stable-Baselines3, which hedon does not install: `pip install stable-baselines3`.

    An episode is a life: it ends with a death (`dones`), and its info has `episode`, with the total reward (`r`) and
    the length in steps (`l`), as Stable-Baselines3's monitors write it; no monitor is needed. An empty slot observes
    zeros, gets a reward of 0, and has `alive: False` in its info. Worlds that have reached `max_steps`, or have no
    agent of the species left, restart with seeds drawn from the first ones; the info of a life cut off at `max_steps`
    has `TimeLimit.truncated`. `terminal_observation` holds the last observation of a life: zeros after death.

    Args:
        worlds: Worlds from `hedon.make` with one driven species; nothing else may step or reset them.

    Raises:
        ArgumentError: Several species are driven.
    """

    def __init__(self, worlds: VectorEnv) -> None:
        self.lives = SlotLives(worlds, at_once=True)
        self.worlds, self.render_mode = worlds, worlds.render_mode
        self._next_actions: Any = self.lives.group.actions
        self._begun = time.monotonic()
        super().__init__(self.lives.count, worlds.single_observation_space, worlds.single_action_space)

    @property
    def group(self) -> Group:
        """The agents in the slots."""
        return self.lives.group

    def reset(self) -> Any:
        """Starts all worlds; returns the observations (slots, entries)."""
        seed = next((candidate for candidate in self._seeds if candidate is not None), None)  # seed of the first world
        self._reset_seeds()
        return self.lives.reset(seed)

    def step_async(self, actions: Any) -> None:
        """Sets the actions of all agents: (slots, 2)."""
        self._next_actions = actions

    def step_wait(self) -> Any:
        """Advances the worlds: observations (slots, entries), rewards (slots,), ends of lives (slots,), infos."""
        step = self.lives.step(self._next_actions)
        infos: list[dict[str, Any]] = [{"alive": is_alive} for is_alive in step.alive.tolist()]
        elapsed = round(time.monotonic() - self._begun, 6)
        for i in np.flatnonzero(step.ended).tolist():
            infos[i] |= {"terminal_observation": step.last[i], "TimeLimit.truncated": bool(step.cut[i])}
            infos[i]["episode"] = {"r": float(step.paid[i]), "l": int(step.lived[i]), "t": elapsed}
        return step.observations, step.rewards, step.ended, infos

    def __getstate__(self) -> dict[str, Any]:
        actions = None if self._next_actions is self.lives.group.actions else self._next_actions
        return self.__dict__ | {"_next_actions": actions}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        if self._next_actions is None:
            self._next_actions = self.lives.group.actions

    def close(self) -> None:
        """Closes the worlds."""
        self.worlds.close()

    def get_images(self) -> Sequence[Any]:
        """Draws each world."""
        return [self.worlds.render(i) for i in range(len(self.worlds.simulation.worlds))]

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of the worlds, the same for all slots."""
        return [getattr(self.worlds, attr_name)] * self._count(indices)

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Not supported: slots have no attributes of their own.

        Raises:
            ArgumentError: Always.
        """
        raise ArgumentError(f"{attr_name}: slots have no attributes of their own: change the worlds")

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Not supported: slots have no methods of their own.

        Raises:
            ArgumentError: Always.
        """
        raise ArgumentError(f"{method_name}: slots have no methods of their own: call those of the worlds")

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Always False: no slot is wrapped."""
        return [False] * self._count(indices)

    def _count(self, indices: Any) -> int:
        if indices is None:
            return self.num_envs
        return len(list(indices)) if isinstance(indices, Iterable) else 1
