"""What a simulation is made from, as the engine takes it: the one door from configs to the engine."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon import _engine
from hedon.config.arena import outer_count, walls
from hedon.config.config import Config
from hedon.config.native import engine_config
from hedon.config.validate import validated


@dataclass(frozen=True, slots=True)
class EngineInput:
    """A config that has passed all checks, and what the engine makes worlds from.

    Attributes:
        config: What was checked.
        settings: For the engine's structs.
        walls: (count, 4) float32, the outer polygon first [u].
        outer_walls: How many of the walls make up the outer polygon.
    """

    config: Config
    settings: dict[str, Any]
    walls: NDArray[np.float32]
    outer_walls: int


def engine_input(config: Config) -> EngineInput:
    """Checks a config, however it was put together, and turns it into what the engine takes.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: It is no `Config`.
    """
    with _engine.FloatMode():  # the caller's rounding must not reach the walls
        config = validated(config)
        return EngineInput(config, engine_config(config), walls(config.arena), outer_count(config.arena))
