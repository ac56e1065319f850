"""The arrays of a world's state as attributes."""

from collections.abc import Callable, Sequence
from typing import Any

from numpy.typing import NDArray

from hedon.config.problem import did_you_mean

PARTS = ("", "life.", "physics.bodies.")
"""Prefixes with which an attribute is looked up, in this order."""


class WorldArrays:
    """The arrays of a world's state, each read-only, with a row per slot, valid until the next `run`.

    `state.energy` is `view("life.energy")`, `state.x` is `view("physics.bodies.x")`, `state.genome` is
    `view("genome")`. The rows of living agents are `state.energy[world.living]`. `dir(state)` lists all names; for
    arrays without one, such as `food_stock.eaten`, use `World.view`.

    Args:
        view: Function from an array's path to the array, of any shape.
        paths: Paths of all arrays.
    """

    def __init__(self, view: Callable[[str], NDArray[Any]], paths: Sequence[str]) -> None:
        """Called by a world for its own state.

        Args:
            view: Function from an array's path to the array, of any shape.
            paths: Paths of all arrays.
        """
        self._view = view
        self._paths = {
            name: path
            for part in reversed(PARTS)
            for path in paths
            if path.startswith(part) and "." not in (name := path.removeprefix(part))
        }

    def __getattr__(self, name: str) -> NDArray[Any]:
        """The array of this name, of any shape.

        Raises:
            AttributeError: There is no such array.
        """
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._paths:
            hint = did_you_mean(name, self._paths)
            raise AttributeError(f"the state has no array {name!r}{hint}")
        return self._view(self._paths[name])

    def __dir__(self) -> list[str]:
        return sorted(self._paths)
