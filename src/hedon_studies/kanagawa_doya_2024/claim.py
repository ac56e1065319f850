"""The paper's claims about single conditions, each with the rule that decides it.

The paper gives no spread for its tables, so "the same" means within a factor that is chosen here. Claims that compare
two conditions are in `order`.
"""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

from lazy_loader import load

from hedon.analysis import LAST_AGENTS, WorldRecord, last_mean, standard_drift
from hedon.demography import cumulative_hazard
from hedon.measure import MEASURES
from hedon.study import Claim, Condition
from hedon_studies.kanagawa_doya_2024.extinction import CONDITIONS
from hedon_studies.kanagawa_doya_2024.paper import (
    EXTINCTION_SEEDS,
    EXTINCTION_STEP,
    LIFESPAN,
    PAPER,
    SEEDS,
    STEPS,
)

optimize: Any = load("scipy.optimize", suppress_warning=True)

SOURCE = "Kanagawa & Doya (2024); docs/model.md, section 14"
SAME_FACTOR = 1.5
"""Rates of food and distances from a start within this factor count as the same; half as much food does not."""
SAME_LIFETIME = 1.1
"""Lifetimes within this factor count as the same. An agent that never eats lives 5,095 steps: 0.81 of the paper's value
for the baseline and 0.89 of its value for the large arena. With a wider factor, the rule could not fail."""
MOST = 0.5
"""Share above which we speak of most worlds."""
SOME = (0.05, 0.95)
"""Range of the share of extinct worlds in which some worlds die out and some do not."""
OLD_SHARE = 0.05
"""The lifespan of agents is read as the age that this share of agents with full energy reaches."""

WEIGHTS = {"w_normal": "food", "w_action": "action"}
"""The reward weights that all conditions have, with their names in claims."""

_claim = partial(Claim, steps=STEPS, source=SOURCE)


def _about(preset: str) -> Condition:
    return Condition(preset, preset)


def score(weight: str, world: WorldRecord) -> float | None:
    """A weight's score among neutral genes of the same pedigree; None without a complete pedigree.

    Args:
        weight: Genome column of the weight.
        world: The world.
    """
    return next((drift.score for drift in standard_drift(world, LAST_AGENTS) if drift.weight == weight), None)


def _above(limit: float, weight: str, world: WorldRecord) -> float | None:
    mean = last_mean(weight, world)
    return None if mean is None else mean - limit


def _below(weight: str, other: str, world: WorldRecord) -> float | None:
    mean, limit = last_mean(weight, world), last_mean(other, world)
    return None if mean is None or limit is None else limit - mean


def _negative(weight: str, world: WorldRecord) -> float | None:
    mean = last_mean(weight, world)
    return None if mean is None else -mean


def _extinct(world: WorldRecord) -> float | None:
    return None if world.extinct_step is None else float(world.extinct_step)


def _lifespan(world: WorldRecord) -> float | None:
    hazard, energy = world.species_config.hazard, world.species_config.energy.capacity
    if hazard.alpha_age <= 0:
        return None
    limit = -math.log(OLD_SHARE)

    def left(age: float) -> float:
        return float(cumulative_hazard(hazard, age, energy)) - limit

    return optimize.root_scalar(left, bracket=(0.0, limit / hazard.alpha_age)).root


