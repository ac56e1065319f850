"""Pictures of worlds that a program drives, as films of runs have them."""

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.experiment.sample import snapshot
from hedon.experiment.world import World
from hedon.figure.film import Film

WIDTH = 640
"""Of a picture [pixel]."""


class Camera:
    """Takes pictures of worlds of one config.

    Args:
        config: Of the worlds.
    """

    def __init__(self, config: Config) -> None:
        self._colors = {kind: food.color for kind, food in config.food.items()}
        self._top = max(species.energy.capacity for species in config.species.values())
        self._films: dict[tuple[int, int], Film] = {}

    def picture(self, world: World) -> NDArray[np.uint8]:
        """What a world looks like now: (height, width, 3), red, green, blue.

        Args:
            world: To look at.
        """
        seen = snapshot(world)
        place = (world.index, world.seed)  # obstacles depend on the seed
        if place not in self._films:
            self._films = {place: Film(seen, self._colors, WIDTH, self._top)}
        film = self._films[place]
        return np.frombuffer(film.draw(seen), np.uint8).reshape(film.height, film.width, 4)[..., :3].copy()
