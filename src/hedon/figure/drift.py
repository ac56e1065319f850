"""Which weights moved further than drift? Scores of worlds against neutral genes, by condition."""

from collections.abc import Mapping
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hedon.figure.style import GRID, INK, PALE, new_figure, seed_color, styled

_NORMAL = 1.96  # standard deviations that contain 95 % of a normal distribution
_LEAST = 3.0  # smallest half range of the axis
_SPREAD = 0.22  # vertical spread of the worlds of a condition


def draw_scores(
    points: Mapping[str, Mapping[int, Mapping[str, float]]],
    titles: Mapping[str, str],
    means: Mapping[str, Mapping[str, Any]],
) -> Figure:
    """Draws a panel per weight, a row per condition and a point per world; the last row is the mean over all worlds.

    Args:
        points: Score of each weight, by condition and seed [sd of drift].
        titles: Title of each genome column, in the order of the panels.
        means: For each genome column "effect", "low" and "high" over all worlds; bounds may be None.
    """
    seeds = sorted({seed for by_seed in points.values() for seed in by_seed})
    all_scores = [score for by_seed in points.values() for scores in by_seed.values() for score in scores.values()]
    reach = 1.1 * max([_LEAST, *map(abs, all_scores)])
    rows = [*points, "all"]
    with styled():
        figure = new_figure(9.0, 1.2 + 0.3 * len(rows))
        panels = figure.subplots(1, len(titles), sharey=True, squeeze=False)[0]
        for axes, (weight, title) in zip(panels, titles.items(), strict=True):
            _frame(axes, title, reach)
            for row, by_seed in enumerate(points.values()):
                for seed, scores in by_seed.items():
                    if weight in scores:
                        y = row + _SPREAD * _offset(seeds.index(seed), len(seeds))
                        axes.plot(scores[weight], y, "o", color=seed_color(seeds.index(seed)), markersize=4.5, zorder=3)
            if weight in means:
                _draw_mean(axes, len(points), means[weight])
        panels[0].set_yticks(range(len(rows)), rows)
        panels[0].set_ylim(len(rows) - 0.5, -0.5)
        handles = [
            Line2D([], [], color=seed_color(i), marker="o", linestyle="", markersize=4.5, label=f"seed {seed}")
            for i, seed in enumerate(seeds)
        ]
        figure.legend(handles=handles, loc="outside upper left", ncols=10)
    return figure


def _frame(axes: Axes, title: str, reach: float) -> None:
    """The band that contains 95 % of drifting genes, and the mean of drift."""
    axes.set_title(title)
    axes.set(xlim=(-reach, reach), xlabel="score [sd of drift]")
    axes.grid(visible=False)
    axes.axvspan(-_NORMAL, _NORMAL, color=GRID, zorder=0)
    axes.axvline(0, color=PALE, linewidth=0.8, zorder=1)


def _draw_mean(axes: Axes, row: int, mean: Mapping[str, Any]) -> None:
    if mean["low"] is not None:
        axes.plot([mean["low"], mean["high"]], [row, row], color=INK, linewidth=1.6, zorder=2)
    axes.plot(mean["effect"], row, "D", color=INK, markersize=5, zorder=3)


def _offset(index: int, count: int) -> float:
    """Vertical position of a world, evenly spaced from −1 to 1 in the order of the seeds."""
    return 2.0 * index / (count - 1) - 1.0 if count > 1 else 0.0
