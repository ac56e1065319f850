"""Landscapes of six learners: the tests that were named before find what is in the founders, and nothing else."""

import subprocess
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from hedon_studies.same_genes_another_learner.landscape import (
    ACTION,
    ARMS,
    FOOD,
    SIGHT,
    hump,
    named_tests,
    neutral_control,
    read_arms,
    repeats_the_pilots,
    slopes,
    write_arms,
)

ROOT = Path(__file__).parents[3]
RESULTS = ROOT / "docs" / "results"


def founders(seed: int, sight: float, food: float, bend: float = 0.0, worlds: int = 30) -> pl.DataFrame:
    rng = np.random.default_rng(seed)
    n = 200 * worlds
    genes = {name: rng.uniform(-2, 2, n) for name in (SIGHT, FOOD, ACTION)}
    fitness = 1 + sight * genes[SIGHT] + food * genes[FOOD] + rng.normal(0, 0.3, n)
    loss = bend * np.clip(genes[SIGHT] - 1, 0, None)
    row = {"seed": np.repeat(np.arange(worlds), 200), **genes, "food": 0.01 * fitness, "descendants": fitness - loss}
    return pl.DataFrame(row)


def test_slopes_within_worlds_are_found():
    found = slopes(founders(1, 0.13, 0.1), "food")
    assert found.height == 30
    assert found[SIGHT].mean() == pytest.approx(0.13, abs=0.01)
    assert found[FOOD].mean() == pytest.approx(0.1, abs=0.01)
    assert found[ACTION].mean() == pytest.approx(0.0, abs=0.01)


def test_a_world_without_fitness_has_no_slope():
    dead = founders(1, 0.1, 0.1, worlds=2).with_columns(
        descendants=pl.when(pl.col("seed") == 0).then(0.0).otherwise(1.0)
    )
    assert slopes(dead, "descendants")[SIGHT].is_null().to_list() == [True, False]
    assert hump(dead)["hump"].is_null().to_list() == [True, False]


def test_the_named_tests_find_a_change_of_direction_and_not_a_change_of_size():
    arms = {name: founders(number, 0.13, 0.13) for number, name in enumerate(ARMS)}
    assert not repeats_the_pilots(named_tests(arms))
    arms["fast"] = founders(10, 0.24, 0.14)
    arms["long"] = founders(11, 0.26, 0.26)
    tests = named_tests(arms)
    assert repeats_the_pilots(tests)
    assert tests["test"].len() == 10
    by_name = {row["test"]: row for row in tests.iter_rows(named=True)}
    assert by_name["primary: baseline to fast"]["p_sign_flip"] < 0.001
    assert by_name["baseline to long"]["low"] < 0 < by_name["baseline to long"]["high"]


def test_a_hump_is_found_in_its_arm():
    arms = {name: founders(number, 0.1, 0.1, bend=2.0 if name == "slow" else 0.0) for number, name in enumerate(ARMS)}
    holm = {row["test"]: row["p_holm"] for row in named_tests(arms).iter_rows(named=True)}
    assert holm["hump, slow"] < 0.001
    assert hump(arms["slow"])["hump"].mean() < -0.5


def test_founders_of_all_arms_are_kept_once(tmp_path):
    arms = {name: founders(1, 0.1, 0.1, worlds=2) for name in ARMS}
    arms["fast"] = arms["fast"].with_columns(food=pl.col("food") * 2)
    arms = {name: arm.with_columns(agent_id=pl.int_range(pl.len())) for name, arm in arms.items()}
    write_arms(arms, tmp_path)
    again = read_arms(tmp_path)
    assert list(again) == list(ARMS)
    assert again["fast"]["food"].to_numpy() == pytest.approx(arms["fast"]["food"].to_numpy(), rel=1e-6)
    assert again["slow"][SIGHT].to_numpy() == pytest.approx(arms["slow"][SIGHT].to_numpy(), rel=1e-6)
    with pytest.raises(ValueError, match="fast: its founders have other genes"):
        write_arms(arms | {"fast": founders(2, 0.1, 0.1, worlds=2)}, tmp_path)


def test_the_page_has_the_numbers_of_the_committed_founders():
    page = (RESULTS / "learner.md").read_text()
    arms = read_arms(RESULTS / "learner")
    tests = named_tests(arms)
    assert repeats_the_pilots(tests)
    for row in tests.iter_rows(named=True):
        digits = 2 if row["test"].startswith("hump") else 3
        effect, low, high = (f"{row[name]:.{digits}f}" for name in ("effect", "low", "high"))
        assert f"{effect} ({low} … {high})".replace("-", "\N{MINUS SIGN}") in page
    outside = neutral_control(arms)
    assert f"excludes 0 in {outside['excluding_0'].sum()} of {outside['genes'].sum()} cases" in page
    for arm in arms.values():
        found = slopes(arm, "food")
        assert f"| {found[SIGHT].mean():.3f} (" in page
        assert f"| {found[FOOD].mean():.3f} (" in page


def test_every_arm_started_after_its_expectation_was_committed():
    for run in pl.read_csv(RESULTS / "learner" / "runs.csv").iter_rows(named=True):
        assert run["expectation_committed"] < run["started"]
        if (ROOT / ".git").exists():
            shown = subprocess.run(
                ["git", "show", "-s", "--format=%cI", run["expectation"]], cwd=ROOT, capture_output=True, text=True
            )
            assert shown.returncode or shown.stdout.strip() == run["expectation_committed"]
