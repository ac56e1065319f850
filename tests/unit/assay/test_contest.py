"""Two groups: a known difference is found, and equal groups do not win."""

import numpy as np
import polars as pl
import pytest
from assay_world import birth_death_world
from scipy import stats

from hedon.assay.contest import Contest, Lines, by_descent, by_gene, estimate, points_of, world_lines
from hedon.assay.landscape import AssayError
from hedon.assay.report_contest import contest_tables, draw_contest
from hedon.config import ONLY
from hedon.record.founder import join, make_founders


def lines(rng: np.random.Generator, birth: tuple[float, float], share: float = 0.5, *, count=40, steps=3000) -> Lines:
    """One world in which the two groups give birth at these rates per step and die at 1e-3."""
    first = np.arange(count) < share * count
    rng.shuffle(first)
    rates = np.where(first, *birth)
    agents = birth_death_world({"w_normal": rates}, lambda genes: genes["w_normal"], rng, steps=steps)
    return world_lines(agents, 1, by_descent(agents, first.tolist()), steps)


def contest(rng: np.random.Generator, birth: tuple[float, float], worlds: int, share: float = 0.5) -> Contest:
    return estimate(("a", "b"), [lines(rng, birth, share) for _ in range(worlds)], 3000)


def test_a_known_difference_is_found_with_its_size() -> None:
    # The log of the ratio changes by the difference of the rates of birth per step, and a generation lasts one over
    # their mean: s = 2e-4 / 1e-3 per generation.
    found = contest(np.random.default_rng(1), (1.1e-3, 0.9e-3), 40)
    assert found.result.selection.low <= 0.2 <= found.result.selection.high
    assert found.result.selection.low > 0
    assert found.p < 0.01
    assert found.result.generations == pytest.approx(3.0, abs=0.4)
    step, ratio, bounds = found.course()
    assert ratio[0] == 0
    assert bounds[0, -1] <= 2e-4 * step[-1] <= bounds[1, -1]


@pytest.mark.more
@pytest.mark.parametrize("share", [0.5, pytest.param(0.1, marks=pytest.mark.long)])
def test_equal_groups_do_not_win(share: float) -> None:
    trials, significant, missed = 200, 0, 0
    for trial in range(trials):
        found = contest(np.random.default_rng([trial, int(100 * share)]), (1e-3, 1e-3), 10, share)
        significant += found.p < 0.05
        missed += not found.result.selection.low <= 0 <= found.result.selection.high
    low, high = stats.binom.interval(0.99, trials, 0.05)
    print(f"share {share}: p < 0.05 in {significant} of {trials}, interval without 0 in {missed}")
    assert low <= significant <= high
    assert missed <= high


def test_worlds_that_are_lost_count_and_add_no_noise() -> None:
    rng = np.random.default_rng(2)
    some = [lines(rng, (1e-3, 1e-3), 0.1, count=10) for _ in range(30)]
    found = estimate(("a", "b"), some, 3000)
    assert found.result.lost > 5
    assert found.result.lost == sum(each.share[-1] == 0 for each in some)
    assert found.result.end.value == pytest.approx(0.1, abs=0.1)
    tables = {table.name: table for table in contest_tables(found)}
    assert tables["world"].rows.height == 30
    drawn = draw_contest(found).axes[0].lines
    for line, each in zip(drawn[:30], some, strict=True):
        np.testing.assert_array_equal(np.asarray(line.get_ydata()), each.share)


def test_counts_match_the_pedigree() -> None:
    rng = np.random.default_rng(3)
    first = [True, False, True, False]
    agents = birth_death_world({"w_normal": np.ones(4)}, lambda genes: np.full(4, 3e-3), rng, steps=1500)
    found = world_lines(agents, 9, by_descent(agents, first), 1500)
    assert found.count[0].tolist() == [2, 2]
    assert found.count.sum(axis=1)[-1] == agents["death_step"].null_count()
    assert found.descendants.sum() == agents["death_step"].null_count()
    assert found.descendants[[0, 2]].sum() == found.count[-1, 0]


def test_children_of_two_groups_count_by_their_genes() -> None:
    # Founders 0 and 1 have a child with the gene of 1; it and founder 2 have one with the gene of 2.
    agents = pl.DataFrame(
        {
            "agent_id": [0, 1, 2, 3, 4],
            "parent_id": [None, None, None, 0, 3],
            "mate_id": [None, None, None, 1, 2],
            "birth_step": [0, 0, 0, 10, 20],
            "death_step": [15, 15, 15, 25, None],
            "w_see_agent": np.array([0.1, 5, 0.1, 5, 0.1], np.float32),
        }
    )
    member = by_gene(agents, {"w_see_agent": 0.1}, {"w_see_agent": 5.0})
    assert member.tolist() == [1, 0, 1, 0, 1]
    found = world_lines(agents, 1, member, 40)
    assert found.count[0].tolist() == [2, 1]
    assert found.count[-1].tolist() == [1, 0]
    assert found.descendants.tolist() == [0.25, 0.25, 0.5]


def test_groups_that_genes_cannot_tell_apart_are_refused() -> None:
    names = ("a", "b")
    one, other = (make_founders(["w_normal"], np.array([[value]]), ["x"]) for value in (1.0, 2.0))
    assert points_of(join([one, other], names, (1, 1)), names, ONLY) == ({"w_normal": 1.0}, {"w_normal": 2.0})
    action = make_founders(["w_action"], np.array([[2.0]]), ["x"])
    several = make_founders(["w_normal"], np.array([[1.0], [2.0]]), ["x", "x"])
    for table in (action, several):
        with pytest.raises(AssayError, match="two points that name the same genes"):
            points_of(join([one, table], names, (1, 1)), names, ONLY)
    with pytest.raises(AssayError, match="other values of one gene"):
        by_gene(pl.DataFrame({"w_normal": [1.0]}), {"w_normal": 1.0}, {"w_normal": 1.0})
