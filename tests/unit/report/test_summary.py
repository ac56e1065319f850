import io
import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from rich.console import Console
from synthetic_run import write_run

from hedon.cli.display.summary import summary_table
from hedon.measure.summary import plain
from hedon.measure.summary_key import INTERVAL_KEYS, RUN_KEYS, WORLD_KEYS
from hedon.record.reader import open_run
from hedon.report.document import figure_table, records_page
from hedon.report.run import run_summary
from hedon.report.table import format_number

ROOT = Path(__file__).parents[3]


def test_every_key_is_documented_and_every_documented_key_is_there(tmp_path: Path) -> None:
    summary = run_summary(open_run(write_run(tmp_path / "run", intervals=10, worlds=2)))
    assert set(summary) == set(RUN_KEYS)
    assert set(summary["mean_lifetime"]) == set(summary["weights"]["w_normal"]) == set(INTERVAL_KEYS)
    assert all(set(world) == set(WORLD_KEYS) for world in summary["worlds"])
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary


def test_numbers_agree_with_the_tables(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=40, worlds=5, food_kinds=("normal", "poison")))
    summary, agents = run_summary(run), run.agents()
    for index, world in enumerate(summary["worlds"]):
        mine = agents.filter(agents["world"] == index)
        dead = mine.filter(mine["death_step"].is_not_null())
        life = dead["death_step"].to_numpy() - dead["birth_step"].to_numpy()
        eaten = dead["eaten_normal"].to_numpy() + dead["eaten_poison"].to_numpy()
        assert world["deaths"] == dead.height
        assert world["births"] == mine.height - 50
        assert world["mean_lifetime"] == pytest.approx(np.mean(life))
        assert world["food_per_step"] == pytest.approx(np.mean(eaten / life))
        assert world["eaten"]["poison"] == mine["eaten_poison"].sum()
        living = mine.filter(mine["death_step"].is_null())
        assert world["weights"]["w_poison"]["mean"] == pytest.approx(living["w_poison"].to_numpy().mean(), rel=1e-4)
        assert world["ledger"]["residual"] < 1e-3
        assert world["steps_per_second"] == pytest.approx(world["steps"] / 10.0)
    lifetimes = [world["mean_lifetime"] for world in summary["worlds"]]
    assert summary["mean_lifetime"]["mean"] == pytest.approx(np.mean(lifetimes))
    assert summary["mean_lifetime"]["low"] < np.mean(lifetimes) < summary["mean_lifetime"]["high"]
    assert summary["pooled"]["agents"] == sum(world["deaths"] for world in summary["worlds"])
    assert summary["reported"]["kanagawa-doya-2024"]["mean_lifetime"] == 6310


def test_extinct_worlds_count_but_not_among_the_survivors(tmp_path: Path) -> None:
    summary = run_summary(open_run(write_run(tmp_path / "run", intervals=40, worlds=3, extinct=1)))
    assert summary["extinct_worlds"] == 1
    world = summary["worlds"][1]
    assert world["extinct"] is True
    assert world["extinct_step"] == world["steps"] < 40 * 1024
    assert world["alive"] == 0
    assert summary["mean_lifetime"]["worlds"] == 3
    assert summary["surviving"]["mean_lifetime"]["worlds"] == 2
    assert summary["surviving"]["alive_mean"]["mean"] > summary["alive_mean"]["mean"]


def test_worlds_that_died_out_count_as_empty(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=40, worlds=3, extinct=1)
    summary = run_summary(open_run(folder))
    rows = open_run(folder).population()
    ended = rows.filter((pl.col("world") == 1) & (pl.col("step") > 0.9 * 40 * 1024))
    assert summary["worlds"][1]["alive_mean"] == pytest.approx(int(ended["agent_steps"].sum()) / (0.1 * 40 * 1024))
    assert summary["worlds"][1]["mean_energy"] is None
    alive = [world["alive_mean"] for world in summary["worlds"]]
    assert summary["alive_mean"]["mean"] == pytest.approx(sum(alive) / 3), "all three worlds, including the extinct one"


