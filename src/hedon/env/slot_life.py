"""A step of the worlds with each slot as its own environment: which lives ended, and their rewards."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.env.argument import RESET_MASK
from hedon.env.group import NOBODY, Group
from hedon.env.vector import VectorEnv
from hedon.error import ArgumentError


@dataclass(frozen=True, slots=True)
class SlotStep:
    """Results of a step for all slots of all worlds.

    Attributes:
        observations: (slots, entries); `last` for lives that ended, unless the next life or world shows at once.
        rewards: (slots,), rewards of the agents that were there before the step.
        ended: (slots,), whether a life ended, by death or with its world.
        cut: (slots,), whether a life that would have continued ended at `max_steps`.
        last: (slots, entries), last observation of each life that ended; zeros after death.
        paid: (slots,), total reward of each life that ended; 0 elsewhere.
        lived: (slots,), length of each life that ended [step]; 0 elsewhere.
        alive: (slots,), whether an agent lives there now.
    """

    observations: NDArray[np.float32]
    rewards: NDArray[np.float32]
    ended: NDArray[np.bool_]
    cut: NDArray[np.bool_]
    last: NDArray[np.float32]
    paid: NDArray[np.float64]
    lived: NDArray[np.int64]
    alive: NDArray[np.bool_]


class SlotLives:
    """The slots of one driven species, whose worlds restart by themselves at `max_steps` or when no agent is left.

    Args:
        worlds: Worlds from `hedon.make` with one driven species; nothing else may step or reset them.
        at_once: Whether a world that is over restarts in the same step, and a newborn appears in the step in which its
            slot's last agent died; otherwise both happen in the next step.

    Attributes:
        worlds: The driven worlds.
        group: The agents in the slots.

    Raises:
        ArgumentError: Several species are driven.
    """

    def __init__(self, worlds: VectorEnv, *, at_once: bool) -> None:
        if len(worlds.groups) > 1:
            raise ArgumentError(f"worlds: must drive one species, not {', '.join(worlds.groups)}")
        self.worlds = worlds
        self.group: Group = next(iter(worlds.groups.values()))
        self._paid, self._lived = np.zeros(self.group.ids.shape), np.zeros(self.group.ids.shape, np.int64)
        self._at_once, self._over = at_once, np.zeros(len(self.group.ids), np.bool_)

    @property
    def count(self) -> int:
        """Number of slots in all worlds."""
        return self.group.ids.size

    def reset(self, seed: Any = None) -> NDArray[np.float32]:
        """Starts all worlds; returns the observations (slots, entries)."""
        self.worlds.reset(seed=seed)
        self._over = np.zeros(len(self.group.ids), np.bool_)
        self._paid[...], self._lived[...] = 0, 0
        return self._table(self.group.observations)

    def step(self, actions: Any) -> SlotStep:
        """Advances all worlds.

        Args:
            actions: (slots, 2), or the group's array `actions`.
        """
        group, worlds, restarting = self.group, self.worlds, self._over
        worlds.step(actions)
        if restarting.any():
            worlds.reset(options={RESET_MASK: restarting})
        rewards = np.where(restarting[:, None], np.float32(0), group.rewards)
        is_over = ~restarting & (group.truncated.any(axis=1) | ~group.alive.any(axis=1))
        was_alive = ~restarting[:, None] & (group.ids_before != NOBODY)
        self._paid += rewards
        self._lived += was_alive
        ended = was_alive & (group.terminated | is_over[:, None])
        paid, lived = np.where(ended, self._paid, 0.0).ravel(), np.where(ended, self._lived, 0).ravel()
        self._paid[ended], self._lived[ended] = 0, 0
        cut, ended = (ended & group.truncated & ~group.born).ravel(), ended.ravel()
        rows = self._table(group.observations)
        last = np.where(cut[:, None], rows, np.float32(0))
        if not self._at_once:
            self._over = is_over
            rows[ended] = last[ended]
        elif is_over.any():
            worlds.reset(options={RESET_MASK: is_over})
            rows = self._table(group.observations)
        alive = group.alive.ravel().copy()
        return SlotStep(rows, rewards.ravel(), ended, cut, last, paid, lived * worlds.repeat, alive)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "group"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        (self.group,) = self.worlds.groups.values()

    def _table(self, array: Any) -> Any:
        return array.reshape(self.count, -1).copy()
