"""How do the worlds of several conditions change over time, side by side?"""

from collections.abc import Mapping

import polars as pl
from matplotlib.figure import Figure

from hedon.figure.style import SEED_COLORS, new_figure, styled
from hedon.figure.trace import draw_time_axis, draw_traces, last_step


def draw_courses(histories: Mapping[str, pl.DataFrame], panels: Mapping[str, str]) -> Figure:
    """Draws a panel per quantity and a color per condition.

    Thick lines are means over worlds, with their interval; thin lines are worlds.

    Args:
        histories: History of each condition, from `population.history`, with intervals of equal length; at least one.
        panels: Columns of the histories to draw, with the title of each.
    """
    end = max(last_step(rows) for rows in histories.values())
    with styled():
        figure = new_figure(3.2 * len(panels), 3.2)
        axes = figure.subplots(1, len(panels), squeeze=False)[0]
        for panel, (column, title) in zip(axes, panels.items(), strict=True):
            panel.set_title(title, fontsize=9)
            for color, (label, rows) in zip(SEED_COLORS, histories.items(), strict=False):
                draw_traces(panel, rows, column, color, label, end=end)
            draw_time_axis(panel, next(iter(histories.values())), end)
            panel.set_ylim(bottom=0)
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
    return figure
