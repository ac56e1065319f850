"""Defines a claim: a figure for each world, a rule to combine these figures, and the region in which the claim holds.

The 95 % interval over worlds decides. If it is within the region, the claim holds; if it is outside, the claim fails;
if it crosses the border, the claim is undecided. Whether our worlds differ from those of the source is a separate
question, which can be answered if the source reports a count of worlds.
"""

import math
from dataclasses import dataclass
from typing import Literal

from hedon.measure.measure import WorldNumber
from hedon.statistic.interval import LEVEL
from hedon.study.item import Condition

OverWorlds = Literal["mean", "ratio", "spread", "distance", "share", "extinction", "modes", "walk", "setting"]
"""How the figures of several worlds are combined."""

Comparison = Literal["difference", "ratio", "spread"]
"""How two groups of worlds are compared."""


@dataclass(frozen=True)
class Claim:
    """One claim about one condition.

    Attributes:
        name: Short name, unique together with the condition.
        condition: The condition that it is about, with any fidelity unless the condition has its own.
        text: The claim, in words.
        measure: Computes the figure of one world; None if the world has none.
        over_worlds: How the figures of worlds are combined: their "mean"; their geometric mean ("ratio"); for scores
            against neutral genes of the same world, their standard deviation ("spread") or root mean square
            ("distance"); the "share" of worlds whose figure is above 0; the share that died out by
            `steps` ("extinction"); their "modes", of which there must be two; whether scores differ from those of
            neutral genes in any way ("walk"); or a figure that depends only on the "setting".
        reported: What the source reports.
        low, high: The region in which the claim holds.
        steps: Length that a world must have to be used [step].
        reported_count: For shares, number of worlds of the source with the property, and number of all its worlds; None
            if the source reports no count.
        level: Confidence level of the interval that decides.
        together: Whether a world is used only as long as all its species are alive.
        source: Where the source makes the claim.
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
    """One claim about the order of two conditions.

    Attributes:
        name: Short name, unique together with the conditions.
        first, second: The conditions to compare; they must have the same fidelity.
        text: The claim, in words.
        measure: Computes the figure of one world; None if the world has none.
        comparison: How the first is compared with the second: the "difference" of means, the "ratio" of geometric
            means, or the ratio of standard deviations ("spread").
        reported: What the source reports.
        low, high: The region of the comparison in which the claim holds.
        steps: Length that a world must have to be used [step].
        level, together, source: As for `Claim`.
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
