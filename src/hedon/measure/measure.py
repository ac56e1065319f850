"""Defines a measure: one number of a world, or of one species in it, with the same name wherever it appears."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from hedon.analysis.world.record import WorldRecord
from hedon.statistic.interval import ANY

WorldNumber = Callable[[WorldRecord], float | None]
"""Computes one number of a world; None if the world has none."""


@dataclass(frozen=True)
class Measure:
    """One number of a world, or of one species in it.

    Attributes:
        name: Its key in summaries and its column in tables.
        title: Its label in figures and tables, with the unit.
        of: Computes the number for a world; returns None if the world has no value.
        within: Smallest and largest value that its mean over worlds can have.
        meaning: Its description in the documentation of files, if longer than the title.
        ratio: Whether worlds are compared on a logarithmic scale, so that effects are ratios.
        binary: Whether it is true or false, so that its mean is a share.
        usual: Whether comparisons show it by default.
        averaged: Whether summaries contain its mean over worlds.
        condition: Tests whether a world can have the number at all; for example, only worlds with predators have prey.
            None if all worlds can.
    """

    name: str
    title: str
    of: WorldNumber
    within: tuple[float, float] = ANY
    meaning: str = ""
    ratio: bool = False
    binary: bool = False
    usual: bool = False
    averaged: bool = False
    condition: Callable[[WorldRecord], bool] | None = None

    @property
    def documentation(self) -> str:
        """The meaning, or the title if there is no longer description."""
        return self.meaning or self.title

    def applies(self, world: WorldRecord) -> bool:
        """Whether the world can have the number."""
        return self.condition is None or self.condition(world)

    def value(self, world: WorldRecord) -> float | None:
        """The number of a world; None if it has no value or, for a ratio, if the value is not above 0."""
        value = self.of(world)
        return None if value is None or not math.isfinite(value) or (self.ratio and value <= 0) else float(value)

    def scaled(self, value: float) -> float:
        """Converts a number to the scale on which worlds are compared."""
        return math.log(value) if self.ratio else value

    def unscaled(self, value: float | None) -> float | None:
        """Converts a number back from that scale; a difference of logarithms becomes a ratio."""
        return math.exp(value) if self.ratio and value is not None else value