def test_a_run_without_rows_has_a_summary(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=0, worlds=1, preset=None, name=None, neutral_count=0))
    summary = run_summary(run)
    assert summary["reported"] == {}
    assert summary["worlds"][0]["alive"] == 50
    assert summary["worlds"][0]["mean_lifetime"] is None
    assert summary["mean_lifetime"]["mean"] is None
    _print(summary)


def test_a_damaged_part_is_named_in_the_summary(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=10, worlds=1)
    (folder / "agents/part-000000.parquet").write_bytes(b"torn")
    summary = run_summary(open_run(folder))
    assert summary["damaged_parts"] == ["agents/part-000000.parquet"]
    assert "agents/part-000000.parquet" in _print(summary)


def test_the_table_shows_our_numbers_next_to_the_papers(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=40, worlds=3, extinct=1))
    text = _print(run_summary(run))
    assert "lifetime of the dead [step]" in text
    assert "6,310" in text
    assert "1 of 3 worlds died out" in text
    assert "baseline (corrected): 3 worlds" in text
    assert "kanagawa-doya-2024 (10.24e6 steps)" in text


@pytest.mark.parametrize(
    ("options", "title"),
    [
        ({"name": "mushrooms", "modified": True}, "mushrooms (baseline, corrected, modified): 1 world"),
        ({"modified": True}, "baseline (corrected, modified): 1 world"),
        ({"name": None, "modified": None}, "baseline (corrected): 1 world"),  # an old manifest
    ],
    ids=["own file", "override", "unknown"],
)
def test_the_papers_numbers_are_shown_only_for_its_own_conditions(tmp_path: Path, options: dict, title: str) -> None:
    summary = run_summary(open_run(write_run(tmp_path / "run", intervals=5, worlds=1, **options)))
    assert summary["reported"] == {}
    text = _print(summary)
    assert title in text
    assert "paper" not in text.lower()


def test_the_table_has_intervals_from_five_worlds_on(tmp_path: Path) -> None:
    lines = []
    for worlds in (4, 5):
        summary = run_summary(open_run(write_run(tmp_path / f"{worlds}", intervals=20, worlds=worlds)))
        assert (summary["alive_mean"]["low"] is None) == (worlds < 5)
        lines += [line for line in _print(summary).splitlines() if "agents alive" in line]
    assert "…" not in lines[0].replace("130 … 150", "")
    assert "…" in lines[1].replace("130 … 150", "")


def test_numbers_for_a_reader() -> None:
    texts = [format_number(value) for value in (None, 6310.4, 137.2, 0.0045, 0, -2.126, 12)]
    assert texts == ["-", "6,310", "137", "0.0045", "0", "-2.13", "12"]


def test_plain_values() -> None:
    value = {
        "a": np.float32(1.5),
        "b": (np.int64(2), float("nan")),
        "c": [np.bool_(True), None, "x"],
        "d": np.inf,
    }
    assert plain(value) == {"a": 1.5, "b": [2, None], "c": [True, None, "x"], "d": None}


def test_the_page_of_the_records_is_current() -> None:
    page = (ROOT / "docs/records.md").read_text(encoding="utf-8")
    assert page == records_page(), "run: uv run python -m hedon.report.document > docs/records.md"


def test_the_page_of_the_figures_has_their_captions() -> None:
    page = (ROOT / "docs/figures.md").read_text(encoding="utf-8")
    assert figure_table() in page, "paste there the output of hedon.report.document.figure_table()"


def test_a_narrow_terminal_shows_every_number_in_full(tmp_path: Path) -> None:
    summary = run_summary(open_run(write_run(tmp_path / "run", intervals=40, worlds=5)))
    text = _print(summary, width=60)
    assert max(map(len, text.splitlines())) <= 60
    for world in summary["worlds"]:
        assert all(format_number(world[key]) in text for key in ("steps", "births", "mean_lifetime", "food_per_step"))
    alive = summary["alive_mean"]
    assert f"{format_number(alive['low'])} … {format_number(alive['high'])}" in text


def test_one_world_has_no_column_of_intervals(tmp_path: Path) -> None:
    assert "interval" not in _print(run_summary(open_run(write_run(tmp_path / "run", intervals=5, worlds=1))))


def _print(summary: dict, width: int = 120) -> str:
    console = Console(width=width, record=True, file=io.StringIO(), force_terminal=True)
    console.print(summary_table(summary))
    return console.export_text()
