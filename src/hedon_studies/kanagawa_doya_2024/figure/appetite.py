"""How much do agents eat depending on their liking for food, and when did that liking evolve?"""

from collections.abc import Mapping, Sequence

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hedon.figure import (
    BLUE,
    PALE,
    VERMILION,
    draw_time_axis,
    draw_traces,
    draw_zero_line,
    last_step,
    new_figure,
    say_empty,
    styled,
)
from hedon_studies.kanagawa_doya_2024.analysis.appetite import AppetiteBin

_COLORS = (BLUE, VERMILION)
_TICKS = (-10, -1, -0.1, 0, 0.1, 1, 10)


def draw_appetite(bins: Mapping[str, Sequence[Sequence[AppetiteBin]]], histories: Mapping[str, pl.DataFrame]) -> Figure:
    """Draws foods per 1000 steps against the weight of food, by condition, and the mean of that weight over time.

    Thin lines are worlds; thick lines are means over worlds, for bins that more than half of them have.

    Args:
        bins: Bins of each world, by condition.
        histories: Mean weight over time, by condition.
    """
    with styled():
        figure = new_figure(9.0, 3.5)
        eating, evolving = figure.subplots(1, 2)
        for color, (label, worlds) in zip(_COLORS, bins.items(), strict=False):
            for world in worlds if len(worlds) > 1 else []:
                eating.plot([b.weight for b in world], [b.eaten for b in world], color=color, linewidth=0.8, alpha=0.4)
            x, y = _mean(worlds)
            eating.plot(x, y, color=color, linewidth=2.0, marker="o", markersize=4, label=label)
        eating.set_xscale("symlog", linthresh=0.1, linscale=0.5)
        eating.set_xticks(_TICKS, [f"{t:g}".replace("-", "\N{MINUS SIGN}") for t in _TICKS])
        eating.set_xticks([], minor=True)
        eating.axvline(0, color=PALE, linewidth=1.0, zorder=0.5)
        eating.set(xlim=(-11, 11), xlabel="weight of food", ylabel="foods per 1000 steps lived")
        eating.set_ylim(bottom=0)
        eating.set_title("how well agents eat", fontsize=9)
        _draw_history(evolving, histories)
        if any(len(world) for worlds in bins.values() for world in worlds):
            eating.legend(loc="upper left")
        else:
            say_empty(eating, "no lives long enough")
    return figure


def _draw_history(axes: Axes, histories: Mapping[str, pl.DataFrame]) -> None:
    axes.set_title("weight of food, mean of the living", fontsize=9)
    draw_zero_line(axes)
    end = max(map(last_step, histories.values()), default=0.0)
    for color, (label, rows) in zip(_COLORS, histories.items(), strict=False):
        draw_traces(axes, rows, "w_normal_mean", color, label, end=end)
        draw_time_axis(axes, rows, end)


def _mean(worlds: Sequence[Sequence[AppetiteBin]]) -> tuple[np.ndarray, np.ndarray]:
    """Means over worlds, for bins that more than half of them have."""
    by_low: dict[float, list[AppetiteBin]] = {}
    for world in worlds:
        for part in world:
            by_low.setdefault(part.low, []).append(part)
    common_bins = [by_low[low] for low in sorted(by_low) if 2 * len(by_low[low]) > len(worlds)]
    x = [float(np.mean([b.weight for b in parts])) for parts in common_bins]
    return np.array(x), np.array([float(np.mean([b.eaten for b in parts])) for parts in common_bins])
