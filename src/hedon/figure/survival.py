"""How long do agents live, counting those still alive?"""

import numpy as np
import polars as pl
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hedon.figure.style import INK, draw_message, new_figure, number_log_axis, seed_color, step_unit, styled

_LEGEND_SEEDS = 10
_SHOWN_SHARE = 0.01  # share of the newborn still alive at which the axes end
_MARGIN = 0.04  # of the logarithmic axis, beyond the curves


def draw_survival(points: pl.DataFrame, lifetimes: pl.DataFrame) -> Figure:
    """Draws survival curves with their intervals, a color per world, and the same curves on a logarithmic scale.

    On the logarithmic scale, a constant chance of death is a straight line; if it rises with age, the line bends
    downward. Dashed: the curve of an agent that has the world's average chance of death at every age.
    """
    if points.is_empty():
        return draw_message("nobody died")
    with styled():
        figure = new_figure(8.6, 3.5)
        linear, logarithmic = figure.subplots(1, 2, sharex=True)
        visible = points.filter(pl.col("share") >= _SHOWN_SHARE)
        end = float(visible["age"].to_numpy().max())
        unit, name = step_unit(end)
        seeds = points["seed"].unique(maintain_order=True).to_list()
        for i, seed in enumerate(seeds):
            rows = points.filter(pl.col("seed") == seed)
            age, color = rows["age"].to_numpy() / unit, seed_color(i)
            low, high = (rows[bound].fill_null(strategy="forward").to_numpy() for bound in ("low", "high"))
            for axes in (linear, logarithmic):
                axes.step(age, rows["share"].to_numpy(), where="post", color=color, linewidth=1.4)
                axes.fill_between(age, low, high, step="post", color=color, alpha=0.13, linewidth=0)
        means = lifetimes["exposure_mean"].drop_nulls().to_numpy()
        if len(means):
            age = np.linspace(0, end, 100)
            for axes in (linear, logarithmic):
                axes.plot(age / unit, np.exp(-age / means.mean()), color=INK, linewidth=1.0, linestyle=(0, (4, 3)))
        logarithmic.set_yscale("log")
        lowest = max(_SHOWN_SHARE, float(visible.select(pl.min_horizontal("share", "low").min()).item()))
        logarithmic.set_ylim(lowest ** (1 + _MARGIN), lowest**-_MARGIN)
        number_log_axis(logarithmic.yaxis)
        linear.set(xlim=(0, end / unit), ylim=(0, 1.02), ylabel="share that lives on")
        linear.set_title("survival")
        logarithmic.set_title("the same, logarithmic")
        for axes in (linear, logarithmic):
            axes.set_xlabel(f"age [{name}]")
        handles = [Line2D([], [], color=INK, linestyle=(0, (4, 3)), linewidth=1.0, label="constant chance of death")]
        if len(seeds) <= _LEGEND_SEEDS:
            handles += [Line2D([], [], color=seed_color(i), label=f"seed {seed}") for i, seed in enumerate(seeds)]
        figure.legend(handles=handles, loc="outside upper left", ncols=6)
    return figure
