"""Lines over time: a thin line per world, a thick line for their mean, and a band for its interval."""

from collections.abc import Container

import numpy as np
import polars as pl
from matplotlib.axes import Axes

from hedon.figure.style import PALE, step_unit
from hedon.statistic.interval import mean_interval
from hedon.statistic.minimum import FOR_INTERVAL


def draw_traces(
    axes: Axes,
    history: pl.DataFrame,
    column: str,
    color: str,
    label: str | None = None,
    *,
    thin: bool = True,
    extinct: Container[int] | None = None,
    end: float = 0.0,
) -> None:
    """Draws one column of a history.

    The thick line is the mean over the worlds that have a value at that time, so it leaves out extinct worlds;
    the band is the 95 % interval of the mean, if there are at least five worlds. A cross marks where a
    world died out.

    Args:
        axes: Axes to draw on; its x axis is in the unit of `draw_time_axis`.
        history: A history from `population.history`.
        column: Column of the history to draw.
        color: Color of all lines.
        label: Label of the thick line in a legend.
        thin: Whether to draw the lines of worlds and their crosses.
        extinct: Worlds that died out; None to assume this of worlds that end before others.
        end: End of the time axis, if later than that of the history [step].
    """
    unit, _ = step_unit(max(last_step(history), end))
    worlds = history.partition_by("world")
    extinct_worlds = _ended_early(history) if extinct is None else extinct
    for world in worlds if thin else []:
        rows = world.filter(pl.col(column).is_not_null())
        x, y = rows["step"].to_numpy() / unit, rows[column].to_numpy()
        if len(worlds) > 1:
            axes.plot(x, y, color=color, linewidth=0.8, alpha=0.35)
        if len(x) and world["world"][0] in extinct_worlds:
            axes.plot(x[-1], y[-1], marker="x", markersize=5, color=color, alpha=0.8)
    x, mean, low, high = over_worlds(history, column)
    if len(worlds) >= FOR_INTERVAL:
        axes.fill_between(x / unit, low, high, color=color, alpha=0.13, linewidth=0)
    marker = "o" if len(x) == 1 else ""
    axes.plot(
        x / unit,
        mean,
        color=color,
        linewidth=2.0,
        marker=marker,
        markersize=4,
        label=label,
        clip_on=len(x) > 1,
    )


def over_worlds(history: pl.DataFrame, column: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The mean over worlds at each time.

    Returns:
        Step, mean, and lower and upper bound of its 95 % interval (NaN for fewer than five worlds), each of shape
        (bins,).
    """
    rows = []
    recorded = history.filter(pl.col(column).is_not_null())
    for bin_rows in recorded.partition_by("bin"):
        interval = mean_interval(bin_rows[column])
        low, high = (interval.low, interval.high) if interval.worlds >= FOR_INTERVAL else (None, None)
        rows.append([bin_rows["step"].to_numpy().max(), interval.mean, low, high])
    table = np.array(sorted(rows), np.float64).reshape(-1, 4)
    return table[:, 0], table[:, 1], table[:, 2], table[:, 3]


def draw_time_axis(axes: Axes, history: pl.DataFrame, end: float = 0.0) -> None:
    """Labels the x axis in a unit that suits the length of the run, from 0 to the end of the run or later.

    Args:
        axes: Axes to label.
        history: A row per world and bin of time, with the column step.
        end: Earliest end of the axis [step].
    """
    last = max(last_step(history), end)
    unit, name = step_unit(last)
    axes.set_xlabel(f"time [{name}]")
    axes.set_xlim(0, max(last / unit * 1.01, 1e-9))


def draw_zero_line(axes: Axes) -> None:
    """Draws a line at 0, behind the data."""
    axes.axhline(0, color=PALE, linewidth=1.0, zorder=0.5)


def last_step(history: pl.DataFrame) -> float:
    """The last step of a history [step]; 0 if it is empty."""
    return float(history["step"].to_numpy().max()) if history.height else 0.0


def _ended_early(history: pl.DataFrame) -> set[int]:
    """The worlds whose records end before those of others."""
    last_bins = history.group_by("world").agg(pl.col("bin").max())
    return set(last_bins.filter(pl.col("bin") < pl.col("bin").max())["world"])
