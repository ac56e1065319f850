"""Two conditions of a sweep are compared by worlds, and a pilot says how many worlds are needed."""

import json
import math
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy import stats
from sweep_case import planned, sweep_file
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.jobs.store import Store
from hedon.report.table import cells
from hedon.statistic.power import t_test_power, worlds_needed
from hedon.sweep.collect import collect
from hedon.sweep.error import SweepError
from hedon.sweep.plan import load_plan
from hedon.sweep.report import settings_table

SEEDS = 12
EFFECT = 4.0


def fill(folder: Path, seeds: int = SEEDS, rest: str | None = None) -> str:
    """A sweep whose results are made up: worlds of one seed are alike, and the second cost lowers `alive_mean`."""
    costs = rest or '[factor]\n"energy.basic_cost" = [0.001, 0.01]\n"energy.initial" = [8.0, 9.0]\n'
    plan, store = planned(sweep_file(folder, seeds=seeds, worlds=seeds, rest=costs), str(folder / "place"))
    rng = np.random.default_rng(7)
    of_seed = dict(zip(range(1, seeds + 1), rng.normal(50.0, 10.0, seeds), strict=True))
    for batch in plan.batches():
        own = plan.conditions[batch.condition].settings
        lower = EFFECT if own["energy.basic_cost"] == 0.01 else 0.0
        rows = [
            {
                "seed": seed,
                "digest": "0",
                "extinct": seed == 3 and lower > 0,
                "alive_mean": of_seed[seed] - lower + float(rng.normal(0.0, 1.0)),
                "w_action_mean": None if seed == 3 and lower > 0 else float(rng.normal()),
            }
            for seed in batch.seeds
        ]
        store.write(f"results/{batch.name}.json", json.dumps({"seconds": 1.0, "worlds": rows}).encode())
    return store.location


def call(*words: str) -> str:
    done = CliRunner().invoke(app, list(words))
    assert done.exit_code == 0, done.output + repr(done.exception)
    return done.output


def rows(place: str, *words: str) -> dict[str, dict]:
    call("contrast", place, "--by", "energy.basic_cost", *words)
    content = json.loads((Path(place) / "contrast" / "contrast.json").read_text())
    return {row["measure"]: row for row in content["tables"]["contrast"]["rows"]}


def test_pairs_of_seeds_show_what_independent_worlds_hide(tmp_path):
    place = fill(tmp_path)
    found = rows(place)["agents alive, last tenth"]
    table = pl.read_parquet(f"{place}/table.parquet")
    means = table.group_by("energy.basic_cost", "seed").agg(pl.col("alive_mean").mean()).sort("seed")
    one, two = (means.filter(pl.col("energy.basic_cost") == cost)["alive_mean"].to_numpy() for cost in (0.001, 0.01))
    interval = stats.ttest_rel(two, one).confidence_interval()
    assert found["difference"] == pytest.approx(float((two - one).mean()))
    assert (found["low"], found["high"]) == pytest.approx((interval.low, interval.high))
    assert found["worlds"] == SEEDS, "two settings of the other factor are one world of a seed each"
    assert found["effect size"] == pytest.approx(float((two - one).mean() / (two - one).std(ddof=1)))
    assert found["p"] == pytest.approx(2 / 2**SEEDS), "of all signs only two are as far out"
    assert found["p"] < found["p Holm"] < 0.01
    apart = rows(place, "--unpaired")["agents alive, last tenth"]
    welch = stats.ttest_ind(two, one, equal_var=False).confidence_interval()
    assert (apart["low"], apart["high"]) == pytest.approx((welch.low, welch.high))
    assert apart["p"] > 0.05


def test_what_the_extinct_do_not_have_is_left_out_and_they_are_counted(tmp_path):
    place = fill(tmp_path)
    said = call("contrast", place, "--by", "energy.basic_cost")
    content = json.loads((Path(place) / "contrast" / "contrast.json").read_text())
    assert [row["died out"] for row in content["tables"]["extinct"]["rows"]] == [0, 2]
    measures = {row["measure"]: row for row in content["tables"]["contrast"]["rows"]}
    assert measures["mean of w_action"]["worlds"] == SEEDS - 1
    assert measures["share of worlds extinct"]["difference"] == pytest.approx(1 / SEEDS)
    assert "Worlds that died out" in said
    assert (Path(place) / "contrast" / "contrast.png").stat().st_size > 5000
    assert "| agents alive" in (Path(place) / "contrast" / "contrast.md").read_text()


