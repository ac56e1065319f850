"""Readers see neutral genes as one row, and conditions are named after the settings in which they differ."""

from pathlib import Path

from resumed_run import small_run

from hedon.analysis.result import make_table
from hedon.analysis.world.record import read_worlds
from hedon.record.reader import open_run
from hedon.report.markdown import pipe_table
from hedon.report.table import cells, is_numeric, table_csv, table_json
from hedon.text import p_phrase


def test_neutral_genes_are_one_row_of_each_group():
    rows = [
        {"condition": condition, "weight": weight, "mean": mean, "low": 0.0, "high": 9.0, "worlds": 5, "p": p}
        for condition in ("a", "b")
        for weight, mean, p in (("w_food", 1.0, 0.5), ("neutral_1", 2.0, 0.01), ("neutral_2", 4.0, 0.2))
    ]
    table = make_table("any", "Any", rows)
    headers, shown = cells(table)
    assert [row[headers.index("weight")] for row in shown] == ["w_food", "2 neutral: 1 with p < 0.05"] * 2
    assert [row[headers.index("mean")] for row in shown] == ["1.00", "3.00"] * 2
    assert [row[headers.index("95 % interval")] for row in shown][1] == ""
    assert table.rows.height == 6, "the files have every row"
    one = make_table("one", "One", [row for row in rows if row["weight"] != "neutral_2"])
    assert [row[headers.index("weight")] for row in cells(one)[1]] == ["w_food", "neutral_1"] * 2
    assert cells(make_table("none", "None", [{"weight": 3.0}, {"weight": 4.0}]))[1] == [["3.00"], ["4.00"]]


def test_small_p_values_are_abbreviated_for_readers_but_exact_in_files():
    rows = [
        {"gene": "w_food", "effect": 4.2e-7, "p": 4.2e-14, "p Holm": 0.00011, "p_held": 0.0},
        {"gene": "w_action", "effect": 1.0, "p": 0.028, "p Holm": 1.0, "p_held": None},
    ]
    table = make_table("any", "Any", rows)
    headers, shown = cells(table)
    assert headers == ["gene", "effect", "p", "p Holm", "p held"]
    assert shown[0] == ["w_food", "4.2e-07", "< 0.0001", "0.00011", "< 0.0001"]
    assert shown[1] == ["w_action", "1.00", "0.0280", "1.00", ""]
    assert [is_numeric(shown, i) for i in range(5)] == [False, True, True, True, True]
    assert r"| \< 0.0001 |" in pipe_table(headers, shown)
    assert "4.2e-14" in table_csv(table)
    assert table_json(table)["rows"][0]["p"] == 4.2e-14
    assert (p_phrase(4.2e-14), p_phrase(0.0284), p_phrase(1.0)) == ("p < 0.0001", "p = 0.028", "p = 1")


def test_conditions_with_the_same_name_are_distinguished_by_what_differs(tmp_path: Path):
    for name, cost in (("a", "0.001"), ("b", "0.002")):
        small_run(tmp_path / name, 64, seeds=(1,), overrides=(f"energy.basic_cost={cost}",))
    small_run(tmp_path / "c", 64, seeds=(2,), overrides=("energy.basic_cost=0.001",))
    worlds = read_worlds(open_run(tmp_path / name) for name in "abc")
    assert [(world.condition, world.seed) for world in worlds] == [
        ("baseline (corrected): energy.basic_cost 0.001", 1),
        ("baseline (corrected): energy.basic_cost 0.002", 1),
        ("baseline (corrected): energy.basic_cost 0.001", 2),
    ]
    (alone,) = read_worlds([open_run(tmp_path / "a")])
    assert alone.condition == "baseline (corrected), modified"
