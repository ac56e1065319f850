import csv
import io
import json
from pathlib import Path
from typing import Any

import polars as pl
import pytest
from resumed_run import small_run
from rich.console import Console
from synthetic_run import write_run

from hedon import ArgumentError
from hedon.analysis.agent.lifetime import mean_lifetime
from hedon.analysis.result import make_table
from hedon.cli.display.analysis import analysis_group
from hedon.record.reader import open_run
from hedon.report.analysis import Analysis, analyze, write_analysis
from hedon.report.markdown import escape_markdown, pipe_table
from hedon.report.table import cells
from hedon.report.topic import TOPICS, TopicError, choose_topics


@pytest.fixture(scope="module")
def analysis(tmp_path_factory: pytest.TempPathFactory) -> Analysis:
    folder = tmp_path_factory.mktemp("analyze") / "run"
    options = {"intervals": 60, "worlds": 4, "extinct": 3, "food_kinds": ("normal", "poison")}
    return analyze([open_run(write_run(folder, snapshot=False, **options))])


def test_every_topic_has_a_table(analysis: Analysis) -> None:
    for topic in TOPICS.keys() - {"verdict"}:  # two foods with the settings for one: not a condition of the paper
        assert topic in analysis.tables
    lone = {"lifetime_world", "survival", "selection_world", "price_world", "drift_world", "lineage", "regime_time"}
    assert lone <= set(analysis.tables)


def test_numbers_agree_with_the_statistics(analysis: Analysis) -> None:
    rows = analysis.tables["lifetime_world"].rows
    agents = analysis.runs[0].agents()
    for i in range(4):
        assert rows["mean_of_dead"][i] == pytest.approx(mean_lifetime(agents.filter(pl.col("world") == i)))
    assert rows["until"].n_unique() == 1
    life = {row["quantity"]: row for row in analysis.tables["lifetime"].rows.to_dicts()}
    assert life["error of the dead's restricted mean"]["mean"] < 0
    assert life["mean of the dead"]["mean"] == pytest.approx(rows["mean_of_dead"].to_numpy().mean())
    regime = analysis.tables["regime"].rows
    assert regime["mean"].to_numpy().sum() == pytest.approx(1.0)
    price = analysis.tables["price_world"].rows
    assert price["residual"].drop_nulls().abs().to_numpy().max() < 1e-12
    drift = analysis.tables["drift"].rows
    assert set(drift["weight"]) == {"w_normal", "w_poison", "w_action", "neutral_1"}


def test_one_of_two_species_may_have_no_neutral_genes(tmp_path: Path) -> None:
    two = ("species.plain.genome.neutral_count=0", "species.marked.genome.neutral_count=2")
    small_run(tmp_path / "run", 96, seeds=(1,), overrides=two)
    lines = analyze([open_run(tmp_path / "run")], ["genealogy"]).tables["lineage"].rows
    names = {name.rpartition(": ")[2]: set(lines.filter(condition=name)["weight"]) for name in set(lines["condition"])}
    assert names == {"plain": {"w_normal", "w_action"}, "marked": {"w_normal", "w_action", "neutral_1", "neutral_2"}}


def test_a_table_of_one_of_two_species_names_it(tmp_path: Path) -> None:
    two = ("species.single.population.capacity=24", 'species.paired.birth.mating="pairs"')
    small_run(tmp_path / "run", 96, seeds=(1,), overrides=two)
    found = analyze([open_run(tmp_path / "run")], ["genealogy"]).tables["genealogy"]
    headers, rows = cells(found)
    assert headers[0] == "condition"
    assert {row[0].rpartition(": ")[2] for row in rows} == {"single"}, "only species with single parents have trees"


def test_the_same_records_give_the_same_answers(analysis: Analysis) -> None:
    again = analyze(analysis.runs, ["selection", "drift"])
    assert {"selection", "drift"} <= set(again.tables)
    for name, result in again.tables.items():
        assert result.rows.equals(analysis.tables[name].rows)


def test_files_hold_every_number(analysis: Analysis, tmp_path: Path) -> None:
    files = write_analysis(analysis, tmp_path / "out")
    assert {file.stem for file in files} == {"analysis", *analysis.tables}
    content = json.loads((tmp_path / "out/analysis.json").read_text())
    assert content["runs"][0]["manifest"]["seeds"] == [1, 2, 3, 4]
    assert [world["extinct_step"] is None for world in content["worlds"]] == [True, True, True, False]
    for name, result in analysis.tables.items():
        with (tmp_path / f"out/{name}.csv").open() as file:
            assert len(list(csv.DictReader(file))) == result.rows.height == len(content["tables"][name]["rows"])


