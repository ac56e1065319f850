"""A step that repeats its actions equals as many single steps: in rewards, births, deaths, meals and worlds."""

from typing import Any

import numpy as np
import pytest
from worlds import QUICK

from hedon import load_config, make
from hedon.env import VectorEnv

CROWD = (
    *QUICK,
    "birth.kappa=0.2",
    "hazard.alpha_age=0.05",
    "population.capacity=60",
    "population.initial_count=40",
    "food.normal.initial_count=80",
    "food.normal.capacity=100",
)
"""Slots change hands every few steps."""
HUNT = (
    *QUICK,
    "species.prey.body.radius=10",
    "species.hunter.body.radius=10",
    "species.hunter.sensor.mouth_spread=180",
    'species.hunter.diet.eats=[["prey", 0.6], ["normal", 1.0]]',
    "population.initial_count=45",
    "population.capacity=60",
    "birth.kappa=0.2",
    "hazard.alpha_age=0.05",
)
"""Two driven species, one of which eats the other."""


class Told:
    """The results of single steps, summed over a repeat in plain Python; rewards are by world and id."""

    def __init__(self, group: Any) -> None:
        self.group = group
        self.before = group.ids.copy()
        self.paid = {(w, int(i)): np.float32(0) for w, row in enumerate(group.ids) for i in row if i >= 0}
        self.born: dict[tuple[int, int], int] = {}
        self.dead: set[tuple[int, int]] = set()
        self.meals = np.zeros_like(group.meals)

    def note(self) -> None:
        group = self.group
        for w, slot in np.argwhere(group.ids_before >= 0).tolist():
            self.paid[w, int(group.ids_before[w, slot])] += group.rewards[w, slot]
        for w, slot in np.argwhere(group.terminated).tolist():
            self.dead.add((w, int(group.ids_before[w, slot])))
        for w, slot in np.argwhere(group.born).tolist():
            self.born[w, int(group.ids[w, slot])] = slot
            self.paid[w, int(group.ids[w, slot])] = np.float32(0)
        self.meals += group.meals


def compare(told: Told, group: Any) -> None:
    """Checks that one call with a repeat gives the same results."""
    np.testing.assert_array_equal(group.ids_before, told.before)
    for (w, slot), identity in np.ndenumerate(told.before):
        assert group.rewards[w, slot] == told.paid.get((w, int(identity)), 0)
        assert group.terminated[w, slot] == ((w, int(identity)) in told.dead)
    rows = group.newborns
    assert {(int(row["world"]), int(row["agent_id"])): int(row["slot"]) for row in rows} == told.born
    for row in rows:
        known = (int(row["world"]), int(row["agent_id"]))
        assert row["reward"] == told.paid[known]
        assert row["alive"] == (known not in told.dead)
    assert group.births.tolist() == [sum(w == world for w, _ in told.born) for world in range(len(group.ids))]
    assert group.deaths.tolist() == [sum(w == world for w, _ in told.dead) for world in range(len(group.ids))]
    np.testing.assert_array_equal(group.meals, told.meals)
    everything = group.rewards.sum(dtype=np.float64) + rows["reward"].sum(dtype=np.float64)
    assert everything == pytest.approx(sum(map(float, told.paid.values())), abs=1e-6)


@pytest.mark.parametrize("settings", [CROWD, HUNT], ids=["crowd", "hunt"])
@pytest.mark.parametrize("repeat", [1, 2, 7, 70])
def test_a_repeat_equals_as_many_single_steps(settings, repeat):
    config = load_config("baseline", overrides=settings)
    single, held = (make(config, 2, seed=1, repeat=each, actions="logit", threads=1) for each in (1, repeat))
    rng = np.random.default_rng(repeat)
    short = 0
    for _ in range(max(3, 70 // repeat)):
        said = {}
        for name, group in single.groups.items():
            group.actions[...] = rng.standard_normal(group.actions.shape)
            held.groups[name].actions[...] = group.actions
            said[name] = Told(group)
        for _ in range(repeat):
            single.step(single.actions)
            for told in said.values():
                told.note()
        held.step(held.actions)
        for name, group in held.groups.items():
            compare(said[name], group)
            for array in ("ids", "observations"):
                np.testing.assert_array_equal(getattr(group, array), getattr(single.groups[name], array))
            short += int((~group.newborns["alive"]).sum())
        assert digests(single) == digests(held)
    if repeat != 2:
        assert (short > 0) == (repeat > 1), "some are born and die within a repeat"


def digests(worlds: VectorEnv) -> list[str]:
    return [world.digest() for world in worlds.simulation.worlds]


def test_the_results_of_repeats_agree_with_the_worlds():
    """Over many repeats: all births, deaths, meals, and the rewards of whole lives."""
    worlds = make(load_config("baseline", overrides=CROWD), seed=3, repeat=10, threads=1)
    group, world = worlds.groups["agent"], worlds.simulation.worlds[0]
    births = deaths = 0
    meals, paid = np.zeros_like(group.meals), 0.0
    for _ in range(12):
        worlds.step(worlds.actions)
        births, deaths = births + group.births.sum(), deaths + group.deaths.sum()
        meals += group.meals
        paid += group.rewards.sum(dtype=np.float64) + group.newborns["reward"].sum(dtype=np.float64)
    assert births == world.counters["births"] > 50
    assert deaths == world.counters["deaths"] > 50
    assert group.meal_names == ("normal",)
    assert meals[0, 0] == world.view("food_stock.eaten")[0] > 10
    lives = world.agents()["reward"].sum() + world.deaths()["reward"].sum()
    assert paid == pytest.approx(lives, rel=1e-5)
