"""Did the ancestors of the survivors differ from their contemporaries?"""

from collections.abc import Mapping

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hedon.figure.style import INK, MUTED, draw_message, new_figure, number_log_axis, step_unit, styled
from hedon.figure.trace import draw_zero_line
from hedon.statistic.interval import mean_interval
from hedon.statistic.minimum import FOR_INTERVAL


def draw_lineages(lines: pl.DataFrame, titles: Mapping[str, str], colors: Mapping[str, str]) -> Figure:
    """Draws the number of lines that lead to the survivors, and the weights along them.

    Thick: mean weight over these lines. Thin and gray: mean weight over all agents alive at that time. Both are means
    over worlds; the band is the 95 % interval of the lines. Time is counted back from the end, since there are fewer
    lines the further back one looks.
    """
    if lines.is_empty():
        return draw_message("no agents recorded")
    with styled():
        figure = new_figure(2.2 * (len(titles) + 1) + 1.2, 2.9)
        panels = figure.subplots(1, len(titles) + 1, sharex=True)
        unit, name = step_unit(float(lines["step"].to_numpy().max()))
        first = lines.filter(pl.col("weight") == next(iter(titles)))
        for rows in first.partition_by("seed"):
            panels[0].step(
                rows["step"].to_numpy() / unit, rows["lines"], where="post", color=INK, linewidth=1.0, alpha=0.6
            )
        panels[0].set_yscale("log")
        number_log_axis(panels[0].yaxis)
        panels[0].set_title("lines to the survivors")
        for axes, (weight, title) in zip(panels[1:], titles.items(), strict=True):
            _draw_weight(axes, lines.filter(pl.col("weight") == weight), unit, colors[weight])
            axes.set_title(title, color=colors[weight])
            if axes is not panels[1]:
                axes.sharey(panels[1])
                axes.tick_params(labelleft=False)
        for axes in panels:
            axes.set_xlabel(f"time [{name}]")
        panels[1].set_ylabel("mean weight")
        handles = [
            Line2D([], [], color=INK, linewidth=2.0, label="mean over the lines"),
            Line2D([], [], color=MUTED, linewidth=1.0, label="mean over all alive"),
        ]
        figure.legend(handles=handles, loc="outside lower right", ncols=2)
    return figure


def _draw_weight(axes: Axes, rows: pl.DataFrame, unit: float, color: str) -> None:
    draw_zero_line(axes)
    for column, style in (
        ("living_mean", {"color": MUTED, "linewidth": 1.0}),
        ("line_mean", {"color": color, "linewidth": 2.0}),
    ):
        x, mean, low, high = _over_worlds(rows, column)
        axes.plot(x / unit, mean, **style)
        if column == "line_mean":
            axes.fill_between(x / unit, low, high, color=color, alpha=0.13, linewidth=0)


def _over_worlds(rows: pl.DataFrame, column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Step, mean and bounds over worlds, which are matched by the number of the point, since lengths may differ."""
    numbered = rows.with_columns(point=pl.int_range(pl.len()).over("seed")).drop_nulls(column)
    table = []
    for part in numbered.sort("point").partition_by("point"):
        interval = mean_interval(part[column])
        bounds = (interval.low, interval.high) if interval.worlds >= FOR_INTERVAL else (None, None)
        table.append([float(part["step"].to_numpy().mean()), interval.mean, *bounds])
    x, mean, low, high = np.array(table, np.float64).reshape(-1, 4).T
    return x, mean, low, high
