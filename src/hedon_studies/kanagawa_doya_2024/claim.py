"""What does the paper claim, and what would count as its being so? Each claim with its rule.

A rule names a figure and the *region* in which the claim holds. The figure's 95 % interval over worlds decides: within
the region the claim holds, outside of it it fails, across its border it is undecided. Whether our worlds differ from
the paper's is another question; it can be asked where the paper gives a count of its worlds. The paper gives no spread
for its tables, so "the same" means within a factor that is chosen here. Claims that compare two conditions are in
`order`.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Literal

from scipy import optimize

from hedon.analysis.agent.food import food_per_step
from hedon.analysis.agent.lifetime import mean_lifetime
from hedon.analysis.gene.drift import standard_drift
from hedon.analysis.gene.weight import last_mean
from hedon.analysis.world.population import last_generation, mean_alive, run_tail
from hedon.analysis.world.record import WorldRecord
from hedon.demography.life import cumulative_hazard
from hedon.statistic.interval import LEVEL
from hedon_studies.kanagawa_doya_2024.paper import (
    EXTINCTION,
    EXTINCTION_SEEDS,
    EXTINCTION_STEP,
    LIFESPAN,
    PAPER,
    SEEDS,
    STEPS,
)

SOURCE = "Kanagawa & Doya (2024); docs/model.md, section 14"
SAME_FACTOR = 1.5
"""Lifetimes, rates of food and distances from a start within this factor count as the same."""
MOST = 0.5
"""More than this share is most."""
SOME = (0.05, 0.95)
"""Some worlds die out and some do not if the share of extinct ones lies between these."""
OLD_SHARE = 0.05
"""The lifespan of agents is read as the age that this share of those with full energy reaches."""

WEIGHTS = {"w_normal": "food", "w_action": "action"}
"""The reward weights that all conditions have, and what claims call them."""

Measure = Callable[[WorldRecord], float | None]
"""The figure of one world; None where it has none."""

OverWorlds = Literal["mean", "ratio", "spread", "distance", "share", "extinction", "modes", "walk", "setting"]
"""How the figures of several worlds are summed up."""


Role = Literal["", "hunted"]
"""Which of a world's species a claim is about."""


@dataclass(frozen=True)
class Claim:
    """One claim about one setting.

    Attributes:
        name: short, unique together with the setting.
        preset: that it is about.
        costs: energy for living and for action in the place of the preset's own; None for the preset's.
        text: the claim, in words.
        measure: the figure of one world; None where it has none.
        over_worlds: how the worlds' figures are summed up: their "mean"; their geometric mean ("ratio"); their
            standard deviation ("spread") or root mean square ("distance"), where they are scores against neutral
            genes of the same world; the "share" of worlds whose figure is above 0; the share that died out by
            `steps` ("extinction"); their "modes", of which there must be two; whether scores differ from those of
            neutral genes in any way ("walk"); a figure that the "setting" alone gives.
        low, high: the region in which the claim holds.
        paper: what the paper reports.
        steps: that a world must have lived through to count [step].
        paper_count: worlds of the paper that have it, and all of its worlds, for shares; None where it gives no
            such number.
        level: of the interval that decides.
        role: the species that is asked: "hunted", which another one eats; empty where there is only one.
        together: whether worlds count only as long as none of their species has died out.
        source: where it stands.
    """

    name: str
    preset: str
    text: str
    measure: Measure
    over_worlds: OverWorlds
    paper: str
    low: float = -math.inf
    high: float = math.inf
    steps: int = STEPS
    costs: tuple[float, float] | None = None
    paper_count: tuple[int, int] | None = None
    level: float = LEVEL
    role: Role = ""
    together: bool = False
    source: str = SOURCE


def score(weight: str, world: WorldRecord) -> float | None:
    """A weight's score among neutral genes of the same pedigree; None without a whole pedigree.

    Args:
        weight: a genome column.
        world: a world with its agents.
    """
    return next((found.score for found in standard_drift(world) if found.weight == weight), None)


def lifetime_of_dead(world: WorldRecord) -> float | None:
    """Mean lifetime of the dead [step]."""
    return mean_lifetime(world.agents)


def _above(limit: float, weight: str, world: WorldRecord) -> float | None:
    mean = last_mean(weight, world)
    return None if mean is None else mean - limit


def _below(weight: str, other: str, world: WorldRecord) -> float | None:
    mean, limit = last_mean(weight, world), last_mean(other, world)
    return None if mean is None or limit is None else limit - mean


def _negative(weight: str, world: WorldRecord) -> float | None:
    mean = last_mean(weight, world)
    return None if mean is None else -mean


def _food(world: WorldRecord) -> float | None:
    return food_per_step(world.agents, world.food_kinds)


def _alive(world: WorldRecord) -> float | None:
    return mean_alive(run_tail(world.population))


def _generation(world: WorldRecord) -> float | None:
    return last_generation(world.population)


def _extinct(world: WorldRecord) -> float | None:
    return None if world.extinct_step is None else float(world.extinct_step)


