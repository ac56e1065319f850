"""How did the reward weights change over time, and how much of it is drift?"""

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hedon.analysis.gene.band import DriftBand
from hedon.analysis.world.population import history
from hedon.config.color import NEUTRAL_COLOR, weight_colors
from hedon.config.title import weight_title
from hedon.figure.style import (
    MUTED,
    new_figure,
    say_empty,
    step_unit,
    styled,
)
from hedon.figure.trace import draw_time_axis, draw_traces, draw_zero_line, last_step

_MIN_HALF_RANGE = 0.5  # of the weight axis, so that variation among founders does not look like evolution
_WIDEST = 10.0  # figure [inch]
_ROOMY = 4  # columns whose titles fit in full size
_POINTS = 200  # intervals of the time axis


@dataclass(frozen=True)
class HistoryRow:
    """The worlds of one condition, drawn as a row of panels.

    Attributes:
        population: Rows of the table `population`.
        title: Name of the condition.
        remark: Further information shown under the title.
        extinct: Worlds that died out; None to assume this of worlds that end before others.
        drift: Drift band of each genome column, as `drift_bands` returns it; a gene without a band is marked as having
            no control.
    """

    population: pl.DataFrame
    title: str = ""
    remark: str = ""
    extinct: Container[int] | None = None
    drift: Mapping[str, DriftBand] = field(default_factory=dict)


def draw_histories(
    settings: Sequence[HistoryRow],
    reward_names: Sequence[str],
    neutral_names: Sequence[str],
    colors: Mapping[str, str],
) -> Figure:
    """Draws one row per condition, with a column per reward weight and one for the neutral genes; all share their axes.

    Thin lines are means over the living of one world; thick lines are means over worlds, with their 95 %
    interval. A cross ends the line of a world that died out. The shaded band is the range in which drift alone would
    leave the weight in 95 % of worlds. In the last column, each neutral gene of each world is a line; the axes may cut
    some lines off.

    Args:
        settings: The conditions from top to bottom, at least one.
        reward_names: Genome columns that have an effect, of all conditions.
        neutral_names: The other genome columns.
        colors: Color of each food kind.
    """
    tints = weight_colors(reward_names, colors)
    weight_styles = {name: (weight_title(name), tints[name]) for name in reward_names}
    columns = len(weight_styles) + bool(neutral_names)
    end = max(last_step(setting.population) for setting in settings)
    with styled():
        width = min(2.7 * columns + 0.5, _WIDEST)
        height = 2.3 * len(settings) + 0.3 if len(settings) > 1 else 2.9 + 0.3 * bool(settings[0].title)
        figure = new_figure(width, height)
        grid = figure.subplots(len(settings), columns, sharex=True, sharey=True, squeeze=False)
        reach, size = 0.0, 10.0 if columns <= _ROOMY else 8.0
        for setting, panels in zip(settings, grid, strict=True):
            rows = history(setting.population, (), [*weight_styles, *neutral_names], _POINTS, end)
            for axes, (name, (title, color)) in zip(panels, weight_styles.items(), strict=False):
                draw_zero_line(axes)
                reach = max(reach, _draw_band(axes, setting.drift.get(name), rows, end))
                draw_traces(axes, rows, f"{name}_mean", color, extinct=setting.extinct, end=end)
                if setting is settings[0]:
                    axes.set_title(title, color=color, fontsize=size)
            if neutral_names:
                draw_zero_line(panels[-1])
                _draw_band(panels[-1], setting.drift.get(neutral_names[0]), rows, end)
                _draw_neutral(panels[-1], rows, neutral_names, end)
                if setting is settings[0]:
                    panels[-1].set_title("neutral genes", color=NEUTRAL_COLOR, fontsize=size)
            if setting is settings[-1]:
                for axes in panels:
                    draw_time_axis(axes, rows, end)
            _say_setting(panels[0], setting)
            panels[0].set_ylabel("mean weight of the living" if len(settings) == 1 else "mean weight")
            if rows.is_empty():
                say_empty(panels[0], "nothing recorded yet")
            values = rows.select(f"{name}_mean" for name in weight_styles).to_numpy().astype(np.float64)
            reach = max(reach, np.nanmax(np.abs(values)) if np.isfinite(values).any() else 0.0)
        reach = max(1.05 * reach, _MIN_HALF_RANGE)
        grid[0, 0].set_ylim(-reach, reach)
    return figure


def _draw_band(axes: Axes, band: DriftBand | None, rows: pl.DataFrame, end: float) -> float:
    """Shades the drift band of a gene, or writes that it is unknown; returns its largest distance from 0."""
    if rows.is_empty():
        return 0.0
    if band is None:
        axes.annotate("no band of drift", (0.98, 0.03), xycoords="axes fraction", ha="right", color=MUTED, fontsize=8.0)
        return 0.0
    unit, _ = step_unit(max(last_step(rows), end))
    axes.fill_between(band.step / unit, band.low, band.high, color=NEUTRAL_COLOR, alpha=0.15, linewidth=0)
    return float(np.abs([band.low, band.high]).max())


def _draw_neutral(axes: Axes, rows: pl.DataFrame, neutral_names: Sequence[str], end: float) -> None:
    unit, _ = step_unit(max(last_step(rows), end))
    for world in rows.partition_by("world"):
        for name in neutral_names:
            axes.plot(world["step"] / unit, world[f"{name}_mean"], color=NEUTRAL_COLOR, linewidth=0.8, alpha=0.35)


def _say_setting(axes: Axes, setting: HistoryRow) -> None:
    """Writes the title and remark of a row above it, higher than the titles of its panels."""
    if not setting.title:
        return
    offset = 24 if axes.get_title("left") else 6
    placement = {"xy": (0, 1), "xycoords": "axes fraction", "textcoords": "offset points", "va": "bottom"}
    name = axes.annotate(setting.title, xytext=(0, offset), fontsize=10.0, fontweight="bold", **placement)
    remark = axes.annotate(
        setting.remark,
        xy=(1, 0),
        xycoords=name,
        xytext=(8, 0),
        textcoords="offset points",
        va="bottom",
        color=MUTED,
        fontsize=8.0,
    )
    remark.set_in_layout(False)  # may be wider than the panel