def test_only_the_tables_of_an_earlier_analysis_are_removed(analysis: Analysis, tmp_path: Path) -> None:
    write_analysis(analysis, tmp_path)
    (tmp_path / "mine.csv").write_text("a\n")
    (tmp_path.parent / "beside.csv").write_text("b\n")
    written = {file.name for file in write_analysis(analyze(analysis.runs, ["lifetime"]), tmp_path)}
    assert {file.name for file in tmp_path.iterdir() if not file.name.startswith(".")} == {*written, "mine.csv"}
    for content in ('{"tables": {"../beside": 1, "lifetime": 1}}', '{"tables": 5}', "[]", "torn"):
        (tmp_path / "analysis.json").write_text(content)
        write_analysis(analyze(analysis.runs, ["lifetime"]), tmp_path)
        assert {file.name for file in tmp_path.iterdir() if not file.name.startswith(".")} == {*written, "mine.csv"}
    assert (tmp_path.parent / "beside.csv").exists()


def test_what_is_printed(analysis: Analysis) -> None:
    console = Console(width=110, record=True, file=io.StringIO())
    console.print(analysis_group(analysis.tables))
    text = console.export_text()
    assert "starving, limited by room" in text
    assert "95 % interval" in text
    assert "condition" not in text  # there is only one
    assert "lifetime_world" not in text


def test_what_is_printed_on_a_narrow_terminal(analysis: Analysis) -> None:
    console = Console(width=60, record=True, file=io.StringIO(), force_terminal=True)
    console.print(analysis_group(analysis.tables))
    text = console.export_text()
    assert max(map(len, text.splitlines())) <= 60
    for result in analysis.tables.values():
        if result.shown:
            assert all(cell in text for row in cells(result)[1] for cell in row if cell[:1].isdigit())


def test_cells_hide_intervals_over_few_worlds_and_show_what_tells_rows_apart() -> None:
    rows = [
        {"condition": "a", "quantity": "x", "mean": 1.0, "low": 0.5, "high": 1.5, "worlds": 4},
        {"condition": "b", "quantity": "x", "mean": 2e-17, "low": 0.5, "high": 1.5, "worlds": 5},
        {"condition": "b", "quantity": "y", "mean": float("nan"), "low": None, "high": None, "worlds": 0},
    ]
    headers, shown = cells(make_table("t", "T", rows))
    assert headers == ["condition", "quantity", "mean", "95 % interval", "worlds"]
    assert shown == [["a", "x", "1.00", "", "4"], ["b", "x", "0", "0.500 … 1.50", "5"], ["b", "y", "", "", "0"]]
    assert escape_markdown("w_normal [step], 95 % > 0.5") == "w_normal \\[step\\], 95 % \\> 0.5"
    assert pipe_table(["a"], [["x|y"]]) == "| a |\n| --- |\n| x\\|y |\n"


def test_columns_without_a_value_are_left_out() -> None:
    rows = [{"quantity": "x", "mean": 1.0, "low": None, "high": None, "p": None, "worlds": 1}]
    assert cells(make_table("t", "T", rows)) == (["quantity", "mean", "worlds"], [["x", "1.00", "1"]])
    two = [row | {"low": 0.0, "high": 2.0, "worlds": 2} for row in rows]
    assert cells(make_table("t", "T", two))[0] == ["quantity", "mean", "worlds"]


def test_notes_are_plain_and_explain_the_words_of_the_energy_budget(analysis: Analysis) -> None:
    for result in analysis.tables.values():
        assert "`" not in result.title + result.note
    budget = analysis.tables["energy"]
    for word in {row["quantity"].removeprefix("share ") for row in budget.rows.to_dicts()}:
        assert word in budget.note.lower()


def test_a_run_without_rows_has_an_analysis(tmp_path: Path) -> None:
    empty = analyze([open_run(write_run(tmp_path / "run", intervals=0, worlds=1, neutral_count=0, snapshot=False))])
    assert "regime" not in empty.tables  # nothing was recorded from which to infer it
    write_analysis(empty, tmp_path / "out")
    kept = json.loads((tmp_path / "out" / "analysis.json").read_text(encoding="utf-8"))
    assert set(kept["tables"]) == set(empty.tables) > {"lifetime"}
    assert [(world["last_step"], world["extinct_step"]) for world in kept["worlds"]] == [(0, None)]


def test_choosing_topics() -> None:
    assert choose_topics(None) == tuple(TOPICS)
    assert choose_topics("selection, lifetime") == ("lifetime", "selection")
    with pytest.raises(TopicError, match="no topic 'selecton'; did you mean selection"):
        choose_topics("selecton")


def test_an_invalid_topic_or_run_is_named(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=1, worlds=1))
    with pytest.raises(TopicError, match="no topic 'regmie'; did you mean regime"):
        analyze([run], topics=["regmie"])
    wrong: Any = analyze
    for runs in (run, "runs/mine", ["runs/mine"], 5):
        with pytest.raises(ArgumentError, match="runs: must be a list of runs, as open_run gives them"):
            wrong(runs)
