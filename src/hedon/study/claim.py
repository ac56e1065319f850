"""What a claim is: a figure of each world, how the figures of several are summed up, and the region where it holds.

The 95 % interval over worlds decides: within the region the claim holds, outside of it it fails, across its border it
is undecided. Whether our worlds differ from those of the source is another question; it can be asked where the source
gives a count of its worlds.
"""

import math
from dataclasses import dataclass
from typing import Literal

from hedon.measure.measure import WorldNumber
from hedon.statistic.interval import LEVEL
from hedon.study.item import Condition

OverWorlds = Literal["mean", "ratio", "spread", "distance", "share", "extinction", "modes", "walk", "setting"]
"""How the figures of several worlds are summed up."""

Comparison = Literal["difference", "ratio", "spread"]
"""How two groups of worlds are compared."""


@dataclass(frozen=True)
class Claim:
    """One claim about one condition.

    Attributes:
        name: short, unique together with the condition.
        condition: that it is about; with any fidelity, unless it has its own.
        text: the claim, in words.
        measure: the figure of one world; None where it has none.
        over_worlds: how the worlds' figures are summed up: their "mean"; their geometric mean ("ratio"); their
            standard deviation ("spread") or root mean square ("distance"), where they are scores against neutral
            genes of the same world; the "share" of worlds whose figure is above 0; the share that died out by
            `steps` ("extinction"); their "modes", of which there must be two; whether scores differ from those of
            neutral genes in any way ("walk"); a figure that the "setting" alone gives.
        reported: what the source reports.
        low, high: the region in which the claim holds.
        steps: that a world must have lived through to count [step].
        reported_count: worlds of the source that have it, and all of its worlds, for shares; None where it gives no
            such number.
        level: of the interval that decides.
        together: whether worlds count only as long as none of their species has died out.
        source: where it stands.
    """

    name: str
    condition: Condition
    text: str
    measure: WorldNumber
    over_worlds: OverWorlds
    reported: str
    low: float = -math.inf
    high: float = math.inf
    steps: int = 0
    reported_count: tuple[int, int] | None = None
    level: float = LEVEL
    together: bool = False
    source: str = ""


@dataclass(frozen=True)
class Order:
    """One claim about two conditions: which of them has more.

    Attributes:
        name: short, unique together with the conditions.
        first, second: that are compared, where their fidelity is the same.
        text: the claim, in words.
        measure: the figure of one world; None where it has none.
        comparison: of the first against the second: the "difference" of means, the "ratio" of geometric means, or of
            standard deviations ("spread").
        reported: what the source reports.
        low, high: the region of the comparison in which the claim holds.
        steps: that a world must have lived through to count [step].
        level, together, source: as for `Claim`.
    """

    name: str
    first: Condition
    second: Condition
    text: str
    measure: WorldNumber
    comparison: Comparison
    reported: str
    low: float = -math.inf
    high: float = math.inf
    steps: int = 0
    level: float = LEVEL
    together: bool = False
    source: str = ""
