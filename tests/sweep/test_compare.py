"""Two conditions are compared with worlds as units, from any source, and a pilot shows how many worlds are needed."""

import json
import math
import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy import stats
from sweep_case import planned, sweep_file
from typer.testing import CliRunner
from worlds import QUICK

from hedon import RunPlan, load_config, run
from hedon.analysis.world.record import read_worlds
from hedon.cli.main import app
from hedon.compare.contrast import compare, compare_answer
from hedon.compare.error import CompareError
from hedon.compare.source import WorldTable
from hedon.compare.sweep_answer import settings_table
from hedon.ensemble.collect import collect
from hedon.ensemble.plan import load_plan
from hedon.ensemble.store import Store
from hedon.measure.catalogue import MEASURES
from hedon.record.reader import open_run
from hedon.report.table import cells
from hedon.statistic.contrast import independent_contrast, paired_contrast
from hedon.statistic.power import SIMULATED, contrast_power, worlds_needed

SEEDS = 12
EFFECT = 4.0


def fill(folder: Path, seeds: int = SEEDS, rest: str | None = None) -> str:
    """A sweep with made-up results: worlds with the same seed are similar, and the second cost lowers `alive_mean`."""
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
                "survived": 400 if seed == 3 and lower > 0 else 512,
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
    call("compare", place, "--by", "energy.basic_cost", *words)
    content = json.loads((Path(place) / "compare" / "compare.json").read_text())
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
    assert found["worlds"] == SEEDS, "the two settings of the other factor count as one world per seed"
    assert found["effect size"] == pytest.approx(float((two - one).mean() / (two - one).std(ddof=1)))
    assert found["p"] == pytest.approx(2 / 2**SEEDS), "only two of all patterns of signs are as extreme"
    assert found["p"] < found["p Holm"] < 0.01
    apart = rows(place, "--unpaired")["agents alive, last tenth"]
    welch = stats.ttest_ind(two, one, equal_var=False).confidence_interval()
    assert (apart["low"], apart["high"]) == pytest.approx((welch.low, welch.high))
    assert apart["p"] > 0.05


def test_missing_values_of_extinct_worlds_are_left_out_and_the_worlds_are_counted(tmp_path):
    place = fill(tmp_path)
    said = call("compare", place, "--by", "energy.basic_cost")
    content = json.loads((Path(place) / "compare" / "compare.json").read_text())
    gone = content["tables"]["extinct"]
    assert [row["died out"] for row in gone["rows"]] == [0, 2]
    assert [row["mean steps survived"] for row in gone["rows"]] == [512, pytest.approx(512 - 112 / SEEDS)]
    assert "by a log-rank test in which worlds exchange their conditions within equal settings" in gone["note"]
    measures = {row["measure"]: row for row in content["tables"]["contrast"]["rows"]}
    assert measures["mean of w_action"]["worlds"] == SEEDS - 1
    assert measures["share of worlds extinct"]["difference"] == pytest.approx(1 / SEEDS)
    assert "Worlds that died out" in said
    assert (Path(place) / "compare" / "compare.svg").stat().st_size > 5000
    assert "| agents alive" in (Path(place) / "compare" / "compare.md").read_text()


def test_pairs_share_the_seed_and_the_settings_of_all_other_factors():
    """Part of a sweep is done; settings of `start` differ by a hundred, costs by nothing."""
    every = [(seed, cost, start) for seed in range(6) for cost in (0.001, 0.01) for start in (8.0, 9.0)]
    done = [row for i, row in enumerate(every) if i % 3]
    value = [100 * start + 10 * seed for seed, _, start in done]
    table = pl.DataFrame(done, schema=["seed", "cost", "start"], orient="row").with_columns(y=pl.Series(value))
    first, second = (table.filter(pl.col("cost") == cost) for cost in (0.001, 0.01))
    (found,) = compare(first, second, {"y": "y"}, ["start"])
    assert found.matched.paired
    assert found.contrast.difference == 0
    settings = [set(side.select("seed", "start").iter_rows()) for side in (first, second)]
    assert found.matched.left_out == len(settings[0] ^ settings[1]) > 0
    (apart,) = compare(first, second, {"y": "y"}, ["start"], paired=False)
    assert abs(apart.contrast.difference) < 10, "the difference between seeds, not between settings"
    missing = table.with_columns(
        y=pl.when((pl.col("cost") == 0.01) & (pl.col("start") == 9.0)).then(None).otherwise("y")
    )
    one, other = (missing.filter(pl.col("cost") == cost) for cost in (0.001, 0.01))
    assert compare(one, other, {"y": "y"}, ["start"])[0].contrast.difference == 0


