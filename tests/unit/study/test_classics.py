"""Studies of classic questions: their decision rule works as written, and each runs from its settings to its page."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from command import hedon

from hedon.assay import Lines
from hedon.compare.source import read_table
from hedon.config.load import load_config
from hedon.figure.style import svg_bytes
from hedon.statistic import FOR_VERDICT as WORLDS
from hedon_studies.founder import fitness_slope, known_mean, spread_gene
from hedon_studies.lifespan_and_plasticity.study import HAZARDS, control_rows, draw_slopes, named_test
from hedon_studies.mating_strategies.study import COMMON, RARE, cluster_test, invasion_tests, world_rows
from hedon_studies.optimal_reward import study as optimal
from hedon_studies.optimal_reward.study import FREE, GATED, draw_intake
from hedon_studies.rule import NO, OPEN, YES, count_test, mean_test, verdict_table
from hedon_studies.two_needs import study as needs
from hedon_studies.two_needs.study import ADDITIVE, ONE, PAID, TWO, draw_changes

RESULTS = Path(__file__).parents[3] / "docs" / "results"


def answers(*tests) -> list[str]:
    return verdict_table("made_up", tests).rows["answer"].to_list()


def test_a_clear_effect_is_yes_on_one_side_and_no_on_the_other() -> None:
    rng = np.random.default_rng(1)
    values = rng.normal(1.0, 1.0, WORLDS)
    both = [mean_test("a", values, WORLDS, 0, above=above) for above in (True, False)]
    assert answers(*both) == [YES, NO]
    assert both[0].low < 1.0 < both[0].high


def test_few_worlds_and_chance_leave_the_answer_open() -> None:
    rng = np.random.default_rng(2)
    few = mean_test("few", rng.normal(5.0, 1.0, WORLDS - 1), WORLDS - 1, 0, above=True)
    none = mean_test("none", rng.normal(0.0, 1.0, 100), 100, 0, above=True)
    empty = mean_test("empty", [], 0, 0, above=True)
    assert few.p < 1e-6
    assert answers(few, none, empty) == [OPEN, OPEN, OPEN]


def test_three_values_from_thirty_worlds_leave_the_answer_open() -> None:
    few = mean_test("few", [5.0, 5.1, 4.9], WORLDS, 27, above=True)
    assert few.p < 0.001
    assert answers(few) == [OPEN]


def test_an_effect_is_reported_in_words() -> None:
    assert mean_test("few", [], 2, 0, above=True).said == "not known from 2 worlds"
    assert mean_test("one", [0.1], 1, 0, above=True).said == "not known from 1 world"
    known = mean_test("known", [0.1, 0.2, 0.3, 0.4, 0.5], 5, 0, above=True)
    assert known.said.startswith("0.3 (0.1")


def test_tests_of_a_study_are_corrected_for_each_other() -> None:
    worlds = (np.random.default_rng(seed).normal(0.35, 1.0, WORLDS) for seed in range(1000))
    tests = (mean_test("weak", values, WORLDS, 0, above=True) for values in worlds)
    weak = next(test for test in tests if 0.03 < test.p < 0.05)
    none = mean_test("none", np.tile([1.0, -1.0], WORLDS), 2 * WORLDS, 0, above=True)
    assert answers(weak) == [YES]
    assert answers(weak, none) == [OPEN, OPEN]


def rows(trend: float, seeds: int = WORLDS) -> list[dict]:
    """Worlds in which the slope on the gene changes by `trend` per doubling of the hazard; one seed in six died out."""
    rng = np.random.default_rng(3)
    return [
        {"hazard": hazard, "seed": seed, "died out": seed % 6 == 0, "lifespan": 6000 / hazard, "unfinished": 0.0}
        | {"alive": 300 / hazard, "slope": 0.1 + trend * np.log2(hazard) + rng.normal(0, 0.05)}
        | {"children": [1.0] * 5, "neutral_1": rng.normal(0, 0.05)}
        for hazard in HAZARDS
        for seed in range(seeds)
    ]


def test_lifespan_and_plasticity_recovers_a_known_effect() -> None:
    found = named_test(rows(0.05))
    assert found.low < 0.05 < found.high
    assert (found.worlds, found.values, found.extinct) == (WORLDS, WORLDS, 20)
    assert answers(found) == [YES]
    assert answers(named_test(rows(-0.05))) == [NO]
    assert answers(named_test(rows(0.0))) == [OPEN]
    childless = [row | ({"slope": None} if row["hazard"] == 4.0 and row["seed"] == 7 else {}) for row in rows(0.05)]
    assert named_test(childless).values == WORLDS - 1
    assert answers(named_test(childless)) == [OPEN], "too few seeds are left"
    (control,) = control_rows(rows(0.05), ["neutral_1"])
    assert control["low"] < 0 < control["high"]


def test_the_slope_of_relative_fitness_on_a_gene_is_found() -> None:
    genes = np.linspace(-1, 1.5, 20_000)
    children = np.random.default_rng(4).poisson(2.0 * (1 + 0.3 * genes)).astype(float)
    assert fitness_slope(genes, children) == pytest.approx(0.3 / (1 + 0.3 * genes.mean()), abs=0.03)
    assert fitness_slope(genes, np.zeros(20_000)) is None
    assert fitness_slope(genes, np.where(genes > 0, np.nan, children)) is None
    assert known_mean(np.array([1.0, 2.0])) == 1.5
    assert known_mean(np.array([1.0, np.nan])) is None


def test_spread_founders_differ_in_all_genes_but_the_fixed_ones() -> None:
    table = spread_gene(load_config("appetite"), -1.0, 3.0, {"w_normal": 0.5})
    genomes = dict(zip(table.genes, table.values.T, strict=True))
    assert set(genomes["w_normal"]) == {0.5}
    for name in ("w_action", "neutral_1", "neutral_16"):
        ranked = np.sort(genomes[name])
        assert ranked == pytest.approx(np.linspace(-1, 3, len(ranked)), abs=0.15)
    assert abs(np.corrcoef(genomes["w_action"], genomes["neutral_1"])[0, 1]) < 0.1


def test_worlds_without_children_give_a_figure_without_points() -> None:
    childless = [row | {"slope": None} for row in rows(0.05, seeds=2)]
    assert svg_bytes(draw_slopes("Do shorter lives favor faster learning?", childless).figure)


def water_rows(gated: float, free: float, seeds: int = WORLDS) -> list[dict]:
    """Rows of worlds whose slopes are around `gated` where food needs water, and around `free` elsewhere."""
    rng = np.random.default_rng(3)
    return [
        {"condition": condition, "seed": seed, "died out": False, "slope": rng.normal(mean, 0.1), "food": 10.0}
        | {"intake": [8.0, 9.0, 11.0, 12.0]}
        for seed in range(seeds)
        for condition, mean in ((GATED, gated), (FREE, free))
    ]


def test_liking_a_means_is_fit_only_if_it_is_fitter_than_where_it_is_useless() -> None:
    assert answers(*optimal.named_tests(water_rows(0.5, 0.0))) == [YES, YES]
    assert answers(*optimal.named_tests(water_rows(0.5, 0.5))) == [YES, OPEN]
    assert answers(*optimal.named_tests(water_rows(0.0, 0.5))) == [OPEN, NO]
    assert answers(*optimal.named_tests(water_rows(0.5, 0.0, seeds=WORLDS - 1))) == [OPEN, OPEN]


def test_a_pair_without_one_of_its_worlds_has_no_difference() -> None:
    rows = water_rows(0.5, 0.0)
    slope, difference = optimal.named_tests(rows[:-1])
    assert (slope.worlds, difference.worlds, difference.values) == (WORLDS, WORLDS - 1, WORLDS - 1)
    starved = [row | {"slope": None, "food": 0.0, "died out": True} if row["seed"] == 0 else row for row in rows]
    slope, difference = optimal.named_tests(starved)
    assert (slope.values, slope.extinct, difference.values, difference.extinct) == (WORLDS - 1, 1, WORLDS - 1, 2)
    assert svg_bytes(draw_intake("Is a liking for water fit if water is only a means to food?", starved).figure)


def need_rows(two: float, one: float, additive: float, seeds: int = WORLDS) -> list[dict]:
    """Rows of worlds in which the share of reducers changes by about these numbers."""
    rng = np.random.default_rng(4)
    return [
        {"condition": condition, "seed": seed, "died out": False, "change": rng.normal(mean, 0.05)}
        for seed in range(seeds)
        for condition, mean in ((TWO, two), (ONE, one), (ADDITIVE, additive))
    ]


def test_drive_reduction_must_be_fitter_with_two_needs_than_with_one() -> None:
    assert answers(*needs.named_tests(need_rows(0.2, 0.0, 0.2))) == [YES, YES, OPEN]
    assert answers(*needs.named_tests(need_rows(0.2, 0.2, 0.0))) == [YES, OPEN, YES]
    assert answers(*needs.named_tests(need_rows(-0.2, 0.0, -0.4))) == [NO, NO, YES]
    assert answers(*needs.named_tests(need_rows(0.2, 0.0, 0.0, seeds=WORLDS - 1))) == [OPEN] * 3


def test_worlds_without_a_partner_count_in_the_first_test_only() -> None:
    rows = need_rows(0.2, 0.0, 0.2)
    rows = [row | {"died out": row["seed"] == 1} for row in rows if (row["seed"], row["condition"]) != (0, ONE)]
    assert needs.follow_up(rows).worlds == 0
    paid = [{"condition": PAID, "seed": seed, "died out": False, "change": 0.5} for seed in range(WORLDS)]
    assert answers(needs.follow_up(rows + paid)) == [YES]
    first, second, third = needs.named_tests(rows)
    assert [test.worlds for test in (first, second, third)] == [WORLDS, WORLDS - 1, WORLDS]
    assert [test.extinct for test in (first, second, third)] == [1, 2, 2]
    assert svg_bytes(draw_changes("Is drive reduction fitter than pay per meal?", rows).figure)


def test_more_tests_make_the_rule_stricter() -> None:
    found = count_test("clusters", 6, WORLDS, 0, 1 / 17, above=True)
    assert found.effect == pytest.approx(6 / WORLDS - 1 / 17)
    assert 0.005 < found.p < 0.02
    assert verdict_table("alone", (found,)).rows["answer"].to_list() == [YES]
    assert verdict_table("of ten", (found,), named=10).rows["answer"].to_list() == [OPEN]
    assert answers(count_test("none", 0, 0, 0, 1 / 17, above=True)) == [OPEN]


def shares(start: float, change: float, worlds: int = WORLDS) -> list[Lines]:
    """Worlds of 100 agents whose share of foragers changes by slightly more or less than `change`."""
    found = []
    for seed in range(worlds):
        p = np.array([start, start + change + 0.01 * (-1) ** seed])
        time, count = np.arange(2), np.stack([100 * p, 100 * (1 - p)], axis=1)
        found.append(Lines(seed, time, count, time.astype(float), np.zeros(0), np.zeros(0), ended=seed == 0))
    return found


def test_foragers_and_trackers_invade_each_other_if_both_grow_when_rare() -> None:
    found = invasion_tests({RARE: shares(RARE, 0.1), COMMON: shares(COMMON, -0.1)})
    assert [test.effect for test in found] == pytest.approx([0.1, -0.1])
    assert [test.extinct for test in found] == [1, 1]
    assert answers(*found) == [YES, YES]
    assert answers(*invasion_tests({RARE: shares(RARE, -0.03), COMMON: shares(COMMON, -0.1)})) == [NO, YES]
    assert answers(*invasion_tests({COMMON: shares(COMMON, -0.1)})) == [OPEN, YES]


def test_the_table_of_worlds_has_their_shares_and_whether_they_died_out() -> None:
    first, second = world_rows({RARE: shares(RARE, 0.1, worlds=2)})
    assert (first["foragers"], first["seed"], first["died out"]) == (RARE, 0, True)
    assert (second["seed"], second["died out"]) == (1, False)
    assert (first["start"], first["end"]) == pytest.approx((RARE, RARE + 0.11))
    assert (second["start"], second["end"]) == pytest.approx((RARE, RARE + 0.09))
    assert first["generations"] == 1


def test_clusters_are_judged_against_neutral_genes() -> None:
    rows = [{"clusters": seed % 2 == 0, "died out": seed < 3, "neutral genes": 16} for seed in range(WORLDS)]
    assert answers(cluster_test(rows)) == [YES]
    assert cluster_test(rows).extinct == 3
    assert answers(cluster_test([row | {"clusters": seed == 0} for seed, row in enumerate(rows)])) == [OPEN]
    assert answers(cluster_test([row | {"clusters": None} for row in rows])) == [OPEN]
    assert answers(cluster_test([])) == [OPEN]


def run_quick(folder: Path, name: str) -> dict[str, list[dict]]:
    answer = hedon("study", "run", name, "--quick", cwd=folder)
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "studies" / name / "study.json").read_text(encoding="utf-8"))
    tables = {key: table["rows"] for key, table in found["tables"].items()}
    answers = {row["answer"] for key, table in tables.items() if key.endswith("_verdict") for row in table}
    assert answers == {OPEN}
    assert len(tables["world"]) == sum(len(item["worlds"]) for item in found["items"]), "one seed per condition"
    assert read_table(str(folder / "studies" / name)).factors == ("condition",)
    assert (folder / "studies" / name / "figures" / f"{name}.svg").stat().st_size > 10_000
    (seed,) = {row["seed"] for row in tables["world"]}
    shorter = hedon("study", "report", name, "--seeds", str(seed), "--steps", "1500", "--out", "cut", cwd=folder)
    assert (shorter.returncode, shorter.stderr) == (0, ""), "what living agents had eaten by then is not recorded"
    cut = json.loads((folder / "cut" / "study.json").read_text(encoding="utf-8"))
    assert len(cut["tables"]["world"]["rows"]) == len(tables["world"])
    assert not re.search(r"\bnan\b", json.dumps(cut), re.IGNORECASE)
    return tables


@pytest.mark.more
def test_lifespan_and_plasticity_runs_from_its_settings_to_its_page(tmp_path: Path) -> None:
    tables = run_quick(tmp_path, "lifespan-and-plasticity")
    assert [row["hazard"] for row in tables["lifespan_world"]] == list(HAZARDS)
    assert len(tables["lifespan_control"]) == 16


@pytest.mark.more
def test_optimal_reward_runs_from_its_settings_to_its_page(tmp_path: Path) -> None:
    tables = run_quick(tmp_path, "optimal-reward")
    assert [row["condition"] for row in tables["optimal_reward_world"]] == [GATED, FREE]
    gated, free = tables["optimal_reward_world"]
    assert gated["food"] <= gated["water"], "a meal uses up a unit of water, and founders begin without any"
    assert gated["food"] < free["food"]
    assert len(tables["optimal_reward_control"]) == 2 * 16


@pytest.mark.more
def test_two_needs_runs_from_its_settings_to_its_page(tmp_path: Path) -> None:
    tables = run_quick(tmp_path, "two-needs")
    rows = {row["condition"]: row for row in tables["two_needs_world"]}
    assert list(rows) == list(needs.CONDITIONS)
    for row in rows.values():
        assert row["alive"] > 0
        assert min(row[f"{group} {kind}"] for group in ("reducers", "eaters") for kind in ("food", "water")) > 0


def test_mating_strategies_runs_from_its_settings_to_its_page(tmp_path: Path) -> None:
    tables = run_quick(tmp_path, "mating-strategies")
    assert [row["share at the start"] for row in tables["frequency_share"]] == [0.05, 0.25, 0.5, 0.75, 0.95]
    assert [row["worlds"] for row in tables["frequency_share"]] == [1] * 5
    assert [row["foragers"] for row in tables["mating_share_world"]] == [0.05, 0.25, 0.5, 0.75, 0.95]
    assert len(tables["mating_world"]) == 1
