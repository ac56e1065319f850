"""Slots of worlds as a Gymnasium vector environment."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.env.argument import options_of
from hedon.env.group import Group
from hedon.env.slot_life import SlotLives
from hedon.env.vector import VectorEnv
from hedon.env.vector_base import Floats, WorldsVectorEnv


class SlotVectorEnv(WorldsVectorEnv):
    """Each slot of a species in each world is an environment; one network acts for all agents and learns from all.

    An episode is a life. After its agent has died, a slot observes zeros and gets a reward of 0 until an agent is born
    there. If one was born in that very step, its first step belongs to no episode, since Gymnasium ignores the step
    after an end. Worlds that have reached `max_steps`, or have no agent of the species left, restart in the next step,
    with seeds drawn from the first ones.

    `infos` contains `alive` (slots,), the mask of slots with an agent, and, if a life ended, `life`: its total reward
    (`r`) and its length in steps (`l`), with the mask `_life`. Gymnasium's `RecordEpisodeStatistics` also counts the
    steps in which a slot waited for its next agent, and omits first steps that belong to no episode; `life` covers
    whole lives.

    Args:
        worlds: Worlds from `hedon.make` with one driven species; nothing else may step or reset them.

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
        """Starts all worlds.

        Args:
            seed: Seed of the first world, with the following numbers for the others; or one seed per world.
            options: Must be empty; no option is known.

        Returns:
            The observations (slots, entries), and infos.

        Raises:
            ArgumentError: A seed is wrong, or `options` is not a dictionary.
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
            Observations (slots, entries), rewards (slots,), deaths (slots,), lives cut off at `max_steps` (slots,),
            infos.

        Raises:
            ArgumentError: The action of a living agent is invalid.
        """
        step = self.lives.step(actions)
        infos: dict[str, Any] = {"alive": step.alive}
        if step.ended.any():
            infos |= {"life": {"r": step.paid, "l": step.lived}, "_life": step.ended}
        return step.observations, step.rewards, step.ended & ~step.cut, step.cut, infos
