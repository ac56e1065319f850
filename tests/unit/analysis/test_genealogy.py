import dataclasses
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from analysis_tree import lines, random_tree
from synthetic_run import write_run

from hedon.analysis.descent.genealogy import (
    ALIVE,
    Genealogy,
    ancestry,
    common_ancestor,
    depth,
    families,
    founder,
    genealogy,
    living_at,
)
from hedon.analysis.descent.generation import generation_time
from hedon.analysis.descent.walk import MutationLaw, birth_number, is_mutated
from hedon.analysis.world.record import read_worlds
from hedon.record.reader import open_run
from hedon.statistic.price import price

# Two founders; 0 has 2, 2 has 3 and 4, 3 has 5; 1 has 6, which dies. 4 and 5 are alive.
AGENTS = pl.DataFrame(
    {
        "agent_id": [10, 11, 12, 13, 14, 15, 16],
        "parent_id": [None, None, 10, 12, 12, 13, 11],
        "generation": [0, 0, 1, 2, 2, 3, 1],
        "birth_step": [0, 0, 5, 10, 20, 25, 30],
        "death_step": [50, 40, 60, 70, None, None, 80],
        "w_normal": [1.0, 2.0, 1.5, 1.25, 2.5, 1.0, 2.0],
    },
    schema_overrides={"parent_id": pl.Int64, "death_step": pl.Int64},
)


def test_the_small_pedigree() -> None:
    tree = genealogy(AGENTS)
    assert tree.parent.tolist() == [-1, -1, 0, 2, 2, 3, 1]
    assert tree.gaps == 0
    assert depth(tree).tolist() == AGENTS["generation"].to_list()
    assert founder(tree).tolist() == [0, 1, 0, 0, 0, 0, 1]
    assert np.flatnonzero(tree.alive).tolist() == [4, 5]
    assert common_ancestor(tree, np.array([4, 5])) == 2
    assert common_ancestor(tree, np.array([3, 5])) == 3  # one of them is the ancestor of the other
    assert common_ancestor(tree, np.array([5, 6])) is None  # from two founders
    assert common_ancestor(tree, np.array([], np.int64)) is None
    assert families(tree, np.array([0, 39, 79, 80, 1000])).tolist() == [2, 2, 2, 1, 1]
    assert living_at(tree, 25).tolist() == [0, 1, 2, 3, 4, 5]


def test_random_pedigrees_agree_with_tracing_each_line() -> None:
    rng = np.random.default_rng(1)
    for trial in range(40):
        tree = random_tree(rng, 120, 1 + trial % 4)
        paths = [lines(tree, i) for i in range(tree.size)]
        assert depth(tree).tolist() == [len(path) - 1 for path in paths]
        assert founder(tree).tolist() == [path[-1] for path in paths]
        some = rng.choice(tree.size, 3, replace=False)
        assert np.flatnonzero(ancestry(tree, some)).tolist() == sorted({a for i in some for a in paths[i]})
        shared = set.intersection(*(set(paths[i]) for i in some))
        assert common_ancestor(tree, some) == (max(shared) if shared else None)
        at = int(rng.integers(0, 200))
        alive = [i for i in range(tree.size) if tree.birth[i] <= at < tree.death[i]]
        beyond = {founder(tree)[i] for i in range(tree.size) if tree.death[i] > at} if at >= 0 else set()
        assert living_at(tree, at).tolist() == alive
        assert families(tree, np.array([at]))[0] == len(beyond)


def test_a_parent_without_a_record_is_a_gap() -> None:
    tree = genealogy(AGENTS.filter(pl.col("agent_id") != 12))
    assert tree.gaps == 2
    assert depth(tree).tolist() == [0, 0, 0, 0, 1, 1]


def test_generation_time_by_both_measures() -> None:
    found = generation_time(AGENTS, 100)
    ages = [5, 5, 15, 15, 30]
    assert (found["births"], found["parent_age"], found["reached"]) == (5, np.mean(ages), 2.5)
    assert found["parent_age_sd"] == pytest.approx(np.std(ages, ddof=1))
    assert found["line_time"] == 40
    nobody = generation_time(AGENTS.head(2).with_columns(death_step=pl.lit(9, pl.Int64)), 9)
    assert (nobody["parent_age"], nobody["reached"], nobody["line_time"]) == (None, 0, None)


