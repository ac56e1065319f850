"""The figures of a sweep: how worlds respond to one factor, and to two factors together."""

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from hedon.compare.response import Point, binned, points
from hedon.figure.style import BLUE, INK, MUTED, head, new_figure, say_empty, styled
from hedon.statistic.interval import Interval
from hedon.statistic.minimum import FOR_INTERVAL

WIDE = 30.0
"""Ratio of the largest to the smallest value of a factor above which its axis is logarithmic."""
_COLUMNS = 3
_TICKS = 6
"""Largest number of tick labels below a panel."""
_FEW_DECADES = 1000.0
"""Ratio of the ends of a logarithmic axis below which it has labels between the powers of ten."""
_LEVEL, _ASLANT = 30, 8
"""Largest total length of names that are written horizontally below a panel, and largest number of slanted names."""
_CELL_DIGITS = 3


def draw_curves(table: pl.DataFrame, factor: str, shown: Mapping[str, str], *, ranged: bool) -> Figure:
    """Draws a panel per response along one factor: worlds as dots, means as a line, their 95 % intervals as bars.

    Args:
        table: Table of worlds.
        factor: Column of the factor.
        shown: Columns of the responses, with their titles.
        ranged: Whether the factor's values were drawn from a range.
    """
    with styled():
        rows = -(-len(shown) // _COLUMNS)
        figure = new_figure(9.0, 2.5 * rows)
        panels = figure.subplots(rows, _COLUMNS, squeeze=False).ravel().tolist()
        for axes in panels[len(shown) :]:
            axes.remove()
        for axes, (name, title) in zip(panels, shown.items(), strict=False):
            made = binned(table, factor, name) if ranged else points(table, [factor], name)
            _draw_curve(axes, table, factor, name, made)
            head(axes, title)
            axes.set_xlabel(factor)
    return figure


def draw_map(table: pl.DataFrame, pair: tuple[str, str], name: str, title: str) -> Figure:
    """Draws a response over two factors: in each cell the mean over worlds, and half the width of its 95 % interval.

    Args:
        table: Table of worlds.
        pair: Columns of the two factors.
        name: Column of the response.
        title: Title of the response.
    """
    right, up = (table[factor].unique().sort().to_list() for factor in pair)
    made = {point.at: point.mean for point in points(table, list(pair), name)}
    means = np.full((len(up), len(right)), np.nan)
    for (x, y), mean in made.items():
        if mean.mean is not None:
            means[up.index(y), right.index(x)] = mean.mean
    with styled():
        figure = new_figure(1.6 + 0.85 * max(len(right), 3), 1.4 + 0.55 * max(len(up), 3))
        axes = figure.add_subplot()
        axes.grid(visible=False)
        head(axes, title, _remark(made.values()))
        if not np.isfinite(means).any():
            say_empty(axes, "no world has a value")
            return figure
        image = axes.imshow(means, origin="lower", aspect="auto", cmap="viridis")
        middle = 0.5 * (float(np.nanmin(means)) + float(np.nanmax(means)))
        for (x, y), mean in made.items():
            if mean.mean is not None:
                color = INK if mean.mean > middle else "white"
                place = (right.index(x), up.index(y))
                axes.text(*place, _cell(mean), ha="center", va="center", color=color, fontsize=8)
        axes.set_xticks(range(len(right)), [_plain(value) for value in right])
        axes.set_yticks(range(len(up)), [_plain(value) for value in up])
        axes.set_xlabel(pair[0])
        axes.set_ylabel(pair[1])
        figure.colorbar(image, ax=axes)
    return figure


def _draw_curve(axes: Axes, table: pl.DataFrame, factor: str, name: str, made: Sequence[Point]) -> None:
    known = table.drop_nulls([factor, name])
    if known.is_empty():
        say_empty(axes, "no world has a value")
        return
    numbers = table.schema[factor].is_numeric()
    place = {} if numbers else {point.at[0]: i for i, point in enumerate(made)}

    def along(value: float | str) -> float:
        return float(value) if numbers else float(place[value])

    at = [along(value) for value in known[factor].to_list()]
    values = known[name].cast(pl.Float64).to_list()
    axes.plot(at, values, linestyle="", marker="o", markersize=3, color=MUTED, alpha=0.5, zorder=1)
    line = [(along(point.at[0]), point.mean) for point in made if point.mean.mean is not None]
    means = [mean.mean for _, mean in line if mean.mean is not None]
    axes.plot([x for x, _ in line], means, color=BLUE, marker="o", markersize=4, zorder=3)
    for x, mean in line:
        if mean.low is not None and mean.high is not None and mean.worlds >= FOR_INTERVAL:
            axes.plot([x, x], [mean.low, mean.high], color=BLUE, linewidth=1.4, zorder=2)
    if not numbers:
        _name_values(axes, [str(value) for value in place])
    elif min(at) > 0 and max(at) > WIDE * min(at):
        axes.set_xscale("log")
        within = (1.0, 3.0) if max(at) < _FEW_DECADES * min(at) else (1.0,)
        axes.xaxis.set_major_locator(LogLocator(subs=within, numticks=_TICKS))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    else:
        axes.xaxis.set_major_locator(MaxNLocator(_TICKS - 1))
        axes.xaxis.set_major_formatter("{x:g}")


def _name_values(axes: Axes, names: Sequence[str]) -> None:
    """Writes non-numeric values below an axis; the more there are, the more they are slanted."""
    level = sum(map(len, names)) <= _LEVEL
    slope = 0 if level else 30 if len(names) <= _ASLANT else 90
    end = (
        {}
        if level
        else {"ha": "right" if slope == 30 else "center", "rotation_mode": "anchor" if slope == 30 else None}
    )
    axes.set_xticks(range(len(names)), names, rotation=slope, **end)


def _remark(means: Iterable[Interval]) -> str:
    worlds = {mean.worlds for mean in means}
    least, most = min(worlds, default=0), max(worlds, default=0)
    if most <= 1:
        return "One world in each cell: it tells nothing of chance."
    if most < FOR_INTERVAL:
        return f"Mean over {most} worlds in each cell; intervals are shown from {FOR_INTERVAL} worlds on."
    count = f"{least}" if least == most else f"{least} to {most}"
    return f"Mean over {count} worlds in each cell ± half of its 95 % interval."


def _cell(mean: Interval) -> str:
    value, low, high = mean.mean, mean.low, mean.high
    text = _plain(value)
    if mean.worlds < FOR_INTERVAL or low is None or high is None or not math.isfinite(high - low):
        return text
    return f"{text}\n±{_plain(0.5 * (high - low))}"


def _plain(value: object) -> str:
    return f"{value:.{_CELL_DIGITS}g}" if isinstance(value, float) else str(value)