def _weight_claims() -> Iterator[Claim]:
    for preset in ("baseline", "large", "relocation", "poor", "poison"):
        text, food = "the weight of food evolves positive, in most worlds at least", partial(last_mean, "w_normal")
        all_seeds = (SEEDS, SEEDS)
        yield _claim(
            "food weight positive", _about(preset), text, food, "share", "> 0", low=MOST, reported_count=all_seeds
        )
    text, is_above = "in most worlds the weight of food is above 4", partial(_above, 4.0, "w_normal")
    yield _claim("food weight above 4", _about("baseline"), text, is_above, "share", "mostly > 4", low=MOST)
    for preset in ("baseline", "large"):
        text, gene = "the weight of action has two modes, largely positive or slightly negative", "w_action"
        yield _claim("two modes of action", _about(preset), text, partial(last_mean, gene), "modes", "two")
    for weight, name in WEIGHTS.items():
        text = f"the weight of {name} does not go where neutral genes of the same worlds go"
        measure = partial(score, weight)
        yield _claim(f"{name} weight no random walk", _about("baseline"), text, measure, "walk", "differs")
        for preset in ("small", "centered"):
            text = f"hardly any evolution: {name} moves at most {SAME_FACTOR:g} times as far as neutral genes"
            yield _claim(
                f"{name} weight hardly evolves",
                _about(preset),
                text,
                measure,
                "distance",
                "hardly any",
                high=SAME_FACTOR,
            )
    text, negative = "in most worlds the weight of action is negative", partial(_negative, "w_action")
    yield _claim("action weight negative", _about("relocation"), text, negative, "share", "mostly < 0", low=MOST)
    for kind in ("poor", "poison"):
        text = f"the weight of {kind} varies widely: at least 1/{SAME_FACTOR:g} as widely as neutral genes"
        weight, low = partial(score, f"w_{kind}"), 1.0 / SAME_FACTOR
        yield _claim(f"{kind} weight varies", _about(kind), text, weight, "spread", "widely", low=low)
    text, poison = "in most worlds the weight of poison is positive", "w_poison"
    yield _claim(
        "poison weight positive", _about("poison"), text, partial(last_mean, poison), "share", "mostly > 0", low=MOST
    )
    text, is_below = "in most worlds the weight of poison is below that of food", partial(_below, poison, "w_normal")
    yield _claim("poison weight below food", _about("poison"), text, is_below, "share", "below", low=MOST)


def _table_claims() -> Iterator[Claim]:
    for preset, reported in PAPER.items():
        for name, value, measure, unit, factor in (
            ("mean lifetime", reported.mean_lifetime, MEASURES["mean_lifetime"].of, "step", SAME_LIFETIME),
            ("food per step", reported.food_per_step, MEASURES["food_per_step"].of, "1/step", SAME_FACTOR),
        ):
            if value is not None:
                text = f"{name} [{unit}], within a factor of {factor:g}"
                low, high = value / factor, value * factor
                yield _claim(name, _about(preset), text, measure, "ratio", f"{value:g}", low, high)
        for name, bounds, measure in (
            ("population", reported.population, MEASURES["alive_mean"].of),
            ("generation", reported.generation, MEASURES["generation"].of),
        ):
            if bounds is not None:
                text = f"{name} at the end, {bounds[0]} to {bounds[1]}"
                low, high = float(bounds[0]), float(bounds[1])
                yield _claim(name, _about(preset), text, measure, "mean", f"{bounds[0]} … {bounds[1]}", low, high)
    text = (
        f"an agent with full energy may live some {LIFESPAN:,} steps: the age that one in {1 / OLD_SHARE:.0f} reaches"
    )
    low, high = LIFESPAN / SAME_FACTOR, LIFESPAN * SAME_FACTOR
    yield _claim("lifespan", _about("baseline"), text, _lifespan, "setting", "about 1e6", low, high, steps=0)


def _extinction_claims() -> Iterator[Claim]:
    for condition, share in CONDITIONS.items():
        if share > MOST:
            low, high, outcome = MOST, math.inf, "most worlds die out"
        elif share > SOME[0]:
            (low, high), outcome = SOME, "some worlds die out and some do not"
        else:
            low, high, outcome = -math.inf, MOST, "most worlds live on"
        yield _claim(
            "extinction",
            condition,
            f"{outcome} by step {EXTINCTION_STEP:,}, at costs {condition.label.replace(', ', ' and ')}",
            _extinct,
            "extinction",
            f"{100 * share:.0f} %",
            low,
            high,
            steps=EXTINCTION_STEP,
            reported_count=(round(share * EXTINCTION_SEEDS), EXTINCTION_SEEDS),
        )


CLAIMS: tuple[Claim, ...] = (*_weight_claims(), *_table_claims(), *_extinction_claims())
