"""Which worlds survive, and how do their weights change?"""

from collections.abc import Sequence

import polars as pl
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hedon.analysis import WorldRecord, history
from hedon.figure import (
    BLUE,
    ORANGE,
    VERMILION,
    draw_time_axis,
    draw_zero_line,
    last_step,
    new_figure,
    step_unit,
    styled,
)
from hedon_studies.kanagawa_doya_2024.analysis.fate import EXTINCT, HEADING, STANDING, Fate

_COLORS = {STANDING: BLUE, HEADING: ORANGE, EXTINCT: VERMILION}
_POINTS = 100


def draw_fates(worlds: Sequence[WorldRecord], fates: Sequence[Fate]) -> Figure:
    """Draws agents alive, weight of food, weight of action and neutral gene over time: a line per world, by fate.

    A cross marks the end of a world that is shorter than the longest.

    Args:
        worlds: The worlds.
        fates: Fate of each world, which sets its color.
    """
    populations = [world.population.with_columns(world=pl.lit(i, pl.Int32)) for i, world in enumerate(worlds)]
    names = ("w_normal", "w_action", "neutral_1")
    rows = history(pl.concat(populations), ("normal",), names, points=_POINTS)
    unit, _ = step_unit(last_step(rows))
    titles = {"alive": "agents alive", "w_normal_mean": "weight of food", "w_action_mean": "weight of action"}
    titles |= {"neutral_1_mean": "neutral gene"}
    with styled():
        figure = new_figure(9.0, 4.8)
        panels = figure.subplots(2, 2, sharex=True).ravel()
        for axes, (column, title) in zip(panels, titles.items(), strict=True):
            axes.set_title(title, fontsize=9)
            for i, fate in enumerate(fates):
                world_rows = rows.filter((pl.col("world") == i) & pl.col(column).is_not_null())
                x, y = world_rows["step"].to_numpy() / unit, world_rows[column].to_numpy()
                axes.plot(x, y, color=_COLORS[fate.fate], linewidth=1.1, alpha=0.75)
                if len(x) and x[-1] < 0.99 * last_step(rows) / unit:
                    axes.plot(x[-1], y[-1], marker="x", markersize=5, color=_COLORS[fate.fate])
            if column == "alive":
                axes.set_ylim(bottom=0)
            else:
                draw_zero_line(axes)
        for axes in panels[2:]:
            draw_time_axis(axes, rows)
        counts = {name: sum(fate.fate == name for fate in fates) for name in _COLORS}
        handles = [
            Line2D([], [], color=color, label=f"{name} ({counts[name]})")
            for name, color in _COLORS.items()
            if counts[name]
        ]
        figure.legend(handles=handles, loc="outside upper left", ncols=3)
    return figure