def test_the_age_of_parents_includes_both_parents() -> None:
    mates = pl.Series("mate_id", [None, None, 11, 11, 11, 14, None], pl.Int64)
    found = generation_time(AGENTS.with_columns(mates), 100)
    ages = [5, 5, 15, 15, 30, 5, 10, 20, 5]
    assert (found["births"], found["parent_age"]) == (5, np.mean(ages))
    assert found["parent_age_sd"] == pytest.approx(np.std(ages, ddof=1))


def test_price_on_the_small_pedigree() -> None:
    parent, weight = genealogy(AGENTS).parent, AGENTS["w_normal"].to_numpy()
    cohort = np.array([True, True, True, False, False, False, False])
    terms = price(weight, parent, cohort)
    # Parents of weights 1, 2 and 1.5 have 1, 1 and 2 children, of weights 1.5; 2; 1.25 and 2.5.
    assert (terms["parents"], terms["offspring"]) == (3, 4)
    assert terms["change"] == pytest.approx(7.25 / 4 - 1.5)
    assert terms["selection"] == pytest.approx(np.cov([1, 1, 2], [1, 2, 1.5], ddof=0)[0, 1] / (4 / 3))
    assert terms["transmission"] == pytest.approx((1 * 0.5 + 1 * 0.0 + 2 * 0.375) / 3 / (4 / 3))
    childless = price(weight, parent, np.arange(7) == 5)
    assert np.isnan(childless["change"])


def test_price_closes_on_records(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", worlds=2, intervals=40, snapshot=False, selection=1.0))
    for world in read_worlds([run]):
        tree = genealogy(world.agents)
        cohort = tree.birth < 20_000
        for name in world.weight_names:
            terms = price(world.agents[name].to_numpy().astype(np.float64), tree.parent, cohort)
            assert abs(terms["residual"]) < 1e-14
            assert terms["offspring"] == world.agents.filter(cohort)["children"].sum()
            assert terms["selection"] != 0
        food = price(world.agents["w_normal"].to_numpy().astype(np.float64), tree.parent, cohort)
        assert food["selection"] > 0  # the synthetic worlds select on it


def test_births_are_numbered_within_their_window() -> None:
    #            founders   window 0 (steps 1 to 10)  window 1
    birth = np.array([0, 0, 1, 9, 10, 11, 11, 20])
    tree = Genealogy(np.array([-1, -1, 0, 1, 1, 0, 2, 2]), birth, birth + 5, 0)
    # Three births in both windows. If the previous window's births count, those of the first window follow none.
    assert birth_number(tree, 10, late=True).tolist() == [0, 0, 0, 1, 2, 0, 1, 2]
    assert birth_number(tree, 10, late=False).tolist() == [0, 0, 0, 1, 2, 3, 4, 5]
    # Two windows of 11 steps have five births and one.
    assert birth_number(tree, 11, late=True).tolist() == [0, 0, 1, 2, 3, 4, 5, 0]


def test_an_agent_that_died_before_its_window_ended_never_had_its_own_genome() -> None:
    law = MutationLaw(mean=0.0, sd=0.0, scale=0.1, limit=10.0, tabulated=False, window=10, late=True)
    #                 founder  lives on  dies first  its child  too late to know
    tree = Genealogy(np.array([-1, 0, 0, 2, 1]), np.array([0, 3, 3, 5, 21]), np.array([ALIVE, 30, 10, ALIVE, ALIVE]), 0)
    assert is_mutated(tree, law, last_step=25).tolist() == [False, True, False, False, False]
    assert is_mutated(tree, law, last_step=30).tolist() == [False, True, False, False, True]
    at_birth = dataclasses.replace(law, late=False)
    assert is_mutated(tree, at_birth, last_step=25).tolist() == [False, True, True, True, True]
