"""Measures: one entry in the catalog appears wherever numbers of worlds are shown."""

import io
import math
from pathlib import Path

import polars as pl
import pytest
from rich.console import Console
from synthetic_run import write_run

from hedon.analysis import WorldRecord, read_worlds
from hedon.cli.display.summary import summary_table
from hedon.compare.contrast import compare
from hedon.compare.figure import draw_curves
from hedon.compare.response import points, responses
from hedon.ensemble.row import world_rows
from hedon.measure.catalogue import MEASURES, column_measure, gene_mean
from hedon.measure.measure import Measure
from hedon.measure.response import at_common_age, measured
from hedon.record.reader import open_run
from hedon.report.run import run_summary
from hedon.statistic.interval import AMOUNT
from hedon.study.claim import Claim
from hedon.study.item import Condition
from hedon.study.verdict import judge


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_run(tmp_path_factory.mktemp("measure") / "run", intervals=10, worlds=3)


def test_one_entry_appears_in_summary_table_comparison_and_claims(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def crowd(world: WorldRecord) -> int:
        return int(world.population["alive"].to_numpy().max())

    entry = Measure("crowd", "largest number alive", crowd, AMOUNT, usual=True, averaged=True)
    assert isinstance(MEASURES, dict)
    monkeypatch.setitem(MEASURES, entry.name, entry)

    run = open_run(folder)
    expected = [crowd(world) for world in read_worlds([run])]
    summary = run_summary(run)
    assert [world["crowd"] for world in summary["worlds"]] == expected
    assert summary["crowd"]["mean"] == pytest.approx(sum(expected) / 3)

    printed = io.StringIO()
    Console(file=printed, width=120).print(summary_table(summary))
    assert "largest number alive" in printed.getvalue()

    table = pl.DataFrame(world_rows(summary, ["0"] * 3))
    compared = responses(table, (), ())  # what comparisons, power, figures and reports of many worlds show
    assert compared["crowd"] == "largest number alive"
    assert responses(table.rename({"crowd": "prey.crowd"}), (), ())["prey.crowd"] == "largest number alive: prey"
    assert points(table, (), "crowd")[0].mean.mean == pytest.approx(sum(expected) / 3)

    factor = table.with_columns(cost=pl.Series([1.0, 2.0, 3.0]))
    drawn = draw_curves(factor, "cost", {"crowd": compared["crowd"]}, ranged=False)
    assert drawn.axes[0].get_title(loc="left") == "largest number alive"
    (found,) = compare(factor[:1], factor[1:], {"crowd": compared["crowd"]}, paired=False)
    assert found.title == "largest number alive"

    claim = Claim("crowded", Condition("baseline"), "many live at once", MEASURES["crowd"].of, "mean", "> 0", low=0.0)
    assert judge(claim, "baseline", read_worlds([run])).value == pytest.approx(sum(expected) / 3)

    asked = at_common_age((MEASURES["crowd"],), 0.0)  # as in studies and their claims
    assert [measured(world, asked)["crowd"] for world in read_worlds([run])] == expected


def test_a_ratio_of_zero_and_a_number_that_is_not_finite_are_none(folder: Path) -> None:
    [world, *_] = read_worlds([open_run(folder)])
    assert Measure("m", "t", lambda _: 0.0, ratio=True).value(world) is None
    assert Measure("m", "t", lambda _: math.nan).value(world) is None
    assert Measure("m", "t", lambda _: 0.0).value(world) == 0.0


def test_columns_name_the_measure_and_its_species(folder: Path) -> None:
    [world, *_] = read_worlds([open_run(folder)])
    assert column_measure("alive_mean") is MEASURES["alive_mean"]
    prey = column_measure("prey.alive_mean")
    assert prey is not None
    assert (prey.name, prey.title) == ("prey.alive_mean", "agents alive, last tenth: prey")
    weight = column_measure("w_normal_mean")
    assert weight is not None
    assert weight.usual
    assert weight.value(world) == gene_mean("w_normal").value(world) is not None
    assert column_measure("cost") is None
    assert column_measure("food.normal.gene.initial_mean") is None  # a setting


def test_every_entry_has_a_name_a_title_and_a_meaning() -> None:
    assert all(entry.name == key and entry.title and entry.documentation for key, entry in MEASURES.items())
