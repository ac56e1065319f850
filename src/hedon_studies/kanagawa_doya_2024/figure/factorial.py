"""Which factors and interactions change a world? The cells of a factorial design and its effects."""

from collections.abc import Sequence

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

from hedon.figure import BLUE, INK, MUTED, PALE, VERMILION, new_figure, say_empty, styled
from hedon.measure import Measure

_COLUMNS = 3
_WIDTH = 9.0
_ROW = 0.26  # height of a line of a panel [inch]
_SPREAD = 0.28  # of the worlds of a cell, to either side of its line
_REACH = 2.0  # intervals are cut off at this many widths of the range of estimates
_WIDE = 4.0  # an axis of ratios is logarithmic if the largest value is at least this many times the smallest


def draw_cells(worlds: pl.DataFrame, conditions: Sequence[str], measures: Sequence[Measure]) -> Figure:
    """Draws a panel per measure and a line per cell, with a point per world and a bar for their mean.

    Means of measures that are compared as ratios are geometric. Hollow points are worlds that died out.

    Args:
        worlds: A row per world.
        conditions: Labels of the cells.
        measures: The measures.
    """
    with styled():
        figure, panels = _panels(measures, conditions)
        for axes, measure in zip(panels, measures, strict=True):
            for line, condition in enumerate(conditions):
                rows = worlds.filter((pl.col("condition") == condition) & pl.col(measure.name).is_not_null()).sort(
                    "seed"
                )
                if rows.height:
                    _draw_cell(axes, line, rows, measure)
            recorded = worlds[measure.name].drop_nulls().to_numpy().astype(np.float64)
            if not len(recorded):
                say_empty(axes, "no world has a value")
            elif measure.ratio:
                _scale(axes, recorded.min(), recorded.max())
            elif recorded.min() <= 0 <= recorded.max():
                axes.axvline(0, color=PALE, linewidth=1.0, zorder=0.5)
        handles = [
            Line2D([], [], color=BLUE, marker="o", linestyle="", markersize=4, label="world"),
            Line2D([], [], color=INK, marker="|", linestyle="", markersize=9, markeredgewidth=2, label="mean"),
        ]
        if worlds["died_out"].any():
            extinct_style = {"marker": "o", "linestyle": "", "markersize": 4, "markerfacecolor": "white"}
            handles.append(Line2D([], [], color=VERMILION, label="world that died out", **extinct_style))
        figure.legend(handles=handles, loc="outside upper left", ncols=3, labelcolor=MUTED)
    return figure


def draw_effects(effects: pl.DataFrame, names: Sequence[str], measures: Sequence[Measure]) -> Figure:
    """Draws a panel per measure and a line per effect: the estimate, its 95 % interval, and estimates of single seeds.

    The vertical line marks no effect: 0, or a ratio of 1. Filled points are effects whose corrected
    p is at most 0.05. An interval that extends far beyond the estimates is cut off at an arrow.

    Args:
        effects: A row per effect and measure.
        names: Names of the effects.
        measures: The measures.
    """
    with styled():
        figure, panels = _panels(measures, names)
        for axes, measure in zip(panels, measures, strict=True):
            rows = effects.filter(pl.col("measure") == measure.name)
            if rows.is_empty():
                say_empty(axes, "no effect can be estimated")
                continue
            axes.axvline(1.0 if measure.ratio else 0.0, color=PALE, linewidth=1.4, zorder=0.5)
            low, high = _reach(rows, measure)
            if measure.ratio:
                _scale(axes, low, high)
            for row in rows.iter_rows(named=True):
                _draw_effect(axes, names.index(row["effect"]), row, low, high)
            axes.set_xlim(low, high)
            axes.set_xlabel("ratio" if measure.ratio else "difference")
        effect_style = {"color": BLUE, "marker": "o", "markersize": 4.5}
        handles = [
            Line2D([], [], **effect_style, linewidth=1.4, label="effect and 95 % interval, p (Holm) ≤ 0.05"),
            Line2D([], [], **effect_style, linewidth=1.4, markerfacecolor="white", label="p above 0.05, or none"),
            Line2D([], [], color=MUTED, linewidth=4.0, alpha=0.35, label="range over seeds"),
        ]
        figure.legend(handles=handles, loc="outside upper left", ncols=3, labelcolor=MUTED)
    return figure


