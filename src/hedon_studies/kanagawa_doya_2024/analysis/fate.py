"""Is a world heading for extinction? The rule was fixed before any world was examined.

A world *heads for extinction* if it died out, or if its number of agents alive, averaged over the last tenth of its
steps, is less than half of the average over the second tenth.

Reasons: worlds start with a few founders and have filled up by the end of the first tenth (about 100,000 of a million
steps, or fifteen lifetimes of the paper's baseline). The second tenth therefore shows how many agents a world can
sustain while its weights are still near their start. A loss of half is large, whereas a trend might have to continue
for nine more runs before the world dies out.

Drawbacks: numbers in starving worlds fluctuate, some by half within 100,000 steps. A world may be classified during a
temporary low, or may stay at half permanently, and a world whose decline has just started is missed. The number of
worlds that had such a low earlier and *recovered* shows how far the rule can be trusted. The rule was not changed after
its results were known.
"""

from dataclasses import dataclass
from itertools import pairwise

import polars as pl

from hedon.analysis import WorldRecord, mean_alive

LOST = 0.5
"""Share of the second tenth below which the last tenth means that a world heads for extinction."""
EXTINCT, HEADING, STANDING = "extinct", "heading for extinction", "standing"
FATES = (STANDING, HEADING, EXTINCT)
_TENTHS = 10


@dataclass(frozen=True)
class Fate:
    """The fate of one world.

    Attributes:
        fate: One of `FATES`.
        early: Mean number of agents alive over the second tenth; None if nothing is recorded there.
        late: Mean number of agents alive over the last tenth.
        kept: late / early.
        recovered: Whether the world is not lost, but would have been called lost in a tenth before the last.
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
