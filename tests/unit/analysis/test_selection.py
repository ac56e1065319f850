import numpy as np
import polars as pl
import pytest

from hedon.analysis.gene.selection import selection
from hedon.statistic.selection import STRATUM, linear_selection

NAMES = ("w_normal", "w_action", "neutral_1")


def cohort(z: np.ndarray, children: np.ndarray, *, parent: np.ndarray | None = None) -> pl.DataFrame:
    """Agents with given weights and children, all of them dead, in order of birth."""
    n = len(z)
    table = {"agent_id": np.arange(n), "birth_step": np.arange(n), "death_step": np.arange(n) + 100}
    table |= {"parent_id": np.arange(n) if parent is None else parent, "children": children}
    return pl.DataFrame(table | {name: z[:, i].astype(np.float32) for i, name in enumerate(NAMES)})


def test_the_true_gradient_of_a_log_linear_fitness_is_found() -> None:
    """With W Poisson of mean exp(b·z) and z normal, the gradient is b and the differential b·σ² (Lande & Arnold)."""
    rng = np.random.default_rng(2)
    b, trials, slopes = 0.3, 120, []
    for _ in range(trials):
        z = rng.normal(0, [0.8, 1.0, 1.0], (300, 3))
        z[:, 2] += 0.7 * z[:, 0]  # a gene that hitchhikes: a differential, but no gradient
        found = selection(cohort(z, rng.poisson(np.exp(b * z[:, 0]))), NAMES, 1000)[:3]
        slopes.append([row["gradient"] for row in found] + [found[2]["differential"]])
    np.testing.assert_allclose(np.mean(slopes, axis=0), [b, 0, 0, b * 0.7 * 0.64], atol=0.03)


def test_both_measures_of_fitness_are_regressed() -> None:
    rng = np.random.default_rng(8)
    z = rng.normal(size=(300, 3)).astype(np.float32).astype(np.float64)  # as recorded
    agents = cohort(z, rng.poisson(1.0, 300))
    lives = np.round(1000 * np.exp(0.3 * z[:, 1])).astype(int)
    agents = agents.with_columns(death_step=pl.col("birth_step") + lives)
    found = selection(agents, NAMES, 10**6)
    design = np.column_stack([np.ones(300), z])
    for rows, fitness in ((found[:3], agents["children"].to_numpy()), (found[3:], lives)):
        slopes = np.linalg.lstsq(design, fitness / fitness.mean(), rcond=None)[0][1:]
        np.testing.assert_allclose([row["gradient"] for row in rows], slopes, rtol=1e-9)


def test_raw_and_standardized_agree() -> None:
    rng = np.random.default_rng(3)
    row = selection(cohort(rng.normal(0, 2, (400, 3)), rng.poisson(1.0, 400)), NAMES, 1000)[0]
    assert row["standard_gradient"] == pytest.approx(row["gradient"] * row["sd"])
    assert row["intensity"] == pytest.approx(row["differential"] / row["sd"])
    assert (row["fitness"], row["weight"], row["agents"], row["complete"]) == ("children", "w_normal", 400, 1.0)


def test_a_common_drift_of_weights_and_fitness_is_no_selection() -> None:
    rng = np.random.default_rng(4)
    time = np.linspace(0, 1, 20 * STRATUM)
    z = np.stack([5 * time, 0 * time, 0 * time], axis=1) + rng.normal(size=(len(time), 3))
    fitness = rng.poisson(2 - 1.5 * time)
    omega = (fitness / fitness.mean())[:, None]
    naive = linear_selection(z, omega)[0, 2]
    row = selection(cohort(z, fitness), NAMES, 10**6)[0]
    assert naive[0] < -0.1
    assert abs(row["gradient"]) < 0.05
    assert row["sd"] == pytest.approx(1.0, abs=0.03)  # among contemporaries, without the drift


def test_a_weight_that_does_not_vary_has_no_gradient_and_affects_no_other() -> None:
    rng = np.random.default_rng(5)
    z = rng.normal(size=(300, 3))
    z[:, 1] = 0.1
    children = rng.poisson(1.0, 300)
    rows = selection(cohort(z, children), NAMES, 1000)
    assert np.isnan(rows[1]["gradient"])
    assert rows[1]["differential"] == 0
    assert np.isfinite([rows[0]["gradient"], rows[2]["gradient"]]).all()


def test_too_few_agents_give_nothing() -> None:
    rng = np.random.default_rng(6)
    for n in (0, 10):
        rows = selection(cohort(rng.normal(size=(n, 3)), np.ones(n, int)), NAMES, 1000)
        assert len(rows) == 6
        assert all(np.isnan(row["gradient"]) for row in rows)
