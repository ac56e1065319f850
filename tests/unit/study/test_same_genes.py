"""Same genes, another learner: the tests fixed beforehand find the differences that are there, and no others."""

import re
import subprocess
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hedon
from hedon.config import digest, load_config
from hedon.statistic import mean_interval
from hedon_studies.same_genes_another_learner import evolution
from hedon_studies.same_genes_another_learner.landscape import (
    ACTION,
    ARMS,
    FOOD,
    SIGHT,
    direction_change,
    hump,
    named_tests,
    neutral_control,
    read_arms,
    repeats_the_pilots,
    slopes,
    write_arms,
)
from hedon_studies.same_genes_another_learner.named_test import named_test

ROOT = Path(__file__).parents[3]
RESULTS = ROOT / "docs" / "results"
EVOLVED = RESULTS / "learner" / "evolution"


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
    assert np.mean(hump(arms["slow"])["hump"].to_numpy()) < -0.5


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
    page = " ".join((RESULTS / "learner.md").read_text().split())
    arms = read_arms(RESULTS / "learner")
    tests = named_tests(arms)
    assert repeats_the_pilots(tests)
    for row in tests.iter_rows(named=True):
        digits = 2 if row["test"].startswith("hump") else 3
        effect, low, high = (f"{row[name]:.{digits}f}" for name in ("effect", "low", "high"))
        assert f"{effect} ({low} … {high})".replace("-", "\N{MINUS SIGN}") in page
    second = named_test("living descendants", direction_change(arms["baseline"], arms["fast"], "descendants"))
    effect, low, high = (f"{second[name]:.2f}" for name in ("effect", "low", "high"))
    assert f"instead of intake, also fixed beforehand, agrees: +{effect} ({low} … {high})" in page
    means = {arm: slopes(founders, "food").select(pl.col(SIGHT, FOOD).mean()).row(0) for arm, founders in arms.items()}
    ratios = [f"{means[arm][0] / means[arm][1]:.2f}" for arm in ("slow", "baseline", "fast")]
    told = "{} times the slope on food with the slow learner, {} times with the baseline, and {} times with the fast"
    assert told.format(*ratios) in page
    outside = neutral_control(arms)
    assert f"excludes 0 in {outside['excluding_0'].sum()} of {outside['genes'].sum()} cases" in page
    for arm in arms.values():
        found = slopes(arm, "food")
        assert f"| {found[SIGHT].mean():.3f} (" in page
        assert f"| {found[FOOD].mean():.3f} (" in page


@pytest.mark.parametrize("table", ["runs.csv", "evolution/worlds.csv"])
def test_every_run_started_after_its_expectation_was_committed(table):
    for run in pl.read_csv(RESULTS / "learner" / table).iter_rows(named=True):
        assert run["expectation_committed"] < run["started"]
        if (ROOT / ".git").exists():
            shown = subprocess.run(
                ["git", "show", "-s", "--format=%cI", run["expectation"]], cwd=ROOT, capture_output=True, text=True
            )
            assert shown.returncode or shown.stdout.strip() == run["expectation_committed"]


def evolved(seed: int, sight: float, food: float, pairs: int = 60) -> pl.DataFrame:
    """Rows of worlds: the slow arm settles at (food 0.8, sight 0.4), the fast one at (food, sight), with noise."""
    rng = np.random.default_rng(seed)
    arms = {"slow": (0.4, 0.8), "fast": (sight, food)}
    columns = {
        name: {SIGHT: at[0] + rng.normal(0, 0.15, pairs), FOOD: at[1] + rng.normal(0, 0.15, pairs)}
        | {f"{gene}_score": rng.normal(2.0, 1.0, pairs) for gene in (SIGHT, FOOD)}
        | {f"neutral_{i}": rng.normal(0, 0.3, pairs) for i in range(1, 17)}
        | {f"neutral_{i}_score": rng.normal(0, 1, pairs) for i in range(1, 17)}
        for name, at in arms.items()
    }
    rows = [
        pl.DataFrame(
            {"arm": name, "seed": np.arange(pairs), "extinct_step": pl.Series([None] * pairs, dtype=pl.Int64)}
        ).hstack(pl.DataFrame(columns[name]))
        for name in arms
    ]
    return pl.concat([row.with_columns(pl.col("arm").cast(pl.String)) for row in rows])


def test_a_turned_reward_is_found_and_a_larger_one_is_not():
    larger = evolution.named_tests(evolved(1, 0.8, 1.6)).row(0, named=True)
    assert larger["low"] < 0 < larger["high"]
    turned = evolution.named_tests(evolved(2, 0.8, 1.0))
    assert turned["test"].len() == 7
    assert turned["p_holm"].null_count() == 1
    primary = turned.row(0, named=True)
    assert primary["effect"] == pytest.approx(np.degrees(np.arctan2(0.8, 1.0) - np.arctan2(0.4, 0.8)), abs=2)
    assert primary["low"] > 0
    control = evolution.neutral_control(evolved(3, 0.8, 1.0))
    assert control.height == 16
    assert control.filter((pl.col("low") > 0) | (pl.col("high") < 0)).height <= 4


def test_pairs_without_an_extinct_world_are_compared():
    worlds = evolved(4, 0.4, 0.8, pairs=10).with_columns(
        extinct_step=pl.when((pl.col("arm") == "fast") & (pl.col("seed") == 3)).then(5).otherwise(None)
    )
    assert 3 not in evolution.pairs(worlds)["seed"]
    assert evolution.pairs(worlds).height == 9


