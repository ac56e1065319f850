"""Distances between futures and between fresh worlds, and which agents have descendants in all futures."""

import math

import numpy as np
import polars as pl
import pytest

from hedon.analysis.world.record import WorldRecord
from hedon.assay.contingency import descent_shares, distance_ratio, lineages_since, overlap
from hedon.config.load import load_config


def world_of(rows: dict[str, list[int | None]]) -> WorldRecord:
    agents = pl.DataFrame(rows, schema=dict.fromkeys(rows, pl.Int64))
    names = (("normal",), ("w_normal", "w_action"), ())
    return WorldRecord("c", "run", 1, load_config("baseline"), *names, agents, pl.DataFrame(), 50, None)


def test_futures_half_as_far_apart_have_a_ratio_of_a_half() -> None:
    fresh = np.linspace(0.0, 1.0, 20)[:, None]
    ratio, low, high, p = distance_ratio([5.0 + 0.5 * fresh, -3.0 - 0.5 * fresh], fresh)
    assert ratio == pytest.approx(0.5)
    assert low < 0.5 < high < 1
    assert p < 0.001
    assert low * high == pytest.approx(0.25), "the interval is symmetric in the logarithm"


def test_worlds_that_end_alike_have_no_ratio() -> None:
    same, other = np.ones((6, 1)), np.arange(6.0)[:, None]
    assert all(math.isnan(each) for each in distance_ratio([same], other))
    assert all(math.isnan(each) for each in distance_ratio([other], same))


def test_the_distance_over_several_genes_is_their_mean() -> None:
    rng = np.random.default_rng(3)
    one, fresh = rng.normal(size=(9, 1)), rng.normal(size=(12, 1))
    assert distance_ratio([np.repeat(one, 4, axis=1)], np.repeat(fresh, 4, axis=1)) == pytest.approx(
        distance_ratio([one], fresh)
    )


def test_the_same_winners_in_all_futures_overlap_fully() -> None:
    shares = np.zeros((4, 30))
    shares[:, :3] = (0.5, 0.3, 0.2)
    found = overlap(1, 10, "agent", shares)
    assert found.overlap == pytest.approx(1.0)
    assert found.chance < 0.3
    assert found.p == pytest.approx(1 / 2001)
    assert (found.agents, found.everywhere, found.nowhere) == (30, 3, 27)


def test_an_overlap_is_the_mean_over_all_pairs_of_futures() -> None:
    shares = np.random.default_rng(1).dirichlet(np.ones(8), size=5)
    pairs = [np.minimum(shares[i], shares[j]).sum() for i in range(5) for j in range(i)]
    assert overlap(1, 10, "agent", shares, draws=1).overlap == pytest.approx(np.mean(pairs))


def test_different_winners_in_each_future_overlap_less_than_by_chance() -> None:
    found = overlap(1, 10, "agent", np.eye(6))
    assert found.overlap == 0
    assert found.p == 1


def test_descent_is_counted_from_agents_alive_at_the_step() -> None:
    rows: dict[str, list[int | None]] = {
        "agent_id": [0, 1, 2, 3, 4, 5, 6],
        # 0 died before step 10; 2 is a child of 1, and both are alive then, so each counts for itself.
        "parent_id": [None, None, 1, 2, 1, 3, None],
        "mate_id": [None, None, None, None, 6, None, None],
        "birth_step": [0, 0, 5, 12, 13, 20, 0],
        "death_step": [9, 30, None, None, None, None, 40],
    }
    world = world_of(rows)
    found = descent_shares(world, 10)
    assert found["agent_id"].to_list() == [1, 2, 6]
    assert found["share"].to_list() == pytest.approx([0.5 / 4, 3 / 4, 0.5 / 4])
    assert lineages_since(10).of(world) == pytest.approx(1 / (0.75**2 + 2 * 0.125**2))


def test_an_extinct_world_has_no_lineages() -> None:
    rows: dict[str, list[int | None]] = {
        "agent_id": [0, 1],
        "parent_id": [None, 0],
        "birth_step": [0, 12],
        "death_step": [20, 30],
    }
    world = world_of(rows)
    assert descent_shares(world, 10)["share"].to_list() == [0.0]
    assert lineages_since(10).of(world) is None