def test_below_five_worlds_there_is_no_interval():
    rng = np.random.default_rng(1)
    for test in (paired_contrast, independent_contrast):
        few, enough = (test(rng.normal(size=n), rng.normal(size=n)) for n in (4, 5))
        assert math.isnan(few.low)
        assert enough.low < enough.difference < enough.high


@pytest.mark.parametrize(("pairs", "least"), [(3, "0.25"), (5, "0.062"), (6, None)])
def test_too_few_pairs_for_any_p_value_below_a_twentieth_are_reported(pairs, least):
    rows = [(seed, cost, 10.0 * seed + (cost > 0.005) * (5 + seed)) for seed in range(pairs) for cost in (0.001, 0.01)]
    table = pl.DataFrame(rows, schema=["seed", "cost", "alive_mean"], orient="row")
    answer = compare_answer(WorldTable("mine", table, ("cost",)), "cost")
    (contrast,) = (each for each in answer.tables if each.name == "contrast")
    lowest = contrast.rows["p"][0]
    if least is None:
        assert "no p is below" not in contrast.note
        assert lowest < 0.05
    else:
        assert f"With {pairs} pairs, no p is below {least}: take at least 6." in contrast.note
        assert lowest == pytest.approx(2 / 2**pairs)


def test_factors_that_are_not_crossed_are_reported(tmp_path):
    zipped = (
        '[factor]\n"energy.basic_cost" = [0.001, 0.01]\n"energy.initial" = [8.0, 9.0]\n'
        '[design]\nzip = [["energy.basic_cost", "energy.initial"]]\n'
    )
    place = fill(tmp_path, rest=zipped)
    assert "The conditions differ in energy.initial too" in " ".join(
        call("compare", place, "--by", "energy.basic_cost").split()
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--by", "energy.basic"), "did you mean energy.basic_cost?"),
        (("--by", "energy.basic_cost", "--between", "0.001,0.5"), "there are 0.001, 0.01, 0.02"),
        (("--by", "energy.basic_cost"), "name two values of energy.basic_cost with --between A,B"),
        (("--by", "energy.basic_cost", "--between", "0.001,0.01", "--only", "alive_maen"), "did you mean alive_mean?"),
        (("--by", "energy.basic_cost", "--between", "0.001,0.02"), "no world with energy.basic_cost = 0.02"),
    ],
)
def test_what_cannot_be_compared_is_refused(tmp_path, words, message):
    place = fill(tmp_path)
    planned(sweep_file(tmp_path, seeds=SEEDS, rest='[factor]\n"energy.basic_cost" = [0.001, 0.01, 0.02]\n'
            '"energy.initial" = [8.0, 9.0]\n'), place)  # fmt: skip
    done = CliRunner().invoke(app, ["compare", place, *words])
    assert isinstance(done.exception, CompareError)
    assert message in str(done.exception)


@pytest.mark.parametrize(("effect", "needed"), [(0.02, 48), (0.015, 84), (0.01, 186)])
def test_pairs_for_the_slope_of_fear(effect, needed):
    """The ten pairs of the pilot have a standard deviation of 0.0484."""
    assert worlds_needed(effect / 0.0484, "pairs") == needed


