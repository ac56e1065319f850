"""The rule of every claim fails a negative control: worlds in which the claim is false."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from numpy.typing import NDArray
from synthetic_run import write_run

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import load_config
from hedon.demography import expected_lifetime
from hedon.record.reader import open_run
from hedon.study import Claim, Order
from hedon.study.estimate import compare
from hedon.study.verdict import FAILS, HOLDS, judge, place
from hedon_studies.fear.claim import SEQUEL_CLAIMS, SEQUEL_ORDERS
from hedon_studies.kanagawa_doya_2024.claim import CLAIMS
from hedon_studies.kanagawa_doya_2024.order import ORDERS

WORLDS = 12
Floats = NDArray[np.float64]

DRIFT = np.random.default_rng(1).standard_cauchy(WORLDS)
"""Weights that drift, half of them below 0."""
SCORES = np.random.default_rng(2).normal(size=WORLDS)
"""Scores of neutral genes against walks."""


def starving(claim: Claim) -> Floats:
    """Lifetimes of agents that never eat, under the preset of the claim."""
    config = load_config(claim.condition.preset)
    (species,) = config.species.values()
    return np.full(WORLDS, float(expected_lifetime(species.hazard, 0.0)))


def half_of_the_food(claim: Claim) -> Floats:
    return np.full(WORLDS, float(claim.reported) / 2)


CONTROLS: dict[str, tuple[Callable[[Claim], Floats], str]] = {
    "mean lifetime": (starving, FAILS),
    "food per step": (half_of_the_food, FAILS),
    "population": (lambda _: np.zeros(WORLDS), FAILS),
    "generation": (lambda _: np.full(WORLDS, 27.0), FAILS),
    "food weight positive": (lambda _: DRIFT, ""),
    "food weight above 4": (lambda _: DRIFT - 4, ""),
    "action weight negative": (lambda _: -DRIFT, ""),
    "poison weight positive": (lambda _: DRIFT, ""),
    "poison weight below food": (lambda _: DRIFT, ""),
    "two modes of action": (lambda _: SCORES, ""),
    "food weight no random walk": (lambda _: SCORES, ""),
    "action weight no random walk": (lambda _: SCORES, ""),
    "food weight hardly evolves": (lambda _: 4 * SCORES, FAILS),
    "action weight hardly evolves": (lambda _: 4 * SCORES, FAILS),
    "poor weight varies": (lambda _: 0.1 * SCORES, FAILS),
    "poison weight varies": (lambda _: 0.1 * SCORES, FAILS),
    "fear often evolves": (lambda _: np.where(SCORES < -1.96, 1.0, -1.0), ""),
    "liking one's own kind in some worlds": (lambda _: np.full(WORLDS, -1.0), ""),
    "liking predators in some worlds": (lambda _: np.full(WORLDS, -1.0), ""),
    "no fear of weak pitfalls": (lambda _: np.full(WORLDS, 1.0), FAILS),
    "lifespan": (lambda _: np.full(WORLDS, 1e5), FAILS),
}
"""By the name of a claim: values in worlds where it is false, and the verdict; empty if it merely must not hold."""
ALIKE = {
    "action weight lower": (SCORES, SCORES + 0.1),
    "longer lifetime": (np.full(WORLDS, 5095.0) + SCORES, np.full(WORLDS, 5095.0) - SCORES),
    "food weight stable": (SCORES, SCORES[::-1]),
    "action weight stable": (SCORES, SCORES[::-1]),
    "larger mouths, stronger fear": (SCORES, SCORES[::-1]),
    "less food, less liking of one's own kind": (SCORES, SCORES[::-1]),
}
"""By the name of an order: values in two conditions that do not differ."""
EVERY: Sequence[Claim] = [claim for claim in (*CLAIMS, *SEQUEL_CLAIMS) if claim.over_worlds != "extinction"]
FOOD = [claim for claim in CLAIMS if claim.name == "food per step"]
EXTINCTION = [claim for claim in (*CLAIMS, *SEQUEL_CLAIMS) if claim.over_worlds == "extinction"]
PAIRS: Sequence[Order] = (*ORDERS, *SEQUEL_ORDERS)


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("control") / "run"
    return read_worlds([open_run(write_run(folder, worlds=WORLDS, intervals=2, snapshot=False))])


@pytest.mark.parametrize("claim", EVERY, ids=lambda claim: f"{claim.name}, {claim.condition.label}")
def test_a_rule_fails_its_control(claim: Claim, worlds: list[WorldRecord]) -> None:
    make, expected = CONTROLS[claim.name]
    figures = make(claim)
    asked = replace(claim, measure=lambda world: float(figures[world.seed - 1]), steps=0)
    verdict = judge(asked, "control", worlds).verdict
    assert verdict == expected if expected else verdict != HOLDS


@pytest.mark.parametrize(
    "claim", [each for each in EVERY if each.name == "food per step"], ids=lambda c: c.condition.label
)
def test_worlds_without_food_count_against_a_rate_of_food(claim: Claim, worlds: list[WorldRecord]) -> None:
    hungry = [replace(world, agents=world.agents.with_columns(eaten_normal=pl.lit(0))) for world in worlds]
    found = judge(replace(claim, steps=0), "control", hungry)
    assert found.worlds == WORLDS, "a rate of 0 is a number"
    assert found.verdict != HOLDS


@pytest.mark.parametrize("claim", EXTINCTION, ids=lambda claim: claim.condition.label)
def test_a_rule_of_extinction_fails_if_the_opposite_is_true(claim: Claim, worlds: list[WorldRecord]) -> None:
    most_die = claim.low >= 0.5
    asked = replace(claim, steps=1024)
    last = {"last_step": 1024, "extinct_step": None if most_die else 512}
    ended = [replace(worlds[0], seed=seed, **last) for seed in range(100)]
    assert judge(asked, "control", ended).verdict == FAILS


@pytest.mark.parametrize("order", PAIRS, ids=lambda order: f"{order.name}, {order.first.label}")
def test_an_order_does_not_hold_between_conditions_that_do_not_differ(order: Order) -> None:
    _, low, high = compare(order.comparison, *ALIKE[order.name], order.level)
    assert place(low, high, order.low, order.high) != HOLDS
