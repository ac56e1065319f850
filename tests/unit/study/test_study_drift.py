import dataclasses
import math
from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
import pytest
from scipy import stats
from synthetic_run import write_run

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config.load import PAPER_PRESETS
from hedon.figure.named import NamedFigure
from hedon.record.reader import open_run
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.drift import ALL, CONDITIONS, DRIFT
from hedon_studies.kanagawa_doya_2024.paper import STEPS

ITEM = DRIFT
GENES = ["w_normal", "w_action", "neutral_1"]


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    path = tmp_path_factory.mktemp("drift") / "run"
    return read_worlds([open_run(write_run(path, worlds=3, intervals=40, snapshot=False))])


def make(found: Mapping[str, Sequence[WorldRecord]]) -> tuple[dict[str, ResultTable], list[NamedFigure]]:
    parts = list(ITEM.make(ItemInputs("corrected", found)))
    tables = {part.name: part for part in parts if isinstance(part, ResultTable)}
    return tables, [part for part in parts if isinstance(part, NamedFigure)]


def test_the_arms_are_the_papers_conditions() -> None:
    assert sorted(condition.preset for condition in CONDITIONS) == sorted(PAPER_PRESETS)
    assert all(condition.overrides == () for condition in CONDITIONS)
    assert (len(ITEM.scale.seeds), ITEM.scale.steps) == (5, STEPS)


def test_without_worlds_it_says_so() -> None:
    tables, drawn = make({})
    assert drawn == []
    assert "Not run yet: small; baseline; large; centered; relocation; poor; poison." in tables["drift_all"].note
    assert tables["drift_world"].rows.is_empty()


def test_worlds_of_all_conditions_are_pooled(worlds: list[WorldRecord]) -> None:
    tables, _ = make({"baseline": worlds, "large": worlds[:2]})
    by_world = tables["drift_world"].rows
    assert by_world.group_by("condition").len().sort("condition").rows() == [("baseline", 9), ("large", 6)]
    rows = tables["drift_all"].rows.filter(pl.col("test") == "direction")
    assert rows["weight"].to_list() == GENES
    for row in rows.rows(named=True):
        scores = by_world.filter(pl.col("weight") == row["weight"])["score"].to_numpy()
        assert (row["condition"], row["worlds"], row["positive"]) == (ALL, 5, np.count_nonzero(scores > 0))
        assert row["effect"] == pytest.approx(scores.mean())
        assert row["p"] == pytest.approx(2 * stats.norm.sf(abs(scores.sum()) / math.sqrt(5)))
        assert row["low"] < row["effect"] < row["high"]
        assert row["drift_high"] - row["effect"] == pytest.approx(1.959964 / math.sqrt(5))
    distance = tables["drift_all"].rows.filter(pl.col("test") == "distance")
    squares = [np.mean(by_world.filter(pl.col("weight") == gene)["score"].to_numpy() ** 2) for gene in GENES]
    assert distance["effect"].to_list() == pytest.approx(np.sqrt(squares))


def test_few_worlds_of_a_condition_get_no_bounds(worlds: list[WorldRecord]) -> None:
    five = [*worlds, *(dataclasses.replace(world, seed=world.seed + 3) for world in worlds[:2])]
    rows = make({"baseline": five, "large": worlds[:2]})[0]["drift_condition"].rows
    assert set(rows["test"]) == {"direction"}
    assert rows.filter(pl.col("condition") == "baseline")["low"].null_count() == 0
    assert rows.filter(pl.col("condition") == "large")["low"].null_count() == 3


def test_the_figure_has_a_point_per_world_and_the_mean_of_all(worlds: list[WorldRecord]) -> None:
    tables, [named] = make({"baseline": worlds, "large": worlds[:2]})
    means = tables["drift_all"].rows.filter(pl.col("test") == "direction")["effect"].to_list()
    assert len(named.figure.axes) == 3
    for axes, mean in zip(named.figure.axes, means, strict=True):
        marks = [line for line in axes.lines if line.get_marker() == "o"]
        assert len(marks) == 5
        [diamond] = [line for line in axes.lines if line.get_marker() == "D"]
        assert np.asarray(diamond.get_xydata())[0] == pytest.approx([mean, 2])
    assert [label.get_text() for label in named.figure.axes[0].get_yticklabels()] == ["baseline", "large", "all"]


def test_a_world_without_a_complete_pedigree_is_left_out(worlds: list[WorldRecord]) -> None:
    torn = dataclasses.replace(worlds[0], agents=worlds[0].agents.filter(pl.col("agent_id") != 60))
    rows = make({"baseline": [torn, *worlds[1:]]})[0]["drift_all"].rows
    assert set(rows["worlds"]) == {2}
