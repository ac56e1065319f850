"""Is a world heading for extinction? The rule, stated before any world was looked at.

A world *heads for extinction* if it died out, or if fewer than half as many agents are alive over its last tenth as
over its second tenth, both means over steps.

Why: worlds start with a few founders and have filled up by the end of the first tenth (some 100,000 of a million steps,
fifteen lives of the paper's baseline), so the second tenth is what a world can hold while its weights are still
near their start; a loss of half is large, and needs no trend that would have to go on for nine more runs to kill.
The price: numbers of starving worlds swing, some by half within 100,000 steps, so a world may be hit on its way
through a low, or stay at half for good, and one that has only begun to fall is missed. How many worlds had such a low
before and *recovered* says how far the rule can be trusted; it was not changed for what it gave.
"""

from dataclasses import dataclass
from itertools import pairwise

import polars as pl

from hedon.analysis import WorldRecord, mean_alive

LOST = 0.5
"""A world whose last tenth has less than this share of its second tenth heads for extinction."""
EXTINCT, HEADING, STANDING = "extinct", "heading for extinction", "standing"
FATES = (STANDING, HEADING, EXTINCT)
_TENTHS = 10


@dataclass(frozen=True)
class Fate:
    """What becomes of one world.

    Attributes:
        fate: one of `FATES`.
        early: agents alive, mean over the second tenth; None where nothing is recorded there.
        late: the same over the last tenth.
        kept: late / early.
        recovered: whether it stands, but would have been called lost by one of the tenths before the last.
    """

    fate: str
    early: float | None
    late: float | None
    kept: float | None
    recovered: bool

    @property
    def is_lost(self) -> bool:
        """Whether the world is extinct or heading for it."""
        return self.fate != STANDING


def fate(world: WorldRecord) -> Fate:
    """Applies the rule to one world."""
    bounds = [i * world.last_step / _TENTHS for i in range(_TENTHS + 1)]
    tenths = [(pl.col("step") > low) & (pl.col("step") <= high) for low, high in pairwise(bounds)]
    means = [mean_alive(world.population.filter(tenth)) for tenth in tenths]
    early, late = means[1], means[-1]
    shares = [mean / early if early and mean is not None else None for mean in means]
    low = [share is not None and share < LOST for share in shares]
    name = EXTINCT if world.extinct_step is not None else HEADING if low[-1] else STANDING
    return Fate(name, early, late, shares[-1], recovered=name == STANDING and any(low[2:]))