@pytest.mark.parametrize("design", ["pairs", "independent"])
@pytest.mark.parametrize("effect", [0.6, 2.5])
def test_the_number_of_worlds_needed_has_the_power_asked_for(design, effect):
    """Draws worlds and compares them like `hedon compare`, which finds nothing with 4 or 5 pairs."""
    worlds, rng = worlds_needed(effect, design), np.random.default_rng(2)
    assert worlds is not None
    assert design == "independent" or worlds >= 6
    test = paired_contrast if design == "pairs" else independent_contrast
    tries = 300
    drawn = ((rng.normal(0.0, design != "pairs", worlds), rng.normal(effect, 1.0, worlds)) for _ in range(tries))
    found = sum(test(base, other).p <= 0.05 for base, other in drawn) / tries
    assert found == pytest.approx(contrast_power(effect, worlds, design), abs=4 * math.sqrt(0.16 / tries))
    assert contrast_power(effect, worlds, design) >= 0.8 > contrast_power(effect, worlds - 1, design)


@pytest.mark.parametrize("effect", [0.5, 0.9])
def test_simulated_power_meets_that_of_the_t_test(effect):
    for design in ("pairs", "independent"):
        below, above = (contrast_power(effect, SIMULATED + i, design) for i in (0, 1))
        assert 0 < above - below < 0.06


def power_rows(folder: Path, *words: str) -> list[dict]:
    call("power", *words, "--out", str(folder / "power"))
    assert (folder / "power" / "power.svg").stat().st_size > 5000
    return json.loads((folder / "power" / "power.json").read_text())["tables"]["power"]["rows"]


def test_a_pilot_says_how_many_worlds_are_needed(tmp_path):
    place = fill(tmp_path)
    words = (place, "--by", "energy.basic_cost", "--only", "alive_mean", "--effect", "-4,2")
    found = {(row["design"], row["effect"]): row for row in power_rows(tmp_path, *words)}
    pairs, apart = found["pairs", -4.0], found["two conditions", -4.0]
    table = pl.read_parquet(f"{place}/table.parquet")
    within = table.select(pl.col("alive_mean") - pl.col("alive_mean").mean().over("condition")).to_numpy()
    assert apart["sd"] == pytest.approx(math.sqrt(float((within**2).sum()) / (4 * (SEEDS - 1))))
    assert apart["needed"] == worlds_needed(4 / apart["sd"], "independent")
    assert pairs["needed"] == worlds_needed(4 / pairs["sd"], "pairs")
    assert pairs["low"] <= pairs["needed"] <= pairs["high"]
    # Worlds with the same seed are similar here, so four conditions estimate the spread no better than one.
    least, most = (apart["sd"] * math.sqrt((SEEDS - 1) / stats.chi2.ppf(q, SEEDS - 1)) for q in (0.975, 0.025))
    assert [apart["low"], apart["high"]] == [worlds_needed(4 / sd, "independent") for sd in (least, most)]
    assert pairs["needed"] < 8 < 40 < apart["needed"], "worlds with the same seed are similar"
    one = table.filter(pl.col("energy.initial") == 8.0).with_columns(cost=pl.col("energy.basic_cost"))
    three = pl.concat([one, one.with_columns(cost=pl.lit(0.5)).filter(pl.col("energy.basic_cost") == 0.001)])
    three.select("seed", "cost", "alive_mean").write_csv(tmp_path / "three.csv")
    chosen = ("--by", "cost", "--between", "0.001,0.01", "--only", "alive_mean", "--effect", "-4")
    three = {row["design"]: row for row in power_rows(tmp_path, str(tmp_path / "three.csv"), *chosen)}
    changes = [one.filter(pl.col("cost") == cost).sort("seed")["alive_mean"].to_numpy() for cost in (0.001, 0.01)]
    assert three["pairs"]["sd"] == pytest.approx(float((changes[1] - changes[0]).std(ddof=1)))
    seen = power_rows(tmp_path, place, "--only", "alive_mean")
    assert worlds_needed(seen[0]["with 20"] / seen[0]["sd"], "independent") == 20


