"""Studies of classic questions: their decision rule works as written, and each runs from its settings to its page."""

import json
from pathlib import Path

import numpy as np
import pytest
from command import hedon

from hedon.assay import Lines
from hedon.compare.source import read_table
from hedon.figure.style import svg_bytes
from hedon.statistic import FOR_VERDICT as WORLDS
from hedon_studies.lifespan_and_plasticity.study import CHANGING, CONSTANT, draw_rates, named_tests
from hedon_studies.mating_strategies.study import COMMON, RARE, cluster_test, invasion_tests
from hedon_studies.rule import NO, OPEN, YES, count_test, mean_test, slope_test, verdict_table


def answers(*tests) -> list[str]:
    return verdict_table("made_up", tests).rows["answer"].to_list()


def test_a_clear_effect_is_yes_on_one_side_and_no_on_the_other() -> None:
    rng = np.random.default_rng(1)
    values = rng.normal(1.0, 1.0, WORLDS)
    both = [mean_test("a", values, WORLDS, 0, above=above) for above in (True, False)]
    assert answers(*both) == [YES, NO]
    assert both[0].low < 1.0 < both[0].high
    x = np.linspace(0, 1, WORLDS)
    slopes = [slope_test("a", x, -2.0 * x + rng.normal(0, 0.3, WORLDS), 0, above=above) for above in (False, True)]
    assert answers(*slopes) == [YES, NO]
    assert slopes[0].low < -2.0 < slopes[0].high < 0


def test_few_worlds_and_chance_leave_the_answer_open() -> None:
    rng = np.random.default_rng(2)
    few = mean_test("few", rng.normal(5.0, 1.0, WORLDS - 1), WORLDS - 1, 0, above=True)
    none = mean_test("none", rng.normal(0.0, 1.0, 100), 100, 0, above=True)
    empty = slope_test("empty", [], [], 0, above=True)
    assert few.p < 1e-6
    assert answers(few, none, empty) == [OPEN, OPEN, OPEN]


def test_three_values_from_thirty_worlds_leave_the_answer_open() -> None:
    few = mean_test("few", [5.0, 5.1, 4.9], WORLDS, 27, above=True)
    assert few.p < 0.001
    assert answers(few) == [OPEN]


def test_an_effect_that_two_worlds_cannot_show_is_reported_in_words() -> None:
    assert slope_test("few", [1.0, 2.0], [0.1, 0.2], 0, above=True).said == "not known from 2 worlds"
    assert slope_test("one", [1.0], [0.1], 0, above=True).said == "not known from 1 world"
    known = slope_test("known", [1.0, 2.0, 3.0], [0.1, 0.2, 0.3], 0, above=True)
    assert known.said.startswith("0.1 (0.1 to 0.1")


def test_tests_of_a_study_are_corrected_for_each_other() -> None:
    x = np.arange(WORLDS, dtype=float)
    weak = next(
        found
        for seed in range(1000)
        if 0.03
        < (found := slope_test("weak", x, x + np.random.default_rng(seed).normal(0, 25, 30), 0, above=True)).p
        < 0.05
    )
    none = mean_test("none", np.tile([1.0, -1.0], WORLDS), 2 * WORLDS, 0, above=True)
    assert answers(weak) == [YES]
    assert answers(weak, none) == [OPEN, OPEN]


def rows(slope: float, difference: float) -> list[dict]:
    """Worlds whose genes follow the lifetime as given; one in six died out."""
    rng = np.random.default_rng(3)
    found = []
    for world, more in ((CONSTANT, 0.0), (CHANGING, difference)):
        for hazard in (0.25, 0.5, 1.0, 2.0, 4.0):
            for seed in range(1, 7):
                lifetime = 5e4 / hazard * rng.uniform(0.9, 1.1)
                rate = slope * np.log10(lifetime) + more + rng.normal(0, 0.02)
                known = {"rate": rate, "lifetime": lifetime, "died out": seed == 1}
                found.append({"world": world, "hazard": hazard, "seed": seed} | known)
    return found


def test_lifespan_and_plasticity_recovers_known_effects() -> None:
    slope, difference = named_tests(rows(-0.2, 0.1))
    assert slope.low < -0.2 < slope.high
    assert difference.low < 0.1 < difference.high
    assert (slope.worlds, slope.extinct) == (30, 5)
    assert (difference.worlds, difference.extinct) == (30, 10)
    assert answers(slope, difference) == [YES, YES]
    assert answers(*named_tests(rows(0.2, -0.1))) == [NO, NO]
    lost = [row | ({"lifetime": None, "rate": None} if row["hazard"] == 4.0 else {}) for row in rows(-0.2, 0.1)]
    assert answers(*named_tests(lost)) == [OPEN, OPEN], "24 worlds are left"


def test_worlds_whose_agents_have_not_died_give_a_figure_without_points() -> None:
    young = [row | {"lifetime": None} for row in rows(-0.2, 0.1)]
    figure = draw_rates("How fast do they learn?", young, named_tests(young)[0]).figure
    assert svg_bytes(figure)


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
    return tables


@pytest.mark.long
def test_lifespan_and_plasticity_runs_from_its_settings_to_its_page(tmp_path: Path) -> None:
    worlds = run_quick(tmp_path, "lifespan-and-plasticity")["lifespan_world"]
    assert len(worlds) == 10
    assert all(abs(row["rate"]) < 0.2 for row in worlds)


def test_mating_strategies_runs_from_its_settings_to_its_page(tmp_path: Path) -> None:
    tables = run_quick(tmp_path, "mating-strategies")
    assert [row["share at the start"] for row in tables["frequency_share"]] == [0.05, 0.25, 0.5, 0.75, 0.95]
    assert [row["worlds"] for row in tables["frequency_share"]] == [1] * 5
    assert len(tables["mating_world"]) == 1
