"""How did the reward weights change over time, and how much of it is drift?"""

from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
from matplotlib.figure import Figure

from hedon.analysis.population import history
from hedon.analysis.style import ACTION_COLOR, NEUTRAL_COLOR, new_figure, say_empty, styled
from hedon.analysis.trace import draw_time_axis, draw_traces, draw_zero_line

_MIN_HALF_RANGE = 0.5  # of the weight axis, so that noise of the founders does not look like evolution


def draw_history(
    population: pl.DataFrame,
    food_kinds: Sequence[str],
    neutral_names: Sequence[str],
    colors: Mapping[str, str],
) -> Figure:
    """One panel per reward weight and one for the first neutral marker, all with the same axes.

    Thin lines are means over the living of one world, thick lines are means over worlds with their 95 %
    interval.

    Args:
        population: table `population`.
        food_kinds: names.
        neutral_names: genome columns; the first is drawn.
        colors: per food kind.
    """
    shown = {f"w_{kind}": (f"weight of {kind} food", colors[kind]) for kind in food_kinds}
    shown["w_action"] = ("weight of action", ACTION_COLOR)
    shown |= dict.fromkeys(neutral_names[:1], ("neutral marker", NEUTRAL_COLOR))
    rows = history(population, food_kinds, list(shown))
    with styled():
        figure = new_figure(2.7 * len(shown) + 0.5, 2.9)
        panels = figure.subplots(1, len(shown), sharex=True, sharey=True, squeeze=False)[0]
        for axes, (name, (title, color)) in zip(panels, shown.items(), strict=True):
            draw_zero_line(axes)
            draw_traces(axes, rows, f"{name}_mean", color)
            axes.set_title(title, color=color)
            draw_time_axis(axes, rows)
        panels[0].set_ylabel("mean weight of the living")
        values = rows.select(f"{name}_mean" for name in shown).to_numpy().astype(np.float64)
        reach = np.nanmax(np.abs(values)) if np.isfinite(values).any() else 0.0
        if reach < _MIN_HALF_RANGE:
            panels[0].set_ylim(-_MIN_HALF_RANGE, _MIN_HALF_RANGE)
        if rows.is_empty():
            say_empty(panels[0], "nothing recorded yet")
    return figure