def test_worlds_of_a_table_and_of_two_assays_are_pilots(tmp_path):
    worlds = pl.DataFrame({"seed": range(1, 11), "slope": [0.1, 0.3, 0.2, 0.0, 0.4, 0.1, 0.2, 0.3, 0.1, 0.3]})
    worlds.write_csv(tmp_path / "a.csv")
    (tmp_path / "assay").mkdir()
    other = worlds.with_columns(slope=pl.col("slope") + pl.col("seed") / 100)
    (tmp_path / "assay" / "landscape.json").write_text(json.dumps({"tables": {"world": {"rows": other.to_dicts()}}}))
    found = power_rows(tmp_path, str(tmp_path / "a.csv"), str(tmp_path / "assay"), "--effect", "0.05")
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
        (("nowhere",), "nowhere does not exist"),
        (("empty",), "empty: holds no worlds to compare: give runs, a sweep, an assay, a study, or a table"),
        (("a.csv", "--only", "slpe"), "did you mean slope?"),
        (("a.csv", "--by", "slpe"), "did you mean slope?"),
        (("a.csv", "--by", "arm"), "name two values of arm with --between A,B: there are 1, 2, 3"),
        (("a.csv", "--by", "arm", "--between", "1,4"), "--between 1,4: name two values of arm"),
        (("a.csv", "--by", "seed"), "--by seed: is not a factor of a.csv (there are slope, arm)"),
        (("a.csv", "--between", "1,2"), "give it as --by FACTOR"),
        (("same.csv",), "the worlds do not differ in any measure"),
        (("twice.csv",), "2 worlds have seed 2: keep one row per seed and condition"),
    ],
)
def test_unusable_pilots_and_options_are_refused(tmp_path, monkeypatch, words, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()
    (tmp_path / "a.csv").write_text("seed,slope,arm\n1,0.5,1\n2,0.7,2\n3,0.1,3\n")
    (tmp_path / "twice.csv").write_text("seed,slope\n1,0.5\n2,0.5\n2,0.7\n")
    (tmp_path / "same.csv").write_text("seed,slope\n1,0.5\n2,0.5\n")
    done = CliRunner().invoke(app, ["power", *words])
    assert message in str(done.exception)


@pytest.mark.parametrize("seeds", [4, 5])
def test_tables_show_intervals_from_five_worlds_on_and_names_of_settings(tmp_path, seeds):
    store = Store(fill(tmp_path, seeds))
    plan = load_plan(store)
    table = settings_table(plan, collect(plan, store))
    headers, shown = cells(table)
    assert headers[:2] == ["energy.basic_cost", "energy.initial"]
    assert ("…" in " ".join(shown[0])) == (seeds == 5)


def compared(folder: Path, *words: str) -> dict[str, dict]:
    call("compare", *words, "--out", str(folder / "answer"))
    content = json.loads((folder / "answer" / "compare.json").read_text())
    return {row["measure"]: row for row in content["tables"]["contrast"]["rows"]}


@pytest.fixture(scope="module")
def two_runs(tmp_path_factory) -> Path:
    """A run for each cost, the second half as long again, with two seeds in common."""
    folder = tmp_path_factory.mktemp("runs")
    for name, cost, seeds, steps in (("cheap", 0.001, (1, 2, 3), 1024), ("dear", 0.004, (2, 3, 4), 1536)):
        config = load_config("baseline", overrides=[*QUICK, f"energy.basic_cost={cost}"])
        run(RunPlan(config, seeds=seeds, steps=steps, out=folder / name))
    return folder


def test_two_runs_are_compared_at_their_common_length(two_runs, tmp_path):
    found = compared(tmp_path, str(two_runs / "cheap"), str(two_runs / "dear"))
    cheap, dear = (read_worlds([open_run(two_runs / name)]) for name in ("cheap", "dear"))
    row, measure = found["agents alive, last tenth"], MEASURES["alive_mean"].of
    assert (row["worlds"], row["paired"], row["left out"]) == (2, "yes", 2)
    pairs = [(measure(a), measure(b.until(1024))) for a in cheap for b in dear if a.seed == b.seed]
    assert row["difference"] == pytest.approx(np.mean(np.diff(np.array(pairs, float))))
    assert measure(dear[0]) != measure(dear[0].until(1024))


def test_a_folder_of_runs_is_compared_by_their_conditions(two_runs, tmp_path):
    labels = [f"baseline (corrected): energy.basic_cost {cost}" for cost in (0.001, 0.004)]
    within = compared(tmp_path, str(two_runs), "--between", ",".join(labels))
    apart = compared(tmp_path / "apart", str(two_runs / "cheap"), str(two_runs / "dear"))
    assert {name: row["difference"] for name, row in within.items()} == {
        name: row["difference"] for name, row in apart.items()
    }
    message = "holds runs of several configs"
    assert message in str(CliRunner().invoke(app, ["compare", str(two_runs), str(two_runs / "cheap")]).exception)


def test_a_damaged_run_is_not_compared(two_runs, tmp_path):
    shutil.copytree(two_runs / "dear", tmp_path / "dear")
    part = next((tmp_path / "dear" / "population").glob("*.parquet"))
    part.write_bytes(part.read_bytes()[:-40])
    done = CliRunner().invoke(app, ["compare", str(two_runs / "cheap"), str(tmp_path / "dear")])
    assert f"{part} is damaged" in str(done.exception)


def test_a_killed_run_is_compared_as_far_as_all_of_its_records_reach(two_runs, tmp_path):
    shutil.copytree(two_runs / "dear", tmp_path / "dear")
    manifest = tmp_path / "dear" / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"finished"', '"running"'))
    words = ["compare", str(two_runs / "cheap"), str(tmp_path / "dear"), "--out", str(tmp_path / "answer")]
    call(*words)
    assert json.loads((tmp_path / "answer" / "compare.json").read_text())["steps"] == 1024
    (tmp_path / "dear" / "agents" / "living.parquet").unlink()
    assert "has no step yet at which the records know all agents" in str(CliRunner().invoke(app, words).exception)


def test_conditions_of_a_study_are_compared_and_serve_as_a_pilot(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows = [
        {"condition": label, "seed": seed, "extinct": False, "alive_mean": 10.0 * seed + lift + seed % 2}
        for label, lift in (("prey", 0.0), ("prey, many", 5.0))
        for seed in range(1, 7)
    ]
    Path("fear").mkdir()
    Path("fear/study.json").write_text(json.dumps({"tables": {"world": {"rows": rows}}, "factors": ["condition"]}))
    found = compared(tmp_path, "fear")
    assert found["agents alive, last tenth"]["difference"] == pytest.approx(5.0)
    row, *_ = power_rows(tmp_path, "fear", "--effect", "5", "--only", "alive_mean")
    assert row["sd"] == pytest.approx(np.std([10.0 * seed + seed % 2 for seed in range(1, 7)], ddof=1))


def test_shares_at_the_start_are_compared_as_conditions(tmp_path):
    rows = [{"share at the start": share, "seed": seed, "selection": share + seed / 10}
            for share in (0.1, 0.9) for seed in range(1, 7)]  # fmt: skip
    (tmp_path / "rare").mkdir()
    content = {"tables": {"world": {"rows": rows}}, "factors": ["share at the start"]}
    (tmp_path / "rare" / "frequency.json").write_text(json.dumps(content))
    assert compared(tmp_path, str(tmp_path / "rare"))["selection"]["difference"] == pytest.approx(0.8)
    (row,) = (
        r for r in power_rows(tmp_path, str(tmp_path / "rare"), "--effect", "1") if r["design"] == "one condition"
    )
    assert row["sd"] == pytest.approx(np.std(np.arange(6) / 10, ddof=1))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("a.csv", "a.csv"), "a.csv is named twice"),
        (("a.csv", "b.csv"), "have no measure in common"),
        (("a.csv",), "a.csv holds worlds of one condition: name a second source"),
        (("b.csv", "a.cvs"), "a.cvs does not exist; did you mean a.csv?"),
    ],
)
def test_sources_that_cannot_be_compared_are_refused(tmp_path, monkeypatch, words, message):
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text("seed,slope\n1,0.5\n2,0.7\n")
    Path("b.csv").write_text("seed,slant\n1,0.5\n2,0.7\n")
    assert message in str(CliRunner().invoke(app, ["compare", *words]).exception)
