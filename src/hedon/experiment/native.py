"""Turns a checked config into the engine's input. All configs reach the engine through here."""

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
    """A config that has passed all checks, and the engine's input made from it.

    Attributes:
        config: The checked config.
        settings: Values for the engine's structs.
        walls: (count, 4) float32, the outer polygon first [u].
        outer_walls: Number of walls that make up the outer polygon.
    """

    config: Config
    settings: dict[str, Any]
    walls: NDArray[np.float32]
    outer_walls: int


def engine_input(config: Config) -> EngineInput:
    """Checks a config, however it was made, and turns it into the engine's input.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: It is not a `Config`.
    """
    with _engine.FloatMode():  # the walls must not depend on the caller's rounding mode
        config = validated(config)
        return EngineInput(config, engine_config(config), walls(config.arena), outer_count(config.arena))
