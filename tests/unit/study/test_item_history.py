import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from synthetic_run import write_run

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.figure.named import NamedFigure
from hedon.figure.style import save_figure
from hedon.record.reader import open_run
from hedon.study.item import ItemInputs
from hedon_studies.kanagawa_doya_2024.paper import STEPS
from hedon_studies.kanagawa_doya_2024.weight_history import HISTORIES

ITEMS = {item.name: item for item in HISTORIES}


@pytest.fixture(scope="module")
def five(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("history") / "run"
    return read_worlds([open_run(write_run(folder, worlds=5, intervals=20, extinct=2, snapshot=False))])


def draw(name: str, **worlds: Sequence[WorldRecord]) -> tuple[str, Figure]:
    (made,) = ITEMS[name].make(ItemInputs("corrected", worlds))
    assert isinstance(made, NamedFigure)
    assert made.name == name
    return made.caption, made.figure


def crosses(axes: Axes) -> list[Line2D]:
    return [line for line in axes.lines if line.get_marker() == "x"]


def thick(axes: Axes) -> Line2D:
    (line,) = (line for line in axes.lines if line.get_linewidth() == 2.0)
    return line


def remarks(figure: Figure) -> list[str]:
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def test_the_items_are_those_of_the_paper_at_its_scale() -> None:
    assert list(ITEMS) == ["history-baseline", "history-sizes", "history-poor", "history-poison"]
    assert {item.scale.seeds for item in HISTORIES} == {(1, 2, 3, 4, 5)}
    assert {item.scale.steps for item in HISTORIES} == {STEPS}


def test_each_row_is_the_mean_of_its_own_worlds(five: list[WorldRecord]) -> None:
    groups = {"small": five[:2], "baseline": five, "large": five[3:]}
    _, figure = draw("history-sizes", **groups)
    grid = np.array(figure.axes).reshape(3, 3)
    for row, worlds in zip(grid, groups.values(), strict=True):
        population = pl.concat(world.population for world in worlds)
        for axes, weight in zip(row, ("w_normal", "w_action"), strict=False):
            expected = population.group_by("step").agg(pl.col(f"{weight}_mean").mean()).sort("step")
            assert thick(axes).get_ydata() == pytest.approx(expected[f"{weight}_mean"].to_numpy())
            assert thick(axes).get_xdata() == pytest.approx(expected["step"].to_numpy() / 1000)
            thin = [line for line in axes.lines if line.get_linewidth() == 0.8]
            assert len(thin) == len(worlds)
    assert [axes.get_title("left") for axes in grid[0]] == [
        "weight of normal food",
        "weight of action",
        "neutral genes",
    ]
    said = ["small", "2 worlds, 20,480 steps, none died out", "baseline", "5 worlds, 20,480 steps, seed 3 died out"]
    assert remarks(figure)[:4] == said


def test_all_panels_have_the_same_axes_and_unit_of_time(five: list[WorldRecord]) -> None:
    _, figure = draw("history-sizes", small=[world.until(1024) for world in five[:2]], baseline=five, large=five)
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes}) == 1
    assert np.asarray(thick(figure.axes[0]).get_xdata()).tolist() == [1.024]
    assert "2 worlds, 1,024 steps, none died out" in remarks(figure)


def test_a_cross_ends_the_line_of_a_world_that_died_out_and_no_other(five: list[WorldRecord]) -> None:
    shorter = [five[0].until(10_240), five[1], five[2]]
    _, figure = draw("history-baseline", baseline=shorter)
    for axes in figure.axes[:2]:
        (cross,) = crosses(axes)
        step = five[2].population.filter(pl.col("w_normal_mean").is_not_null())["step"].to_numpy().max()
        assert np.asarray(cross.get_xdata()).tolist() == [step / 1000]
    alone = draw("history-baseline", baseline=five[2:3])[1]
    assert [len(crosses(axes)) for axes in alone.axes] == [1, 1, 0]
    assert remarks(alone) == ["baseline", f"1 world, died out at step {five[2].extinct_step:,}"]
    both = [five[2], dataclasses.replace(five[2], seed=9)]
    assert f"2 worlds, all died out by step {five[2].extinct_step:,}" in remarks(
        draw("history-baseline", baseline=both)[1]
    )


def test_arms_without_worlds_are_named(five: list[WorldRecord]) -> None:
    caption, figure = draw("history-sizes", large=five[:1])
    assert len(figure.axes) == 3
    assert caption.endswith("Not run yet: small; baseline.")
    caption, figure = draw("history-poison")
    assert remarks(figure) == ["no worlds yet"]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("worlds", [1, 2, 5])
def test_any_number_of_worlds_is_drawn(tmp_path: Path, worlds: int) -> None:
    run = write_run(tmp_path / "run", worlds=worlds, intervals=5, food_kinds=("normal", "poor"), snapshot=False)
    _, figure = draw("history-poor", poor=read_worlds([open_run(run)]))
    assert len(figure.axes) == 4
    assert figure.get_size_inches()[0] <= 10
    assert save_figure(figure, tmp_path / "history.svg").stat().st_size > 20_000