@pytest.mark.long
def test_without_an_effect_few_tests_find_one(tmp_path):
    """Of 200 null sweeps about 5 % have p below 0.05, paired and not: the tests keep their level."""
    from hedon.statistic.contrast import independent_contrast, paired_contrast

    rng = np.random.default_rng(3)
    for test in (paired_contrast, independent_contrast):
        p = [test(*rng.normal(size=(2, 8))).p for _ in range(200)]
        assert 2 <= sum(each < 0.05 for each in p) <= 20  # 10 expected, sd 3.1


def test_factors_that_are_not_crossed_are_told(tmp_path):
    zipped = (
        '[factor]\n"energy.basic_cost" = [0.001, 0.01]\n"energy.initial" = [8.0, 9.0]\n'
        '[design]\nzip = [["energy.basic_cost", "energy.initial"]]\n'
    )
    place = fill(tmp_path, rest=zipped)
    assert "The conditions differ in energy.initial too" in " ".join(
        call("contrast", place, "--by", "energy.basic_cost").split()
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--by", "energy.basic"), "did you mean energy.basic_cost?"),
        (("--by", "energy.basic_cost", "--between", "0.001,0.5"), "there are 0.001, 0.01, 0.02"),
        (("--by", "energy.basic_cost"), "name two of the values of energy.basic_cost with --between A,B"),
        (("--by", "energy.basic_cost", "--between", "0.001,0.01", "--only", "alive_maen"), "did you mean alive_mean?"),
        (("--by", "energy.basic_cost", "--between", "0.001,0.02"), "no world with energy.basic_cost = 0.02"),
    ],
)
def test_what_cannot_be_compared_is_refused(tmp_path, words, message):
    place = fill(tmp_path)
    planned(sweep_file(tmp_path, seeds=SEEDS, rest='[factor]\n"energy.basic_cost" = [0.001, 0.01, 0.02]\n'
            '"energy.initial" = [8.0, 9.0]\n'), place)  # fmt: skip
    done = CliRunner().invoke(app, ["contrast", place, *words])
    assert isinstance(done.exception, SweepError)
    assert message in str(done.exception)


@pytest.mark.parametrize(("effect", "needed"), [(0.02, 48), (0.015, 84), (0.01, 186)])
def test_pairs_for_the_slope_of_fear(effect, needed):
    """The pilot's ten pairs have an sd of 0.0484."""
    assert worlds_needed(effect / 0.0484, paired=True) == needed


@pytest.mark.parametrize("paired", [True, False])
def test_as_many_worlds_as_needed_find_an_effect_as_often_as_asked(paired):
    """By drawing worlds and testing them."""
    worlds, rng, tries = worlds_needed(0.6, 0.8, paired=paired), np.random.default_rng(2), 4000
    assert worlds is not None
    other = rng.normal(0.6, 1.0, (tries, worlds))
    base = np.zeros((tries, worlds)) if paired else rng.normal(0.0, 1.0, (tries, worlds))
    p = (stats.ttest_rel if paired else stats.ttest_ind)(other, base, axis=1)[1]
    found = float((np.asarray(p, float) < 0.05).mean())
    assert found == pytest.approx(t_test_power(0.6, worlds, paired=paired), abs=4 * math.sqrt(0.16 / tries))
    assert t_test_power(0.6, worlds, paired=paired) >= 0.8 > t_test_power(0.6, worlds - 1, paired=paired)


def power_rows(folder: Path, *words: str) -> list[dict]:
    call("power", *words, "--out", str(folder / "power"))
    assert (folder / "power" / "power.png").stat().st_size > 5000
    return json.loads((folder / "power" / "power.json").read_text())["tables"]["power"]["rows"]