def _lifespan(world: WorldRecord) -> float | None:
    hazard, energy = world.config.hazard, world.config.energy.capacity
    if hazard.alpha_age <= 0:
        return None
    limit = -math.log(OLD_SHARE)

    def left(age: float) -> float:
        return float(cumulative_hazard(hazard, age, energy)) - limit

    return optimize.root_scalar(left, bracket=(0.0, limit / hazard.alpha_age)).root


def _weight_claims() -> Iterator[Claim]:
    for preset in ("baseline", "large", "relocation", "poor", "poison"):
        text, food = "the weight of food evolves positive, in most worlds at least", partial(last_mean, "w_normal")
        every = (SEEDS, SEEDS)
        yield Claim("food weight positive", preset, text, food, "share", "> 0", low=MOST, paper_count=every)
    text, above = "in most worlds the weight of food is above 4", partial(_above, 4.0, "w_normal")
    yield Claim("food weight above 4", "baseline", text, above, "share", "mostly > 4", low=MOST)
    for preset in ("baseline", "large"):
        text, two = "the weight of action has two modes, largely positive or slightly negative", "w_action"
        yield Claim("two modes of action", preset, text, partial(last_mean, two), "modes", "two")
    for weight, name in WEIGHTS.items():
        text = f"the weight of {name} does not go where neutral genes of the same worlds go"
        found = partial(score, weight)
        yield Claim(f"{name} weight no random walk", "baseline", text, found, "walk", "differs")
        for preset in ("small", "centered"):
            text = f"hardly any evolution: {name} moves at most {SAME_FACTOR:g} times as far as neutral genes"
            yield Claim(
                f"{name} weight hardly evolves", preset, text, found, "distance", "hardly any", high=SAME_FACTOR
            )
    text, negative = "in most worlds the weight of action is negative", partial(_negative, "w_action")
    yield Claim("action weight negative", "relocation", text, negative, "share", "mostly < 0", low=MOST)
    for kind in ("poor", "poison"):
        text = f"the weight of {kind} varies widely: at least 1/{SAME_FACTOR:g} as widely as neutral genes"
        weight, low = partial(score, f"w_{kind}"), 1.0 / SAME_FACTOR
        yield Claim(f"{kind} weight varies", kind, text, weight, "spread", "widely", low=low)
    text, poison = "in most worlds the weight of poison is positive", "w_poison"
    yield Claim("poison weight positive", "poison", text, partial(last_mean, poison), "share", "mostly > 0", low=MOST)
    text, below = "in most worlds the weight of poison is below that of food", partial(_below, poison, "w_normal")
    yield Claim("poison weight below food", "poison", text, below, "share", "below", low=MOST)


def _table_claims() -> Iterator[Claim]:
    for preset, figures in PAPER.items():
        for name, value, measure, unit in (
            ("mean lifetime", figures.mean_lifetime, lifetime_of_dead, "step"),
            ("food per step", figures.food_per_step, _food, "1/step"),
        ):
            if value is not None:
                text = f"{name} [{unit}], within a factor of {SAME_FACTOR:g}"
                low, high = value / SAME_FACTOR, value * SAME_FACTOR
                yield Claim(name, preset, text, measure, "ratio", f"{value:g}", low, high)
        for name, bounds, measure in (
            ("population", figures.population, _alive),
            ("generation", figures.generation, _generation),
        ):
            if bounds is not None:
                text = f"{name} at the end, {bounds[0]} to {bounds[1]}"
                low, high = float(bounds[0]), float(bounds[1])
                yield Claim(name, preset, text, measure, "mean", f"{bounds[0]} … {bounds[1]}", low, high)
    text = (
        f"an agent with full energy may live some {LIFESPAN:,} steps: the age that one in {1 / OLD_SHARE:.0f} reaches"
    )
    low, high = LIFESPAN / SAME_FACTOR, LIFESPAN * SAME_FACTOR
    yield Claim("lifespan", "baseline", text, _lifespan, "setting", "about 1e6", low, high, steps=0)


def _extinction_claims() -> Iterator[Claim]:
    for costs, share in EXTINCTION.items():
        if share > MOST:
            low, high, what = MOST, math.inf, "most worlds die out"
        elif share > SOME[0]:
            (low, high), what = SOME, "some worlds die out and some do not"
        else:
            low, high, what = -math.inf, MOST, "most worlds live on"
        yield Claim(
            "extinction",
            "baseline",
            f"{what} by step {EXTINCTION_STEP:,}, at costs {costs[0]:g} and {costs[1]:g}",
            _extinct,
            "extinction",
            f"{100 * share:.0f} %",
            low,
            high,
            steps=EXTINCTION_STEP,
            costs=costs,
            paper_count=(round(share * EXTINCTION_SEEDS), EXTINCTION_SEEDS),
        )


CLAIMS: tuple[Claim, ...] = (*_weight_claims(), *_table_claims(), *_extinction_claims())
