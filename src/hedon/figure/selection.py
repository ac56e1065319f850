"""When was which weight selected, and how strongly?"""

from collections.abc import Mapping

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hedon.analysis.agent.cohort import COMPLETE
from hedon.figure.style import draw_message, new_figure, say_empty, step_unit, styled
from hedon.figure.trace import draw_zero_line
from hedon.statistic.minimum import FOR_INTERVAL

_ROWS = {"children": "children", "lifespan": "length of life"}
_LEAST_RANGE = 0.1  # shortest gradient axis, so that noise does not look like selection


def draw_selection(
    windows: pl.DataFrame, worlds: pl.DataFrame, titles: Mapping[str, str], colors: Mapping[str, str]
) -> Figure:
    """Draws standardized gradients over time: a column per weight, a row per measure of fitness.

    Points with bars are means over worlds with their 95 % interval; if there are too few worlds for an interval, points
    are worlds. Hollow points are cohorts in which some agents are still alive.
    """
    if worlds.is_empty():
        return draw_message("nothing recorded yet")
    with styled():
        figure = new_figure(2.35 * len(titles) + 1.2, 4.4)
        panels = figure.subplots(len(_ROWS), len(titles), sharex=True, sharey=True, squeeze=False)
        measured = worlds.filter(pl.col("standard_gradient").is_not_null())
        unit, name = step_unit(float(worlds["to_step"].to_numpy().max(initial=0.0)))
        too_few = worlds["seed"].n_unique() < FOR_INTERVAL or windows.is_empty()
        for i, (fitness, label) in enumerate(_ROWS.items()):
            for axes, (weight, title) in zip(panels[i], titles.items(), strict=True):
                draw_zero_line(axes)
                in_panel = (pl.col("fitness") == fitness) & (pl.col("weight") == weight)
                if too_few:
                    _draw_worlds(axes, measured.filter(in_panel), unit, colors[weight])
                else:
                    _draw_means(axes, windows.filter(in_panel), measured.filter(in_panel), unit, colors[weight])
                if i == 0:
                    axes.set_title(title, color=colors[weight])
                else:
                    axes.set_xlabel(f"born until [{name}]")
            panels[i, 0].set_ylabel(f"gradient on\n{label}")
        low, high = panels[0, 0].get_ylim()
        panels[0, 0].set_ylim(min(low, -_LEAST_RANGE), max(high, _LEAST_RANGE))
        panels[0, 0].set_xlim(left=0)
        if measured.is_empty():
            say_empty(panels[0, 0], "too few agents")
    return figure


def _draw_means(axes: Axes, windows: pl.DataFrame, worlds: pl.DataFrame, unit: float, color: str) -> None:
    for rows in worlds.partition_by("seed"):
        axes.plot(rows["to_step"].to_numpy() / unit, rows["standard_gradient"], color=color, linewidth=0.7, alpha=0.3)
    rows = windows.drop_nulls(["mean", "low", "high"]).sort("to_step")
    x = rows["to_step"].to_numpy() / unit
    axes.vlines(x, rows["low"].to_numpy(), rows["high"].to_numpy(), color=color, linewidth=1.3, alpha=0.8)
    _points(axes, x, rows["mean"].to_numpy(), color, np.full(len(x), True))


def _draw_worlds(axes: Axes, worlds: pl.DataFrame, unit: float, color: str) -> None:
    for k, rows in enumerate(worlds.sort("seed", "window").partition_by("seed")):
        steps = rows["to_step"].to_numpy()
        shift = 0.15 * k * (steps[0] if len(steps) == 1 else np.diff(steps).min())
        is_complete = rows["complete"].to_numpy() >= COMPLETE
        _points(axes, (steps - shift) / unit, rows["standard_gradient"].to_numpy(), color, is_complete)


def _points(axes: Axes, x: np.ndarray, values: np.ndarray, color: str, is_complete: np.ndarray) -> None:
    """Points, hollow for cohorts with agents that are still alive."""
    face_colors = [color if complete else "white" for complete in is_complete]
    axes.scatter(x, values, s=18, c=face_colors, edgecolors=color, linewidths=1.0, zorder=3)
