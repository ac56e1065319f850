from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.figure.named import NamedFigure
from hedon.record.reader import open_run
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.figure.supply import draw_supply
from hedon_studies.kanagawa_doya_2024.paper import PAPER
from hedon_studies.kanagawa_doya_2024.supply import CONDITIONS, SUPPLY, growth

ITEM = SUPPLY


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    path = tmp_path_factory.mktemp("supply") / "run"
    return read_worlds([open_run(write_run(path, worlds=2, intervals=40, snapshot=False))])


def make(found: Mapping[str, Sequence[WorldRecord]]) -> tuple[dict[str, ResultTable], list[NamedFigure]]:
    parts = list(ITEM.make(ItemInputs("corrected", found)))
    tables = {part.name: part for part in parts if isinstance(part, ResultTable)}
    return tables, [part for part in parts if isinstance(part, NamedFigure)]


def test_with_the_fault_and_in_the_papers_program_five_times_as_much_grows() -> None:
    grows = {condition.label: growth(condition.config("corrected")) for condition in CONDITIONS}
    assert len(grows) == 9
    for label, value in grows.items():
        assert value == (0.2 if label.endswith("corrected") else 1.0), label


def test_eaten_food_is_counted_in_the_last_tenth(worlds: list[WorldRecord]) -> None:
    tables, _ = make({"small, corrected": worlds})
    rows = tables["supply_worlds"].rows
    for row, world in zip(rows.rows(named=True), worlds, strict=True):
        tail = world.population.filter(pl.col("step") > 0.9 * world.last_step)
        assert tail.height == 4
        eaten = int(tail["eaten_normal"].sum())
        assert row["eaten_share"] == pytest.approx(eaten / (0.2 * 4 * 1024))
        assert row["eaten"] == pytest.approx(eaten / int(tail["agent_steps"].sum()))
        # The point of a world is on the line of what it eats: the number of agents times what each eats.
        assert row["eaten"] * row["alive_mean"] == pytest.approx(0.2 * row["eaten_share"])
    [condition] = tables["supply"].rows.rows(named=True)
    assert (condition["condition"], condition["worlds"], condition["grows"]) == ("small, corrected", 2, 0.2)
    assert condition["eaten_share"] == pytest.approx(rows["eaten_share"].to_numpy().mean())
    assert condition["eaten"] == pytest.approx(np.exp(np.log(rows["eaten"].to_numpy()).mean()))


def test_the_papers_rate_feeds_the_expected_number(worlds: list[WorldRecord]) -> None:
    rows = make(dict.fromkeys((condition.label for condition in CONDITIONS), worlds))[0]["supply"].rows
    feeds = dict(zip(rows["condition"], rows["feeds"], strict=True))
    assert feeds["small, corrected"] == pytest.approx(0.2 / 0.0045)
    assert feeds["centered, growth"] == pytest.approx(1 / 0.0039)
    assert feeds["baseline, released"] == pytest.approx(1 / 0.001)


def test_the_figure_has_a_panel_per_condition_with_its_worlds_its_supplies_and_the_papers_rate(
    worlds: list[WorldRecord],
) -> None:
    tables, [named] = make({"small, released": worlds, "centered, corrected": worlds[:1]})
    by_world = tables["supply_worlds"].rows
    counts = {"small": 2, "baseline": 0, "centered": 1}
    assert [axes.get_title("left") for axes in named.figure.axes] == list(counts)
    for axes, (condition, count) in zip(named.figure.axes, counts.items(), strict=True):
        points = [np.asarray(line.get_xydata())[0] for line in axes.lines if line.get_marker() == "o"]
        mine = by_world.filter(pl.col("condition").str.starts_with(condition)).select("alive_mean", "eaten").rows()
        assert len(points) == count
        assert np.allclose(points, mine) if mine else not points
        lines = [np.asarray(line.get_xydata()) for line in axes.lines if line.get_linestyle() == "-"]
        supplies = sorted(float(np.unique(np.round(line.prod(axis=1), 9)).item()) for line in lines if len(line) == 2)
        assert supplies == [0.2, 1.0]
        [rate] = [line for line in axes.lines if line.get_linestyle() == "--"]
        assert set(np.asarray(rate.get_ydata())) == {PAPER[condition].food_per_step}


def test_worlds_in_which_no_agent_eats_leave_the_panels_empty() -> None:
    figure = draw_supply([], ["corrected"], {"small": 0.0045, "other": None}, [0.2])
    assert [len(axes.lines) for axes in figure.axes] == [2, 1]
