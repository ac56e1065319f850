"""Pictures of worlds that a program drives, drawn as in films of runs: as arrays or in a window."""

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.env.window import Window
from hedon.experiment.sample import snapshot
from hedon.experiment.world import World
from hedon.figure.film import Film

WIDTH = 640
"""Width of a picture [pixel]."""


class Eye:
    """Draws worlds of one config.

    Args:
        config: Settings of the worlds.
        mode: `rgb_array` for pictures, `human` for a window.

    Raises:
        ArgumentError: The package that shows windows is not installed.
    """

    def __init__(self, config: Config, mode: str) -> None:
        self._window = Window() if mode == "human" else None
        self._colors = {kind: food.color for kind, food in config.food.items()}
        self._top = max(species.energy.capacity for species in config.species.values())
        self._films: dict[tuple[int, int], Film] = {}

    def see(self, world: World) -> NDArray[np.uint8] | None:
        """Draws the current state of a world: (height, width, 3), red, green, blue; None if a window shows it."""
        picture = self._picture(world)
        if self._window is None:
            return picture
        self._window.show(picture)
        return None

    def close(self) -> None:
        """Closes the window, if there is one."""
        if self._window is not None:
            self._window.close()

    def _picture(self, world: World) -> NDArray[np.uint8]:
        scene = snapshot(world)
        place = (world.index, world.seed)  # obstacles depend on the seed
        if place not in self._films:
            self._films = {place: Film(scene, self._colors, WIDTH, self._top)}
        film = self._films[place]
        return np.frombuffer(film.draw(scene), np.uint8).reshape(film.height, film.width, 4)[..., :3].copy()
