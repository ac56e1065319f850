"""Does a gene move where its world's mutations push it? Predicted against observed values, a point per world."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hedon.figure import BLUE, GREEN, MUTED, ORANGE, PALE, VERMILION, new_figure, say_empty, styled
from hedon_studies.kanagawa_doya_2024.analysis.bias import COMPARISONS, Drift

_COLORS = (VERMILION, BLUE, GREEN, ORANGE)
_MARKERS = ("o", "s", "^", "D")
_LABELS = {
    "drift per generation": ("mean mutation per birth", "drift per generation"),
    "weight at the end": ("weight of lines without selection", "weight of those born last"),
    "bias, first half and second": ("mean mutation, first half", "mean mutation, second half"),
}
_LINEAR = 0.003
"""Size below which an axis of mutations is linear; above, it is logarithmic, since Cauchy noise spans magnitudes."""


def draw_predictions(conditions: Mapping[str, Sequence[Drift]], titles: Mapping[str, str]) -> Figure:
    """Draws a panel per comparison, a color per condition and a mark per gene. The line marks equal values.

    Args:
        conditions: Predicted and observed drift of each gene, by condition.
        titles: Title of each genome column.
    """
    colors = dict(zip(conditions, _COLORS, strict=False))
    shown_drifts = {label: drifts for label, drifts in conditions.items() if drifts}
    with styled():
        figure = new_figure(9.0, 3.5)
        panels = figure.subplots(1, len(COMPARISONS))
        for axes, (comparison, (predicted, observed)) in zip(panels, COMPARISONS.items(), strict=True):
            reach = 0.0
            for label, drifts in shown_drifts.items():
                for marker, weight in zip(_MARKERS, titles, strict=False):
                    pairs = np.array([(d[predicted], d[observed]) for d in drifts if d["weight"] == weight])
                    pairs = pairs.reshape(-1, 2)[np.isfinite(pairs.reshape(-1, 2)).all(axis=1)]
                    style = {"marker": marker, "facecolors": "none", "edgecolors": colors[label], "linewidths": 1.2}
                    axes.scatter(pairs[:, 0], pairs[:, 1], s=26, zorder=3, **style)
                    reach = max(reach, float(np.abs(pairs).max(initial=0.0)))
            _frame(axes, comparison, reach)
            if not shown_drifts:
                say_empty(axes, "no births recorded")
        marks = [
            Line2D([], [], color=MUTED, marker=marker, linestyle="", markerfacecolor="none", label=title)
            for marker, title in zip(_MARKERS, titles.values(), strict=False)
        ]
        lines = [Line2D([], [], color=colors[label], linewidth=4, label=label) for label in shown_drifts]
        figure.legend(handles=[*lines, *marks], loc="outside upper left", ncols=len(marks) + len(lines))
    return figure


def _frame(axes: Axes, comparison: str, reach: float) -> None:
    """Equal axes around 0 and the line of equality."""
    x, y = _LABELS[comparison]
    axes.set_title(comparison, fontsize=9)
    axes.set(xlabel=x, ylabel=y)
    limit = 1.4 * reach or 1.0
    if comparison != "weight at the end":
        limit = max(limit, 10 * _LINEAR)
        decades = [_LINEAR * 10**k for k in range(5) if _LINEAR * 10**k <= limit][-2:]  # more would not fit
        ticks = [0.0, *decades, *(-t for t in decades)]
        axes.set_xscale("symlog", linthresh=_LINEAR)
        axes.set_yscale("symlog", linthresh=_LINEAR)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_ticks(ticks, [f"{t:g}".replace("-", "\N{MINUS SIGN}") for t in ticks])
            axis.set_ticks([], minor=True)
    axes.set(xlim=(-limit, limit), ylim=(-limit, limit))
    axes.set_box_aspect(1)
    axes.plot([-limit, limit], [-limit, limit], color=PALE, linewidth=1.2, zorder=0.5)
    for draw in (axes.axhline, axes.axvline):
        draw(0, color=PALE, linewidth=0.8, zorder=0.5)
