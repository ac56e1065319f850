"""Slots of worlds as a vector environment of Gymnasium."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.env.argument import options_of
from hedon.env.group import Group
from hedon.env.slot_life import SlotLives
from hedon.env.vector import VectorEnv
from hedon.env.vector_base import Floats, WorldsVectorEnv


class SlotVectorEnv(WorldsVectorEnv):
    """Each slot of a species in each world as an environment: one network acts for all agents, and learns from all.

    An episode is a life. A slot whose agent has died observes zeros and is paid 0 until an agent is born there. If one
    was born in that very step, its first step belongs to no episode, since Gymnasium ignores the step after an end.
    Worlds that have come to `max_steps`, or in which no agent of the species is left, begin again in the next step,
    with seeds drawn from the first ones.

    `infos` contains `alive` (slots,), the mask of slots with an agent, and where a life ended `life`: what it was paid
    (`r`) and how many steps it took (`l`), with the mask `_life`. Gymnasium's `RecordEpisodeStatistics` also counts the
    steps in which a slot waited for its next agent, and leaves out first steps that belong to no episode; `life` tells
    whole lives.

    Args:
        worlds: Of `hedon.make`, with one driven species; nothing else may step or reset them.

    Raises:
        ArgumentError: Several species are driven.

    Example:
        >>> import hedon, hedon.env
        >>> envs = hedon.env.SlotVectorEnv(hedon.make("baseline", worlds=2, max_steps=1000))
        >>> observations, infos = envs.reset(seed=1)
        >>> observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
    """

    def __init__(self, worlds: VectorEnv) -> None:
        self.lives = SlotLives(worlds, at_once=False)
        super().__init__(worlds, self.lives.count)

    @property
    def group(self) -> Group:
        """The agents in the slots."""
        return self.lives.group

    def reset(
        self, *, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begins all worlds.

        Args:
            seed: Of the first world, whose followers have the next numbers; or one for each world.
            options: None are known.

        Returns:
            The observations (slots, entries), and infos.

        Raises:
            ArgumentError: A seed is wrong, or `options` is no dictionary.
        """
        options_of(options)
        rows = self.lives.reset(seed)
        return rows, {"alive": self.group.alive.ravel().copy()}

    def step(
        self, actions: NDArray[Any]
    ) -> tuple[Floats, NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Advances the worlds.

        Args:
            actions: (slots, 2), left and right motor; rows of empty slots are not read.

        Returns:
            Observations (slots, entries), rewards (slots,), deaths (slots,), lives that time ended (slots,), infos.

        Raises:
            ArgumentError: An action of a living agent is not a number that it can be.
        """
        step = self.lives.step(actions)
        infos: dict[str, Any] = {"alive": step.alive}
        if step.ended.any():
            infos |= {"life": {"r": step.paid, "l": step.lived}, "_life": step.ended}
        return step.observations, step.rewards, step.ended & ~step.cut, step.cut, infos
