"""Rigid bodies without the rest of the model."""

from collections.abc import Sequence
from typing import Any

import numpy.typing


class Scene:
    """Discs, static circles and walls, with their memory."""

    def __init__(self, config: dict, width: float, height: float, radius: float, density: float, circle_radius: float, bodies: int, circles: int, walls: Sequence[Sequence[float]], pair_limit: int = 0, outer_walls: int = 0, classes: Sequence[tuple[int, float, float]] = []) -> None: ...

    def step(self, steps: int = 1, threads: int = 1, record: bool = True) -> None:
        """Steps; raises RuntimeError with the name of a fault."""

    def set_order(self, slots: Sequence[int]) -> None:
        """Slots of the bodies that live, in canonical order."""

    def array(self, name: str) -> numpy.typing.NDArray[Any]:
        """A writable view of one array by slot."""

    def pairs(self, kind: str) -> list[tuple[int, int, float, float, int]]:
        """Listed pairs with impulses and marks."""

    def contacts(self) -> list:
        """Contacts that were reported to the visitor in the last step."""

    def near(self, kind: str, x: float, y: float, reach: float) -> list[int]: ...

    def add_circle(self, slot: int, x: float, y: float) -> None: ...

    def remove_circle(self, slot: int) -> None: ...

    def set_stale(self) -> None:
        """Call after a change of positions, circles or the order."""

    def counters(self) -> dict: ...
