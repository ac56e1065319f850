"""Is a world heading for extinction? The rule, stated before any world was looked at.

A world *heads for extinction* if it died out, or if fewer than half as many agents are alive over its last tenth as
over its second tenth, both means over steps.

Why: worlds start with a few founders and have filled up by the end of the first tenth (some 100,000 of a million steps,
fifteen lives of the paper's baseline), so the second tenth is what a world can hold while its weights are still
near their start. A world without change keeps its numbers within some tenths of their mean; a loss of half is beyond
that, and the rule needs no trend that would have to go on for nine more runs to kill. The price: a world that has
fallen by half and stays there counts too, and one that has only begun to fall does not; the figures show which.
"""

from dataclasses import dataclass

import polars as pl

from hedon.analysis.population import mean_alive, run_tail
from hedon.analysis.world import WorldRecord

LOST = 0.5
"""A world whose last tenth has less than this share of its second tenth heads for extinction."""
EXTINCT, HEADING, STANDING = "extinct", "heading for extinction", "standing"
FATES = (STANDING, HEADING, EXTINCT)


@dataclass(frozen=True)
class Fate:
    """What becomes of one world.

    Attributes:
        fate: one of `FATES`.
        early: agents alive, mean over the second tenth; None where nothing is recorded there.
        late: the same over the last tenth.
        kept: late / early.
    """

    fate: str
    early: float | None
    late: float | None
    kept: float | None

    @property
    def is_lost(self) -> bool:
        """Whether the world is extinct or heading for it."""
        return self.fate != STANDING


def fate(world: WorldRecord) -> Fate:
    """Applies the rule to one world."""
    step, rows = pl.col("step"), world.population
    early = mean_alive(rows.filter((step > 0.1 * world.last_step) & (step <= 0.2 * world.last_step)))
    late = mean_alive(run_tail(rows))
    kept = late / early if early and late is not None else None
    if world.extinct_step is not None:
        return Fate(EXTINCT, early, late, kept)
    return Fate(HEADING if kept is not None and kept < LOST else STANDING, early, late, kept)
