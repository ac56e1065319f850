"""Compares two worlds of the reference model, up to the rounding of the engine.

The engine holds places, forces and rewards in float32, the reference in float64.
"""

from dataclasses import fields

import numpy as np
import pytest
from reference.state import Agent, World

PLACE = 1e-4
"""Places below 1000 u round by 3e-5 u, as do the products and normals from which they are computed."""
ANGLE = 1e-6
"""Angles below 2π round by 2.4e-7 rad, twice."""
FORCE = 5e-7
"""Share of the largest force: forces round by 6e-8 of it, four times up to their norm."""
WEIGHT = 1e-6
"""Weights below 10 round by 5e-7; noise of up to 20 rounds once more."""
REWARD = 2e-6
"""Share of the largest weights: rewards round in proportion to them, a few times."""

MEASURED = ("x", "y", "angle", "genome", "distance", "force_left", "force_right", "reward")
"""Fields of an agent that round differently from energy."""
EXACT = (
    *("agent_id", "species", "parent_id", "mate_id", "generation", "birth_step", "children", "eaten"),
    *("digestion", "ready_until", "resident_slot", "births"),
)
STORED = ("energy", "store", "birth_energy", "energy_gained", "energy_spent")
assert {*MEASURED, *EXACT, *STORED, "memory", "last"} == {each.name for each in fields(Agent)}


def assert_close(actual, expected, tolerance, share=1e-12):
    """Like `np.testing.assert_allclose`, but much faster if nothing is wrong."""
    one, other = np.asarray(actual, float), np.asarray(expected, float)
    if one.shape != other.shape or not np.all(np.abs(one - other) <= tolerance + share * np.abs(other)):
        np.testing.assert_allclose(one, other, rtol=share, atol=tolerance)


def column(world: World, name: str) -> np.ndarray:
    """A field of all agents; if it has several numbers per agent, they are concatenated."""
    values = [getattr(agent, name) for agent in world.agents]
    if name == "store":
        values = [np.array(list(each.values()), float) for each in values]
    return np.concatenate([*values, np.zeros(0)]) if name in ("genome", "memory", "last", "store") else np.array(values)


def assert_same_world(
    actual: World, expected: World, costs: float, force: float, late: bool, unsure: frozenset[int] = frozenset()
) -> None:
    """Asserts that two worlds are the same: `costs` and `force` are tolerances for costs and forces, `late` is whether
    genomes of vacancies matter, and `unsure` holds the ids of agents whose rewards are unknown."""
    for name in ("step", "next_agent_id", "births_in_window", "births_before"):
        assert getattr(actual, name) == getattr(expected, name), name
    counts = all(agent.births is not None for agent in actual.agents)
    for name in EXACT if counts else set(EXACT) - {"births"}:
        assert [getattr(a, name) for a in actual.agents] == [getattr(a, name) for a in expected.agents], name
    tolerances = {
        **dict.fromkeys(STORED, costs),
        **dict.fromkeys(("x", "y", "distance"), PLACE),
        **dict.fromkeys(("force_left", "force_right"), force),
        "genome": WEIGHT,
    }
    for name, tolerance in tolerances.items():
        assert_close(column(actual, name), column(expected, name), tolerance)
    angle, turned = column(actual, "angle"), column(actual, "angle") - column(expected, "angle")
    assert np.all((angle >= 0) & (angle < 2 * np.pi))
    assert_close((turned + np.pi) % (2 * np.pi), np.full(len(angle), np.pi), ANGLE)
    assert_close(column(actual, "memory"), column(expected, "memory"), 1e-5, 1e-5)
    assert_close(column(actual, "last"), column(expected, "last"), 1e-4, 1e-5)
    largest = 1 + np.abs(column(expected, "genome")).max(initial=0) ** 2
    known = [agent.agent_id not in unsure for agent in expected.agents]
    assert_close(column(actual, "reward")[known], column(expected, "reward")[known], REWARD * largest, REWARD)
    for a, e in zip(actual.vacancies, expected.vacancies, strict=True):
        assert [vacancy.resident_slot for vacancy in a] == [vacancy.resident_slot for vacancy in e]
        if late:
            for one, other in zip(a, e, strict=True):
                assert_close(one.genome, other.genome, WEIGHT)
    assert [(n.agent_id, n.species, n.parent) for n in actual.newborns] == [
        (n.agent_id, n.species, n.parent) for n in expected.newborns
    ]
    for a, e in zip(actual.newborns, expected.newborns, strict=True):
        if e.parent < 0:
            assert_close(a.genome, e.genome, WEIGHT)
    eaten_foods = [np.sort(np.reshape(world.eaten_foods, (-1, 3)), 0) for world in (actual, expected)]
    assert_close(eaten_foods[0], eaten_foods[1], PLACE)
    for a, e in zip(actual.stocks, expected.stocks, strict=True):
        assert (a.eaten, a.center, len(a.foods)) == (e.eaten, e.center, len(e.foods))
        assert a.number == pytest.approx(e.number, abs=1e-12)
        assert_close(sorted(a.foods), sorted(e.foods), PLACE)
    if len(actual.sums) > 1 or len(actual.meals[0]) > len(actual.stocks):
        assert actual.meals == expected.meals
    for a, e in zip(actual.sums, expected.sums, strict=True):
        for name in e:
            slack = (len(expected.agents) + 50) * costs if name.startswith("energy") else 0
            assert a[name] == pytest.approx(e[name], rel=1e-12, abs=slack), name
