"""What does the paper claim, and what would count as its being so? Each claim with its rule, stated beforehand.

A rule names a figure and the *region* in which the claim holds. The figure's 95 % interval over worlds decides: within
the region the claim holds, outside of it it fails, across its border it is undecided. The paper gives no spread
for its tables, so "the same" means within a factor that is chosen here.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Literal

from hedon.analysis.drift import start_of
from hedon.analysis.food import food_per_step
from hedon.analysis.lifetime import mean_lifetime
from hedon.analysis.paper import EXTINCTION, EXTINCTION_STEP, PAPER, STEPS
from hedon.analysis.population import last_generation, mean_alive, run_tail
from hedon.analysis.weight import last_agents
from hedon.analysis.world import WorldRecord

SOURCE = "Kanagawa & Doya (2024); docs/model.md, section 13"
SAME_FACTOR = 1.5
"""Lifetimes and rates of food within this factor of the paper's count as the same."""
SAME_SHARE = 0.25
"""Shares of extinct worlds within this of the paper's, which had ten worlds, count as the same."""
HARDLY = 1.0
"""Mean weights that stay within this of their start have hardly evolved: a quarter of the "above 4" of the baseline."""
WIDELY = 1.0
"""Weights whose means have a standard deviation over worlds above this vary widely."""

Measure = Callable[[WorldRecord], float | None]


OverWorlds = Literal["mean", "ratio", "spread", "share", "modes"]
"""How the figures of several worlds are summed up."""


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
            standard deviation ("spread"); the "share" of worlds whose figure is above 0; their "modes", of
            which there must be two.
        low, high: the region in which the claim holds.
        paper: what the paper reports.
        steps: that a world must have lived through to count [step].
        survivors: whether worlds that died out are left out, as the paper replaced them.
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
    survivors: bool = True


def last_mean(weight: str, world: WorldRecord) -> float | None:
    """Mean of a weight over the 5000 agents born last."""
    values = last_agents(world.agents)[weight].to_numpy()
    return float(values.mean(dtype=float)) if len(values) else None


def _above(limit: float, weight: str, world: WorldRecord) -> float | None:
    mean = last_mean(weight, world)
    return None if mean is None else mean - limit


def _negative(weight: str, world: WorldRecord) -> float | None:
    mean = last_mean(weight, world)
    return None if mean is None else -mean


def _largest_move(world: WorldRecord) -> float | None:
    moves = [(last_mean(name, world), start_of(world, name)) for name in world.reward_names]
    return max((abs(mean - start) for mean, start in moves if mean is not None), default=None)


def _lifetime(world: WorldRecord) -> float | None:
    return mean_lifetime(world.agents)


def _food(world: WorldRecord) -> float | None:
    return food_per_step(world.agents, world.food_kinds)


def _alive(world: WorldRecord) -> float | None:
    return mean_alive(run_tail(world.population))


def _generation(world: WorldRecord) -> float | None:
    return last_generation(world.population)


def _died_out(world: WorldRecord) -> float | None:
    extinct = world.extinct_step is not None and world.extinct_step <= EXTINCTION_STEP
    return 1.0 if extinct else 0.0


def _weight_claims() -> Iterator[Claim]:
    food = partial(last_mean, "w_normal")
    for preset in ("baseline", "large", "relocation", "poor", "poison"):
        yield Claim("food weight positive", preset, "the weight of food evolves positive", food, "mean", "> 0", low=0.0)
    for preset in ("baseline", "large"):
        above, two = partial(_above, 4.0, "w_normal"), partial(last_mean, "w_action")
        text = "in most worlds the weight of food is above 4"
        yield Claim("food weight above 4", preset, text, above, "share", "mostly > 4", low=0.5)
        text = "the weight of action has two modes, largely positive or slightly negative"
        yield Claim("two modes of action", preset, text, two, "modes", "two")
    for preset in ("small", "centered"):
        text = "hardly any evolution: no weight moves by more than 1"
        yield Claim("hardly any evolution", preset, text, _largest_move, "mean", "hardly any", high=HARDLY)
    text, negative = "in most worlds the weight of action is negative", partial(_negative, "w_action")
    yield Claim("action weight negative", "relocation", text, negative, "share", "mostly < 0", low=0.5)
    for kind in ("poor", "poison"):
        text, weight = f"the weight of {kind} varies widely between worlds", partial(last_mean, f"w_{kind}")
        yield Claim(f"{kind} weight varies", kind, text, weight, "spread", "widely", low=WIDELY)


def _table_claims() -> Iterator[Claim]:
    for preset, figures in PAPER.items():
        for name, value, measure, unit in (
            ("mean lifetime", figures.mean_lifetime, _lifetime, "step"),
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


def _extinction_claims() -> Iterator[Claim]:
    for costs, share in EXTINCTION.items():
        text = f"share of worlds extinct by step {EXTINCTION_STEP:,}, at costs {costs[0]:g} and {costs[1]:g}"
        low, high = share - SAME_SHARE, share + SAME_SHARE
        yield Claim(
            "extinction",
            "baseline",
            text,
            _died_out,
            "share",
            f"{100 * share:.0f} %",
            low if low > 0 else -math.inf,
            high if high < 1 else math.inf,
            steps=EXTINCTION_STEP,
            costs=costs,
            survivors=False,
        )


CLAIMS: tuple[Claim, ...] = (*_weight_claims(), *_table_claims(), *_extinction_claims())
