"""What a measure is: one number of a world, or of one species of it, under one name wherever it is shown."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from hedon.analysis.world.record import WorldRecord
from hedon.statistic.interval import ANY


def _always(_world: WorldRecord) -> bool:
    return True


@dataclass(frozen=True)
class Measure:
    """One number of a world, or of one species of it.

    Attributes:
        name: Its key in summaries and its column in tables.
        title: What figures and tables of several worlds call it, with its unit.
        meaning: What it is, for the documentation of files.
        of: The number of a world; None where it has none.
        within: Bounds of what its mean over worlds can be.
        ratio: Whether worlds are compared by the logarithm, so that effects are ratios.
        binary: Whether it is yes or no, so that its mean is a share.
        usual: Whether a comparison shows it unless told otherwise.
        averaged: Whether a summary has its mean over worlds.
        applies: Whether worlds of this kind have it at all, as none has prey where no agents are eaten.
    """

    name: str
    title: str
    meaning: str
    of: Callable[[WorldRecord], float | None]
    within: tuple[float, float] = ANY
    ratio: bool = False
    binary: bool = False
    usual: bool = False
    averaged: bool = False
    applies: Callable[[WorldRecord], bool] = _always

    def value(self, world: WorldRecord) -> float | None:
        """The number of a world; None where it has none or, for a ratio, where it is not above 0."""
        found = self.of(world)
        return None if found is None or not math.isfinite(found) or (self.ratio and found <= 0) else float(found)

    def scaled(self, value: float) -> float:
        """A number on the scale on which worlds are compared."""
        return math.log(value) if self.ratio else value

    def unscaled(self, value: float | None) -> float | None:
        """Back from that scale: of a difference, the difference or the ratio."""
        return math.exp(value) if self.ratio and value is not None else value