def test_a_pilot_says_how_many_worlds_are_needed(tmp_path):
    place = fill(tmp_path)
    words = (place, "--by", "energy.basic_cost", "--only", "alive_mean", "--effect", "-4,2")
    found = {(row["design"], row["effect"]): row for row in power_rows(tmp_path, *words)}
    pairs, apart = found["pairs", -4.0], found["two conditions", -4.0]
    table = pl.read_parquet(f"{place}/table.parquet")
    within = table.select(pl.col("alive_mean") - pl.col("alive_mean").mean().over("condition")).to_numpy()
    assert apart["sd"] == pytest.approx(math.sqrt(float((within**2).sum()) / (4 * (SEEDS - 1))))
    assert apart["needed"] == worlds_needed(4 / apart["sd"], paired=False)
    assert pairs["needed"] == worlds_needed(4 / pairs["sd"], paired=True)
    assert pairs["low"] <= pairs["needed"] <= pairs["high"]
    # Worlds of one seed are alike here, so that four conditions know the spread no better than one.
    least, most = (apart["sd"] * math.sqrt((SEEDS - 1) / stats.chi2.ppf(q, SEEDS - 1)) for q in (0.975, 0.025))
    assert [apart["low"], apart["high"]] == [worlds_needed(4 / sd, paired=False) for sd in (least, most)]
    assert pairs["needed"] < 6 < 40 < apart["needed"], "worlds of one seed are alike"
    table.with_columns(pl.col("energy.basic_cost").alias("cost")).vstack(
        table.with_columns(pl.lit(0.5).alias("cost"))
    ).select("seed", "cost", "alive_mean").write_csv(tmp_path / "three.csv")
    chosen = ("--by", "cost", "--between", "0.001,0.01", "--only", "alive_mean", "--effect", "-4")
    three = {row["design"]: row for row in power_rows(tmp_path, str(tmp_path / "three.csv"), *chosen)}
    assert three["pairs"]["sd"] == pytest.approx(pairs["sd"])
    seen = power_rows(tmp_path, place, "--only", "alive_mean")
    assert worlds_needed(seen[0]["with 20"] / seen[0]["sd"], paired=False) == 20


def test_worlds_of_a_table_and_of_two_assays_are_pilots(tmp_path):
    worlds = pl.DataFrame({"seed": range(1, 11), "slope": [0.1, 0.3, 0.2, 0.0, 0.4, 0.1, 0.2, 0.3, 0.1, 0.3]})
    worlds.write_csv(tmp_path / "a.csv")
    (tmp_path / "assay").mkdir()
    other = worlds.with_columns(slope=pl.col("slope") + pl.col("seed") / 100)
    (tmp_path / "assay" / "landscape.json").write_text(json.dumps({"tables": {"world": {"rows": other.to_dicts()}}}))
    found = power_rows(tmp_path, str(tmp_path / "a.csv"), "--against", str(tmp_path / "assay"), "--effect", "0.05")
    sd = {row["design"]: row["sd"] for row in found}
    assert sd["pairs"] == pytest.approx(np.std(np.arange(1, 11) / 100, ddof=1))
    assert sd["two conditions"] == pytest.approx(
        float(np.sqrt((worlds["slope"].to_numpy().var(ddof=1) + other["slope"].to_numpy().var(ddof=1)) / 2))
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ((), "give either a PILOT"),
        (("--sd", "1", "--effect", "x"), "--effect x: must be numbers other than 0"),
        (("--sd", "0"), "must be above 0"),
        (("--sd", "1", "--power", "0.2", "--level", "0.3"), "must be above --level = 0.3"),
        (("nowhere",), "holds neither a sweep nor a finished assay"),
        (("a.csv", "--only", "slpe"), "did you mean slope?"),
        (("a.csv", "--by", "sed"), "did you mean seed?"),
        (("a.csv", "--by", "seed"), "name two of the values of seed with --between A,B: there are 1, 2, 3"),
        (("a.csv", "--by", "seed", "--between", "1,4"), "--between 1,4: name two of the values of seed"),
        (("a.csv", "--between", "1,2"), "give it as --by COLUMN"),
        (("same.csv",), "worlds differ in no measure"),
    ],
)
def test_what_says_nothing_of_worlds_is_refused(tmp_path, monkeypatch, words, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text("seed,slope\n1,0.5\n2,0.7\n3,0.1\n")
    (tmp_path / "same.csv").write_text("seed,slope\n1,0.5\n2,0.5\n")
    done = CliRunner().invoke(app, ["power", *words])
    assert message in str(done.exception)


@pytest.mark.parametrize("seeds", [2, 3])
def test_tables_show_intervals_from_three_worlds_on_and_names_of_settings(tmp_path, seeds):
    store = Store(fill(tmp_path, seeds))
    plan = load_plan(store)
    table = settings_table(plan, collect(plan, store))
    headers, shown = cells(table)
    assert headers[:2] == ["energy.basic_cost", "energy.initial"]
    assert ("…" in " ".join(shown[0])) == (seeds == 3)
