"""The sequel's claims about prey that see predators, each with the rule that decides it.

The rules were written before any run of full length, but after short assays and two worlds of 425,570 steps were read.

The source is Kanagawa & Doya, "Evolution of Fear and Social Rewards in Prey-Predator Relationship", arXiv 2507.09992,
version 2 of 7 February 2026, whose claims are (a) to (e) here. Version 1 made other claims: fear only after social
reward, and positive rewards for threats that stand still. Its figures show five runs of 10,240,000 steps per condition,
after extinct runs were replaced: 5 of 6, 5 of 13, 5 of 6 and 5 of 7 were kept. Each verdict here therefore reports the
share of all worlds that keeps its species.

A weight is measured by its *score* in its world: the end of its mean among neutral genes of the same pedigree, in
standard deviations of drift. A world in which weights wander far therefore has no more influence than others. The
claims form one family: by Bonferroni's inequality, the level of each interval limits the chance of any false verdict to
5 %. Worlds in which a species died out are left out, since fear is not selected without predators.
"""

from functools import partial

from hedon.analysis import WorldRecord
from hedon.config import hunters
from hedon.measure import WorldNumber
from hedon.study import Claim, Condition, Order
from hedon_studies.kanagawa_doya_2024.claim import score
from hedon_studies.kanagawa_doya_2024.paper import STEPS

SEQUEL = "Kanagawa & Doya, arXiv 2507.09992v2"
FAR = 1.96
"""Size of a score beyond which it is in the outer 5 % of neutral genes."""
BY_CHANCE = 0.025
"""Share of worlds in which a neutral gene is that far out on one side."""
OFTEN = 0.25
"""Share of worlds from which we speak of "often": ten times as many as by chance. The value is our choice."""
FAMILY = 6
"""Number of verdicts that are corrected together."""
FAMILY_LEVEL = 1.0 - 0.05 / FAMILY


def own_score(world: WorldRecord) -> float | None:
    """The score of the weight for seeing one's own species; None without a complete pedigree."""
    return score(f"w_see_{world.species}", world)


def hunter_score(world: WorldRecord) -> float | None:
    """The score of the weight for seeing a species that eats one's own, the lowest if several; None as for `score`."""
    scores = [score(f"w_see_{name}", world) for name in hunters(world.config, world.species)]
    return min((value for value in scores if value is not None), default=None)


def fear(world: WorldRecord) -> float | None:
    """The score of the dislike of seeing a species that eats one's own; None as for `score`."""
    value = hunter_score(world)
    return None if value is None else -value


def _obstacle_fear(world: WorldRecord) -> float | None:
    value = score("w_see_obstacle", world)
    return None if value is None else -value


def _beyond_drift(measure: WorldNumber, world: WorldRecord) -> float | None:
    """How far a score is above the 97.5 % point of neutral genes; None as for the score."""
    value = measure(world)
    return None if value is None else value - FAR


def _prey(preset: str) -> Condition:
    return Condition(preset, preset, species="prey")


_ONE = {"steps": STEPS, "level": FAMILY_LEVEL, "together": True}
_claim = partial(Claim, **_ONE)
_order = partial(Order, comparison="difference", **_ONE)


def _source(letter: str) -> str:
    return f"{SEQUEL}, claim ({letter})"


SEQUEL_CLAIMS: tuple[Claim, ...] = (
    _claim(
        "fear often evolves",
        _prey("predator"),
        f"in more than {100 * OFTEN:g} % of worlds the weight of seeing predators is below 97.5 % of neutral genes",
        partial(_beyond_drift, fear),
        "share",
        "often < 0",
        low=OFTEN,
        source=_source("a"),
    ),
    _claim(
        "liking one's own kind in some worlds",
        _prey("predator"),
        "the weight of seeing prey is above 97.5 % of neutral genes in more worlds than by chance",
        partial(_beyond_drift, own_score),
        "share",
        "> 0 in some",
        low=BY_CHANCE,
        source=_source("b"),
    ),
    _claim(
        "liking predators in some worlds",
        _prey("predator"),
        "the weight of seeing predators is above 97.5 % of neutral genes in more worlds than by chance",
        partial(_beyond_drift, hunter_score),
        "share",
        "> 0 in some",
        low=BY_CHANCE,
        source=_source("b"),
    ),
    _claim(
        "no fear of weak pitfalls",
        Condition("pitfall-weak", "pitfall-weak"),
        f"the weight of seeing obstacles is below 97.5 % of neutral genes in less than {100 * OFTEN:g} % of worlds",
        partial(_beyond_drift, _obstacle_fear),
        "share",
        "no fear",
        high=OFTEN,
        source=_source("e"),
    ),
)

SEQUEL_ORDERS: tuple[Order, ...] = (
    _order(
        "larger mouths, stronger fear",
        _prey("predator-large-mouth"),
        _prey("predator-small-mouth"),
        "the score of fear is higher where predators have mouths of 80 degrees than of 40",
        fear,
        reported="stronger",
        low=0.0,
        source=_source("c"),
    ),
    _order(
        "less food, less liking of one's own kind",
        _prey("predator-less-food"),
        _prey("predator"),
        "the score of the weight of seeing prey is lower with three fifths of the food",
        own_score,
        reported="more negative",
        high=0.0,
        source=_source("d"),
    ),
)
