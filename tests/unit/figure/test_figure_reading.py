"""Figures are readable: no text over the data, numbers in plain notation, data that fill their panels."""

from itertools import pairwise

import numpy as np
import polars as pl
import pytest
from matplotlib.figure import Figure
from synthetic_run import write_run

from hedon.compare.figure import draw_curves
from hedon.config import load_config
from hedon.figure.demography import draw_demography
from hedon.figure.law import draw_birth
from hedon.figure.lineage import draw_lineages
from hedon.figure.population import draw_population
from hedon.figure.survival import draw_survival
from hedon.record.reader import open_run
from hedon.report.analysis import Analysis, analyze

BASELINE = load_config("baseline")


@pytest.fixture(scope="module")
def analysis(tmp_path_factory: pytest.TempPathFactory) -> Analysis:
    """Three worlds, so short that most of the agents born in them are still alive."""
    folder = tmp_path_factory.mktemp("reading") / "run"
    run = open_run(write_run(folder, intervals=6, worlds=3, snapshot=False))
    return analyze([run], ["lifetime", "genealogy"])


def test_the_survival_legend_is_clear_of_the_curves(analysis: Analysis) -> None:
    figure = survival(analysis)
    assert overprinted(figure) == []
    assert [text.get_text() for text in figure.legends[0].get_texts()][1:] == ["seed 1", "seed 2", "seed 3"]


def test_the_curves_fill_the_logarithmic_panel(analysis: Analysis) -> None:
    logarithmic = survival(analysis).axes[1]
    least, most = np.log(logarithmic.get_ylim())
    lowest = np.log(analysis.tables["survival"].rows["low"].drop_nulls().to_numpy().min())
    assert most - lowest > 0.9 * (most - least)
    assert lowest > least


def test_the_population_legends_are_clear_of_the_bands(analysis: Analysis) -> None:
    rows = analysis.runs[0].population()
    wide = 30 * pl.col("world")  # a band that fills its panel
    figure = draw_population(rows.with_columns(births=wide, births_failed_space=wide), ("normal",), {"normal": "green"})
    assert overprinted(figure) == []
    assert sum(axes.get_legend() is not None for axes in figure.axes) == 2


def test_survival_without_deaths_is_drawn_without_axes() -> None:
    assert not any(axes.axison for axes in draw_survival(pl.DataFrame(), pl.DataFrame()).axes)


@pytest.mark.parametrize("energy", [0.0, 1.5, 40.0, 300.0])
def test_demography_is_readable_whatever_the_energy_of_the_living(energy: float) -> None:
    names = ("energy_q25", "energy_median", "energy_q75")
    rows = pl.DataFrame({"step": [1024]} | {name: [f * energy] for name, f in zip(names, (0.6, 1, 1.3), strict=True)})
    figure = draw_demography(BASELINE.species["agent"], [rows])
    assert overprinted(figure) == []
    assert "half of the living" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_the_birth_figure_explains_its_line() -> None:
    figure = draw_birth(BASELINE.species["agent"])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["R0 = 1: a lineage keeps its size"]


@pytest.mark.parametrize("counts", [(50, 56), (20, 140), (3, 700), (1, 20_000)])
def test_numbers_of_lines_are_written_in_full(counts: tuple[int, int]) -> None:
    rows = {"seed": [1, 1], "step": [0, 1024], "weight": ["w_normal"] * 2, "lines": counts, "alive": counts}
    lines = pl.DataFrame(rows | {"line_mean": [0.0, 0.1], "living_mean": [0.0, 0.2]})
    shown = numbers(draw_lineages(lines, {"w_normal": "weight"}, {"w_normal": "green"}))
    assert len(shown) >= 2
    assert all(text.replace(",", "").replace(".", "").isdigit() for text in shown)


@pytest.mark.parametrize(
    "values",
    [
        [0.0005, 0.001, 0.0015, 0.002],
        [0.001, 0.002, 0.005, 0.1],
        [1e-6, 1e-3, 1.0],
        [0.02, 0.05, 0.1, 0.7],
        [100_000.0, 200_000.0, 5_000_000.0],
        ["uniform", "gaussian", "switching", "mixture", "rectangle"],
        ["on", "off"],
        [f"value {i}" for i in range(14)],
    ],
)
def test_the_tick_labels_of_a_sweeps_curves_are_readable(values: list) -> None:
    table = pl.DataFrame({"factor": values * 2, "alive": np.linspace(10, 90, 2 * len(values))})
    shown = {"alive": "agents alive", "again": "the same", "third": "again"}
    table = table.with_columns(again=pl.col("alive"), third=pl.col("alive"))
    figure = draw_curves(table, "factor", shown, ranged=False)
    figure.draw_without_rendering()
    axes = figure.axes[0]
    low, high = axes.get_xlim()
    ticks = [*axes.xaxis.get_major_ticks(), *axes.xaxis.get_minor_ticks()]
    written = [t.label1 for t in ticks if low <= t.get_loc() <= high and t.label1.get_text()]
    assert len(written) >= 2
    assert not any("$" in label.get_text() for label in written)
    upright = [label for label in written if label.get_rotation() != 30]
    spans = sorted((box.x0, box.x1) for box in (label.get_window_extent() for label in upright))
    assert all(left[1] < right[0] for left, right in pairwise(spans))
    if len(upright) < len(written):  # slanted labels are at least a line height apart
        ends = sorted(label.get_window_extent().x1 for label in written)
        assert min(np.diff(ends)) > 1.2 * float(written[0].get_fontsize()) * figure.dpi / 72


def survival(analysis: Analysis) -> Figure:
    return draw_survival(analysis.tables["survival"].rows, analysis.tables["lifetime_world"].rows)


def numbers(figure: Figure) -> list[str]:
    """The tick labels of the first y axis, within its limits."""
    figure.draw_without_rendering()
    axes = figure.axes[0]
    low, high = axes.get_ylim()
    ticks = [*axes.yaxis.get_major_ticks(), *axes.yaxis.get_minor_ticks()]
    return [t.label1.get_text() for t in ticks if low <= t.get_loc() <= high and t.label1.get_text()]


def overprinted(figure: Figure) -> list[str]:
    """The texts and legends within axes that a line or a band crosses."""
    figure.draw_without_rendering()
    found = []
    for axes in figure.axes:
        legend = axes.get_legend()
        boxes = [(text.get_text(), text.get_window_extent()) for text in axes.texts if text.get_text()]
        boxes += [("legend", legend.get_window_extent())] if legend is not None else []
        paths = [(line.get_transform().transform_path(line.get_path()), False) for line in axes.lines]
        for band in axes.collections:
            paths += [(band.get_transform().transform_path(path), True) for path in band.get_paths()]
        found += [name for name, box in boxes if any(path.intersects_bbox(box, filled) for path, filled in paths)]
    return found
