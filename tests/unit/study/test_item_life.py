import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
import pytest
from scipy import stats
from synthetic_run import write_run

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.record.reader import open_run
from hedon.report.table import cells
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.life import LIVES
from hedon_studies.kanagawa_doya_2024.paper import STEPS

ITEMS = {item.name: item for item in LIVES}
LIFE, RESTRICTED, MEDIAN = (
    "mean lifetime of the dead [step]",
    "restricted mean lifetime [step]",
    "median lifetime [step]",
)
FOOD, RATE = "foods / lifetime, mean over the dead [1/step]", "all foods / all steps lived [1/step]"


@pytest.fixture(scope="module")
def five(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("life") / "run"
    return read_worlds([open_run(write_run(folder, worlds=5, intervals=40, extinct=2, snapshot=False))])


def make(name: str, **worlds: Sequence[WorldRecord]) -> tuple[ResultTable, ResultTable]:
    first, second = ITEMS[name].make(ItemInputs("corrected", worlds))
    assert isinstance(first, ResultTable)
    assert isinstance(second, ResultTable)
    assert (first.name, second.name, first.shown, second.shown) == (name, f"{name}-world", True, False)
    return first, second


def row(result: ResultTable, condition: str, quantity: str) -> dict[str, Any]:
    return result.rows.row(
        by_predicate=(pl.col("condition") == condition) & (pl.col("quantity") == quantity), named=True
    )


def lives(world: WorldRecord) -> tuple[np.ndarray, np.ndarray]:
    """Known lengths of life and whether they are complete."""
    born, died = (world.agents[name].cast(pl.Float64).to_numpy() for name in ("birth_step", "death_step"))
    return np.where(np.isnan(died), world.last_step, died) - born, ~np.isnan(died)


def kaplan_meier(world: WorldRecord) -> tuple[list[float], list[float]]:
    """Ages at death and the share that survives each, by definition."""
    length, whole = lives(world)
    ages, shares, share = sorted(set(length[whole].tolist())), [], 1.0
    for age in ages:
        share *= 1 - np.sum(whole & (length == age)) / np.sum(length >= age)
        shares.append(float(share))
    return ages, shares


def area(world: WorldRecord, until: float) -> float:
    ages, shares = kaplan_meier(world)
    within = [age for age in ages if age < until]
    edges = [0.0, *within, until]
    return float(np.sum(np.diff(edges) * [1.0, *shares[: len(within)]]))


def test_the_items_are_those_of_the_paper_at_its_scale() -> None:
    assert list(ITEMS) == ["life-sizes", "life-places"]
    assert {(item.scale.seeds, item.scale.steps) for item in LIVES} == {((1, 2, 3, 4, 5), STEPS)}


def test_lifetimes_are_means_over_worlds_next_to_the_papers(five: list[WorldRecord]) -> None:
    found, _ = make("life-sizes", small=five[:2], baseline=five, large=five[3:])
    for condition, worlds, paper in (("small", five[:2], 120668), ("baseline", five, 6310), ("large", five[3:], 5718)):
        means = [float(length[whole].mean()) for length, whole in map(lives, worlds)]
        life = row(found, condition, LIFE)
        assert life["mean"] == pytest.approx(np.mean(means))
        assert (life["paper"], life["ratio"]) == (paper, pytest.approx(np.mean(means) / paper))
        if len(means) < 5:
            assert (life["low"], life["high"]) == (None, None)
        else:
            half = stats.t.ppf(0.975, len(means) - 1) * stats.sem(means)
            assert (life["low"], life["high"]) == pytest.approx((life["mean"] - half, life["mean"] + half))
        assert (life["worlds"], life["of"], life["steps"]) == (len(worlds), len(worlds), 40 * 1024)
        censored = np.mean([np.mean(~whole) for _, whole in map(lives, worlds)])
        assert row(found, condition, "share of lives censored")["mean"] == pytest.approx(censored)
    assert [row(found, condition, LIFE)["extinct"] for condition in ("small", "baseline", "large")] == [0, 1, 0]


def test_censored_lives_count_in_the_restricted_mean_and_the_median(five: list[WorldRecord]) -> None:
    found, by_world = make("life-sizes", baseline=five)
    until = by_world.rows["until"][0]
    assert row(found, "baseline", RESTRICTED)["mean"] == pytest.approx(np.mean([area(w, until) for w in five]))
    medians = [next(age for age, share in zip(*kaplan_meier(w), strict=True) if share <= 0.5) for w in five]
    assert row(found, "baseline", MEDIAN)["mean"] == pytest.approx(np.mean(medians))
    assert row(found, "baseline", MEDIAN)["paper"] is None
    assert f"(baseline: {until:,.0f} steps)" in found.note


def test_a_world_that_died_out_sets_no_limit_to_the_age(five: list[WorldRecord]) -> None:
    def until(worlds: Sequence[WorldRecord]) -> float:
        return make("life-sizes", baseline=worlds)[1].rows["until"].unique().item()

    assert until(five[2:3]) < until(five[:2])
    assert until(five[:3]) == until(five[:2])
    assert until([five[2], dataclasses.replace(five[2], seed=9)]) == until(five[2:3])


def test_food_by_both_rules(five: list[WorldRecord]) -> None:
    found, by_world = make("life-places", uniform=five)
    rates, shares = [], []
    for world in five:
        dead = world.agents.filter(pl.col("death_step") > pl.col("birth_step"))
        length = (dead["death_step"] - dead["birth_step"]).to_numpy()
        shares.append(float(np.mean(dead["eaten_normal"].to_numpy() / length)))
        eaten, lived = (world.population[name].to_numpy().sum() for name in ("eaten_normal", "agent_steps"))
        rates.append(eaten / lived)
    assert row(found, "uniform", FOOD)["mean"] == pytest.approx(np.mean(shares))
    assert row(found, "uniform", RATE)["mean"] == pytest.approx(np.mean(rates))
    assert row(found, "uniform", FOOD)["paper"] == 0.001
    assert row(found, "uniform", RATE)["ratio"] is None
    assert by_world.rows["food_per_life"].to_list() == pytest.approx(shares)
    assert by_world.rows["extinct_step"].to_list() == [None, None, five[2].extinct_step, None, None]


def test_a_cut_world_counts_its_living_as_censored(five: list[WorldRecord]) -> None:
    cut = five[0].until(10_240)
    found, _ = make("life-places", uniform=[cut])
    length = five[0].agents.filter(pl.col("death_step") <= 10_240).select(pl.col("death_step") - pl.col("birth_step"))
    born = five[0].agents.filter(pl.col("birth_step") <= 10_240).height
    assert row(found, "uniform", LIFE)["mean"] == pytest.approx(length.to_series().to_numpy().mean())
    assert row(found, "uniform", "share of lives censored")["mean"] == pytest.approx(1 - length.height / born)


def test_intervals_are_shown_from_five_worlds_on(five: list[WorldRecord]) -> None:
    for worlds in (1, 2, 5):
        headers, rows = cells(make("life-places", uniform=five[:worlds])[0])
        assert ("95 % interval" in headers) == (worlds == 5)
    assert rows[0][headers.index("95 % interval")]


def test_arms_without_worlds_are_named(five: list[WorldRecord]) -> None:
    found, _ = make("life-places", centered=five[:1], uniform=[])
    assert found.rows["condition"].unique().to_list() == ["centered"]
    assert found.note.endswith("Not run yet: uniform; relocation.")
    nothing, by_world = make("life-sizes")
    assert nothing.rows.is_empty()
    assert by_world.rows.is_empty()
    assert nothing.note.endswith("Not run yet: small; baseline; large.")