def _panels(measures: Sequence[Measure], lines: Sequence[str]) -> tuple[Figure, list[Axes]]:
    """A grid with one panel per measure; the names of the lines are shared and written at the left."""
    rows = -(-len(measures) // _COLUMNS)
    figure = new_figure(_WIDTH, rows * (0.95 + _ROW * max(len(lines), 2)) + 0.3)
    panels = figure.subplots(rows, _COLUMNS, sharey=True, squeeze=False).ravel().tolist()
    for axes in panels[len(measures) :]:
        axes.remove()
    for axes, measure in zip(panels, measures, strict=False):
        axes.set_title(measure.title, fontsize=9)
        axes.set_ylim(len(lines) - 0.4, -0.6)
        axes.set_yticks(range(len(lines)), lines)
        axes.grid(visible=False, axis="y")
    return figure, panels[: len(measures)]


def _draw_cell(axes: Axes, line: int, rows: pl.DataFrame, measure: Measure) -> None:
    values = rows[measure.name].to_numpy().astype(np.float64)
    offset = np.linspace(-_SPREAD, _SPREAD, len(values)) if len(values) > 1 else np.zeros(1)
    is_extinct = rows["died_out"].to_numpy()
    axes.scatter(values[~is_extinct], line + offset[~is_extinct], s=17, color=BLUE, linewidths=0, alpha=0.8, zorder=3)
    axes.scatter(
        values[is_extinct], line + offset[is_extinct], s=17, facecolors="white", edgecolors=VERMILION, zorder=3
    )
    mean = np.exp(np.log(values).mean()) if measure.ratio else values.mean()
    axes.plot([mean, mean], [line - 0.38, line + 0.38], color=INK, linewidth=2.0, zorder=2)


def _draw_effect(axes: Axes, line: int, row: dict, low: float, high: float) -> None:
    if row["seed_low"] is not None:
        axes.plot([row["seed_low"], row["seed_high"]], [line, line], color=MUTED, linewidth=6.0, alpha=0.35, zorder=1)
    if row["low"] is not None:
        axes.plot([max(row["low"], low), min(row["high"], high)], [line, line], color=BLUE, linewidth=1.4, zorder=2)
        for bound, edge, marker in ((row["low"] < low, low, "<"), (row["high"] > high, high, ">")):
            if bound:
                axes.plot(edge, line, marker=marker, color=BLUE, markersize=5, clip_on=False, zorder=3)
    is_significant = row["p_holm"] is not None and row["p_holm"] <= 0.05
    face_color = BLUE if is_significant else "white"
    axes.scatter(row["estimate"], line, s=24, c=[face_color], edgecolors=BLUE, linewidths=1.2, zorder=4)


def _reach(rows: pl.DataFrame, measure: Measure) -> tuple[float, float]:
    """The limits of the axis, which include all estimates and seeds, and intervals that are not much wider."""
    neutral = 1.0 if measure.ratio else 0.0
    inner = _known(rows, ("estimate", "seed_low", "seed_high"), neutral)
    outer = _known(rows, ("low", "high"), neutral)
    if measure.ratio:
        inner, outer = np.log(inner), np.log(np.maximum(outer, 1e-300))
    width = max(float(np.ptp(inner)), 1e-3)
    low = max(outer.min(), inner.min() - _REACH * width)
    high = min(outer.max(), inner.max() + _REACH * width)
    low, high = min(low, inner.min()), max(high, inner.max())
    margin = 0.06 * (high - low)
    bounds = np.array([low - margin, high + margin])
    low, high = (np.exp(bounds) if measure.ratio else bounds).tolist()
    return low, high


def _known(rows: pl.DataFrame, names: Sequence[str], neutral: float) -> np.ndarray:
    values = rows.select(names).to_numpy().astype(np.float64).ravel()
    return np.append(values[np.isfinite(values)], neutral)


def _scale(axes: Axes, low: float, high: float) -> None:
    """Makes the axis logarithmic if the range of values is wide enough for a few round ticks."""
    if high < _WIDE * low:
        axes.xaxis.set_major_locator(MaxNLocator(5))
        return
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=6))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter("{x:g}")