def test_runs_are_reduced_to_worlds_and_the_genes_of_the_living(tmp_path):
    config = load_config("appetite", overrides=["learning.learning_rate=0.003", "reward.pay.see_normal.coef=0.2"])
    hedon.run(hedon.RunPlan(config, [1, 2], 1024, tmp_path / "run", 1))
    evolution.main(["worlds", str(tmp_path / "run"), "--out", str(tmp_path / "out")])
    worlds = pl.read_csv(tmp_path / "out" / evolution.WORLDS)
    genes = pl.read_parquet(tmp_path / "out" / evolution.LIVING)
    assert worlds["arm"].to_list() == ["fast", "fast"]
    assert worlds["seed"].to_list() == [1, 2]
    rows = hedon.open_run(tmp_path / "run").population()
    alive = [world["agent_steps"].sum() / 1024 for world in rows.partition_by("world")]
    assert worlds["alive_all_steps"].to_list() == alive
    means = genes.group_by("seed").agg(pl.col(FOOD).mean()).sort("seed")[FOOD]
    assert worlds.sort("seed")[FOOD].to_numpy() == pytest.approx(means.to_numpy(), abs=1e-5)


def test_the_committed_worlds_are_those_of_the_design():
    expected = (ROOT / "src/hedon_studies/same_genes_another_learner/expected.md").read_text()
    command = re.search(r"`hedon run appetite --seeds 1101-1160.*?`", expected, re.DOTALL)
    assert command
    settings = re.findall(r"--set (\S+?)`?(?=\s|`|$)", command[0])
    assert len(settings) == 6
    worlds = pl.read_csv(EVOLVED / evolution.WORLDS)
    designed = {(arm, seed) for arm in evolution.ARMS for seed in range(1101, 1161)}
    assert sorted(worlds.select("arm", "seed").iter_rows()) == sorted(designed)
    for arm, rate in evolution.ARMS.items():
        config = load_config("appetite", overrides=[*settings, f"learning.learning_rate={rate}"])
        assert set(worlds.filter(pl.col("arm") == arm)["config_digest"]) == {digest(config)}


def test_the_committed_genes_are_those_of_the_committed_worlds():
    living = pl.read_parquet(EVOLVED / evolution.LIVING)
    for arm, rate in evolution.ARMS.items():
        of_arm = living.filter((pl.col("learning_rate") / rate - 1).abs() < 1e-6)
        means = of_arm.group_by("seed").agg(pl.col(SIGHT, FOOD, ACTION).mean()).sort("seed")
        worlds = pl.read_csv(EVOLVED / evolution.WORLDS).filter(pl.col("arm") == arm).sort("seed")
        assert means["seed"].to_list() == worlds["seed"].to_list()
        for gene in (SIGHT, FOOD, ACTION):
            assert means[gene].to_numpy() == pytest.approx(worlds[gene].to_numpy(), abs=1e-4)


def test_the_page_has_the_numbers_of_the_committed_evolution():
    text = (RESULTS / "learner.md").read_text().replace("\N{MINUS SIGN}", "-")
    page = " ".join(text[text.index("## Evolution under") :].split())
    worlds = pl.read_csv(EVOLVED / evolution.WORLDS)
    assert worlds["extinct_step"].null_count() == worlds.height
    paired = evolution.pairs(worlds)
    angles = {arm: evolution.direction(paired, arm) for arm in ("slow", "fast")}
    assert f"in {(angles['fast'] > angles['slow']).sum()} of 60 pairs of worlds" in page
    rows = {"direction [degrees]": (1, angles)}
    columns = {"weight of sight": (2, SIGHT), "weight of food": (2, FOOD), "weight of action": (2, ACTION)}
    columns |= {"generation at the end": (1, "generation"), "agents alive, mean over all steps": (0, "alive_all_steps")}
    for label, (digits, column) in columns.items():
        rows[label] = (digits, {arm: worlds.filter(pl.col("arm") == arm)[column].to_numpy() for arm in angles})
    for label, (digits, values) in rows.items():
        cells = []
        for arm in angles:
            bounds = mean_interval(values[arm].tolist())
            mean, low, high = (f"{value:.{digits}f}" for value in (bounds.mean, bounds.low, bounds.high))
            cells.append(f"{mean} ({low} … {high})")
        assert f"| {label} | {cells[0]} | {cells[1]} |" in page
    for digits, test in zip((1, *[2] * 6), evolution.named_tests(worlds).iter_rows(named=True), strict=True):
        effect, low, high = (f"{test[name]:.{digits}f}" for name in ("effect", "low", "high"))
        assert f"+{effect} ({low} … {high})" in page
    control = evolution.neutral_control(worlds)
    outside = control.filter((pl.col("low") > 0) | (pl.col("high") < 0)).height
    assert f"excludes 0 for {outside} of {control.height} genes" in page
    for arm, slope in (("slow", "-0.1° per generation in the slow arm"), ("fast", "0.8° in the fast arm")):
        reached = worlds.filter(pl.col("arm") == arm).sort("seed")["generation"]
        assert f"{np.polyfit(reached, angles[arm], 1)[0]:.1f}" == slope.split("°")[0]
        assert slope in page
