"""Common parts of the Gymnasium vector environments around worlds from `hedon.make`."""

from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from hedon.copied import Copied
from hedon.env.vector import RENDER_MODES, VectorEnv

Floats = NDArray[np.float32]
METADATA: dict[str, Any] = {
    "render_modes": list(RENDER_MODES),
    "render_fps": 30,
    "autoreset_mode": AutoresetMode.NEXT_STEP,
}
"""Declares to Gymnasium that a restart happens in the step after an end."""


class WorldsVectorEnv(Copied, gymnasium.vector.VectorEnv[Floats, Floats, NDArray[Any]]):
    """Several environments in worlds from `hedon.make`.

    Args:
        worlds: Worlds with one driven species.
        num_envs: Number of environments in them.
    """

    metadata = METADATA

    def __init__(self, worlds: VectorEnv, num_envs: int) -> None:
        self.worlds, self.num_envs, self.render_mode = worlds, num_envs, worlds.render_mode
        self.single_observation_space = worlds.single_observation_space
        self.single_action_space = worlds.single_action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def render(self) -> tuple[Any, ...] | None:
        """Draws each world; None without a `render_mode`."""
        if self.render_mode is None:
            return None
        return tuple(self.worlds.render(i) for i in range(len(self.worlds.simulation.worlds)))

    def close_extras(self, **kwargs: Any) -> None:
        """Finishes the records and closes the window, if there are any."""
        self.worlds.close()
