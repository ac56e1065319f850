import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.analysis.agent.cohort import COMPLETE
from hedon.analysis.gene.selection import curvature
from hedon.analysis.topic.selection import curvature_topic
from hedon.analysis.world.record import by_condition, read_worlds
from hedon.record.reader import open_run
from hedon.statistic.selection import REACH, standardized

NAMES = ("w_normal", "w_action", "neutral_1")


def cohort(rng: np.random.Generator, count: int, bend: float, *, heavy: bool) -> pl.DataFrame:
    """Sibships of about four with similar weights; exponential luck; fitness that bends along the first weight."""
    family = rng.integers(0, count // 4, count)
    if heavy:
        z = rng.standard_t(2, (count // 4, 3))[family] + 0.3 * rng.standard_cauchy((count, 3))
    else:
        z = rng.normal(size=(count // 4, 3))[family] + 0.3 * rng.normal(size=(count, 3))
    z = np.clip(z, -10, 10)
    along = np.clip(z[:, 0] / z[:, 0].std(), -REACH, REACH)
    expected = np.maximum(1.0 + 0.5 * bend * (along**2 - 1.0), 0.0)
    children = rng.poisson(expected * rng.exponential(1.0, count))
    table = {"agent_id": np.arange(count), "birth_step": np.arange(count), "death_step": np.arange(count) + 100}
    table |= {"parent_id": family, "children": children}
    return pl.DataFrame(table | {name: z[:, i].astype(np.float32) for i, name in enumerate(NAMES)})


def measured(bend: float, trials: int, *, heavy: bool) -> np.ndarray:
    """The curvature of each weight, shape (trials, weights)."""
    rng = np.random.default_rng(1)
    found = [curvature(cohort(rng, 500, bend, heavy=heavy), NAMES, 10**6)[:3] for _ in range(trials)]
    return np.array([[row["curvature"] for row in rows] for rows in found])


def test_the_curvature_is_a_regression_coefficient() -> None:
    rng = np.random.default_rng(2)
    agents = cohort(rng, 190, 0.0, heavy=False)  # one stratum
    z = agents.select(NAMES).to_numpy().astype(np.float64)
    z = standardized(z - z.mean(axis=0))
    omega = agents["children"].to_numpy() / agents["children"].to_numpy().mean()
    rows = curvature(agents, NAMES, 10**6)
    for i, row in enumerate(rows[:3]):
        design = np.column_stack([np.ones(len(z)), z, 0.5 * (z[:, i] / z[:, i].std()) ** 2])
        assert row["curvature"] == pytest.approx(np.linalg.lstsq(design, omega, rcond=None)[0][-1], rel=1e-6)
    assert [(row["fitness"], row["weight"]) for row in rows[::3]] == [
        ("children", "w_normal"),
        ("lifespan", "w_normal"),
    ]


@pytest.mark.parametrize("heavy", [False, True])
def test_flat_fitness_has_no_curvature(heavy: bool) -> None:
    np.testing.assert_allclose(measured(0.0, 150, heavy=heavy).mean(axis=0), 0.0, atol=0.02)


@pytest.mark.parametrize(("bend", "heavy"), [(-0.3, False), (-0.2, True), (0.3, False)])
def test_stabilizing_and_disruptive_selection_are_found(bend: float, heavy: bool) -> None:
    mean = measured(bend, 60, heavy=heavy).mean(axis=0)
    assert mean[0] == pytest.approx(bend, abs=0.06)
    np.testing.assert_allclose(mean[1:], 0.0, atol=0.03)


def test_few_agents_and_constant_weights_have_no_curvature() -> None:
    rng = np.random.default_rng(3)
    assert np.isnan([row["curvature"] for row in curvature(cohort(rng, 40, 0.0, heavy=False), NAMES, 10**6)]).all()
    still = cohort(rng, 300, 0.0, heavy=False).with_columns(w_action=pl.lit(0.5, pl.Float32))
    rows = curvature(still, NAMES, 10**6)
    assert np.isnan(rows[1]["curvature"])
    assert np.isfinite([rows[0]["curvature"], rows[2]["curvature"]]).all()


def test_the_topic_shows_the_excess_over_neutral_genes(tmp_path) -> None:
    options = {"worlds": 3, "intervals": 60, "snapshot": False, "neutral_count": 3}
    worlds = read_worlds([open_run(write_run(tmp_path / "run", **options))])
    summary, by_window = curvature_topic(by_condition(worlds))
    assert set(summary.rows["fitness"]) == {"children", "lifespan"}
    whole = by_window.rows.filter(pl.col("complete") >= COMPLETE)
    means = whole.group_by("seed", "fitness", "weight").agg(pl.col("curvature").mean())
    for row in summary.rows.filter(pl.col("weight") == "w_normal").iter_rows(named=True):
        of = means.filter(pl.col("fitness") == row["fitness"])
        own = of.filter(pl.col("weight") == "w_normal").sort("seed")["curvature"]
        neutral = (
            of.filter(pl.col("weight").str.starts_with("neutral")).group_by("seed").agg(pl.col("curvature").mean())
        )
        assert row["mean"] == pytest.approx((own - neutral.sort("seed")["curvature"]).mean(), abs=1e-9)
        assert (row["worlds"], row["low"]) == (3, None)
    assert (by_window.rows["complete"] < COMPLETE).any()  # left out of the summary
