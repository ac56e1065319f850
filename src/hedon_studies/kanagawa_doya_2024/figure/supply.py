"""Do agents eat all that grows? Food eaten per agent against the number of agents, compared with the supply."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hedon.figure import BLUE, GREEN, INK, MUTED, PALE, VERMILION, new_figure, styled

_COLORS = (BLUE, GREEN, VERMILION)
_ALIVE = (30.0, 260.0)
"""Range of numbers alive, extended if a world is outside."""
_MARGIN = 1.15
_LEAST, _MOST = 3e-4, 2e-2


@dataclass(frozen=True)
class Eater:
    """A world in the figure.

    Attributes:
        condition: Condition, which sets its panel.
        rule: Rule, which sets its color.
        alive: Number of agents alive.
        eaten: Foods eaten per step lived [1/step].
    """

    condition: str
    rule: str
    alive: float
    eaten: float


def draw_supply(
    eaters: Sequence[Eater], rules: Sequence[str], rates: Mapping[str, float | None], supplies: Sequence[float]
) -> Figure:
    """Draws a panel per condition with logarithmic axes.

    Args:
        eaters: The worlds.
        rules: Rules that set the colors of worlds, three at most.
        rates: Food eaten by the paper's agents [1/step], by condition; None if the paper gives no number.
        supplies: Food that grows [food/step], each drawn as a line.
    """
    low = min([_ALIVE[0], *(eater.alive / _MARGIN for eater in eaters)])
    high = max([_ALIVE[1], *(eater.alive * _MARGIN for eater in eaters)])
    colors = dict(zip(rules, _COLORS, strict=False))
    with styled():
        figure = new_figure(9.0, 3.3)
        panels = figure.subplots(1, len(rates), sharex=True, sharey=True, squeeze=False)[0]
        for axes, (condition, rate) in zip(panels, rates.items(), strict=True):
            axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(_LEAST, _MOST), xlabel="agents alive")
            axes.set_xticks([50, 100, 200], ["50", "100", "200"])
            axes.set_xticks([], minor=True)
            axes.set_title(condition)
            _draw_lines(axes, supplies, rate)
            for eater in eaters:
                if eater.condition == condition:
                    axes.plot(eater.alive, eater.eaten, "o", color=colors[eater.rule], markersize=5.5)
        panels[0].set_ylabel("foods per step lived")
        handles = [
            Line2D([], [], color=color, marker="o", linestyle="", markersize=5, label=rule)
            for rule, color in colors.items()
        ]
        handles.append(Line2D([], [], color=MUTED, linestyle="--", linewidth=1.2, label="the paper's rate"))
        figure.legend(handles=handles, loc="outside upper left", ncols=len(handles))
    return figure


def _draw_lines(axes: Axes, supplies: Sequence[float], rate: float | None) -> None:
    """The rates that the supplies allow, and the rate that the paper reports."""
    left, right = axes.get_xlim()
    for supply in supplies:
        axes.plot([left, right], [supply / left, supply / right], color=PALE, linewidth=1.4, zorder=1)
        x = max(left, supply / _MOST) * _MARGIN
        slope = math.degrees(math.atan(-supply / x**2))
        axes.text(
            x,
            supply / x * _MARGIN,
            f"{supply:g} per step",
            color=INK,
            fontsize=7,
            rotation=slope,
            rotation_mode="anchor",
            transform_rotates_text=True,
        )
    if rate is not None:
        axes.axhline(rate, color=MUTED, linestyle="--", linewidth=1.2, zorder=1)
