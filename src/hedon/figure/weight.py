"""Which combinations of rewards evolved? Weights of agents against one another, compared with drift."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import polars as pl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from hedon.config.color import NEUTRAL_COLOR
from hedon.config.title import weight_title
from hedon.figure.style import (
    MUTED,
    PALE,
    draw_message,
    head,
    new_figure,
    say_empty,
    seed_color,
    step_unit,
    styled,
)

Floats = NDArray[np.float64]

_MIN_HALF_RANGE = 1.0  # of the weight axes
_SHARE_WITHIN = 0.98  # of the agents, in each weight; room for the rest would squeeze all others
_MARGIN = 1.3
_BINS = 60
_SIDE = 0.225  # width of a distribution beyond the axes, in panels
_WIDEST = 10.0  # figure [inch]
_DENSITY_COLOR = "#6b7884"
_LEGEND_SEEDS = 10  # more would hide the data


@dataclass(frozen=True)
class WeightGroup:
    """The agents of one condition, drawn as one or more panels.

    Attributes:
        agents: Rows of the table `agents` to show; `world` decides their colors.
        panels: Genome columns along the x and the y axis of each panel.
        title: Name of the condition.
        remark: Further information shown under the title.
        drift: By genome column, values that such agents would have under drift alone, as `drift_genes` returns them,
            shape (draws,); genes without values get no control.
    """

    agents: pl.DataFrame
    panels: Sequence[tuple[str, str]]
    title: str = ""
    remark: str = ""
    drift: Mapping[str, Floats] = field(default_factory=dict)

    @property
    def weights(self) -> list[str]:
        """The genome columns along the axes."""
        return list(dict.fromkeys(name for panel in self.panels for name in panel))


def against_action(reward_names: Sequence[str]) -> list[tuple[str, str]]:
    """A panel per weight except that of action: the weight along the x axis, action along the y axis."""
    return [(name, "w_action") for name in reward_names if name != "w_action"]


def draw_weights(agents: pl.DataFrame, reward_names: Sequence[str], drift: Mapping[str, Floats]) -> Figure:
    """Draws each weight of some agents of one condition against the weight of action.

    Args:
        agents: Rows of the table `agents` to show.
        reward_names: Genome columns that have an effect.
        drift: By genome column, values that such agents would have under drift alone, each of shape (draws,); see
            `WeightGroup`.
    """
    panels = against_action(reward_names)
    if not panels:
        return draw_message("no weight but that of action")
    return draw_weight_groups([WeightGroup(agents, panels, drift=drift)])


def draw_weight_groups(groups: Sequence[WeightGroup]) -> Figure:
    """Draws the panels of each condition side by side, with a point per agent.

    Colors distinguish worlds, or show the time of birth if there is only one world. The histograms outside the axes are
    the distributions over all agents; the gray outlines show the distributions under drift alone.
    All panels have the same axes, which include nearly all agents of each condition; crosses at the edge
    mark the agents beyond.

    Args:
        groups: The conditions from left to right, at least one.
    """
    reach = max(_reach(group) for group in groups)
    panels = sum(len(group.panels) for group in groups)
    columns = panels + _SIDE * len(groups)  # width of the panels and of the distributions next to them, in panels
    size = min(3.3, (_WIDEST - 0.6) / columns)  # of a panel [inch]
    lines = max((1 + group.remark.count("\n") + bool(group.remark) for group in groups if group.title), default=0)
    with styled():
        figure = new_figure(size * columns + 0.6, 1.2 * size + 0.54 + 0.18 * lines)
        grid = figure.add_gridspec(
            2,
            panels + len(groups),
            width_ratios=[part for group in groups for part in (*[1.0] * len(group.panels), _SIDE)],
            height_ratios=[_SIDE, 1.0],
            wspace=0,
            hspace=0,
        )
        by_birth = len(groups) == 1 and groups[0].agents["world"].n_unique() == 1
        column = 0
        for group in groups:
            for panel in group.panels:
                axes = figure.add_subplot(grid[1, column])
                _scatter(figure, axes, group, panel, by_birth=by_birth)
                _edge_marks(axes, group.agents, panel, reach)
                _set_axes(axes, panel, reach, first=column == 0)
                top = figure.add_subplot(grid[0, column], sharex=axes)
                _marginal(top, group, panel[0], reach)
                column += 1
                if panel == group.panels[0]:
                    head(top, group.title, group.remark)
                    if group.agents.is_empty():
                        say_empty(axes, "no agents recorded")
                if panel == group.panels[-1]:
                    side = figure.add_subplot(grid[1, column], sharey=axes)
                    _marginal(side, group, panel[1], reach, upright=True)
                    column += 1
        _legend(figure, groups, reach)
    return figure


def _set_axes(axes: Axes, panel: tuple[str, str], reach: float, *, first: bool) -> None:
    x, y = map(weight_title, panel)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel=x)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
    if first:
        axes.set_ylabel(y)
    else:
        axes.tick_params(labelleft=False)


def _scatter(figure: Figure, axes: Axes, group: WeightGroup, panel: tuple[str, str], *, by_birth: bool) -> None:
    rows = group.agents
    for draw in (axes.axhline, axes.axvline):
        draw(0, color=PALE, linewidth=1.0, zorder=0.5)
    # Points are drawn in random order, so that the last world does not cover the others.
    order = np.random.default_rng(0).permutation(rows.height)
    x, y = (rows[name].to_numpy()[order] for name in panel)
    size = float(np.clip(6e4 / max(rows.height, 1), 3.0, 14.0))
    style = {"s": size, "linewidths": 0, "alpha": 0.45, "rasterized": True}
    if not by_birth or rows["birth_step"].n_unique() < 2:
        axes.scatter(x, y, c=[seed_color(world) for world in rows["world"].to_numpy()[order]], **style)
    else:
        unit, unit_name = step_unit(float(rows["birth_step"].to_numpy().max()))
        births = rows["birth_step"].to_numpy()[order] / unit
        points = axes.scatter(x, y, c=births, cmap="viridis", **style)
        if panel == group.panels[0]:
            bar = figure.colorbar(points, ax=axes, location="bottom", shrink=0.7, aspect=40, pad=0.02)
            bar.set_label(f"born at [{unit_name}]")
            if bar.solids is not None:
                bar.solids.set_alpha(1)
            bar.outline.set_visible(False)


def _edge_marks(axes: Axes, rows: pl.DataFrame, panel: tuple[str, str], reach: float) -> None:
    """Crosses at the edge of the axes for the agents beyond it."""
    rows = rows.filter(_is_beyond(panel, reach))
    x, y = (np.clip(rows[column].to_numpy(), -reach, reach) for column in panel)
    axes.scatter(x, y, marker="x", s=9, linewidths=0.7, color=MUTED, alpha=0.7, clip_on=False, zorder=3)


def _marginal(axes: Axes, group: WeightGroup, name: str, reach: float, *, upright: bool = False) -> None:
    edges = np.linspace(-reach, reach, _BINS + 1)
    bins = {"bins": edges, "orientation": "horizontal" if upright else "vertical"}
    values, drift_values = group.agents[name].to_numpy(), group.drift.get(name)
    if len(values):
        fill_style = {"histtype": "stepfilled", "color": _DENSITY_COLOR, "linewidth": 0}
        axes.hist(values, weights=np.full(len(values), 1 / len(values)), **fill_style, **bins)
    if drift_values is not None:
        outline_style = {"histtype": "step", "color": NEUTRAL_COLOR, "linewidth": 1.2}
        axes.hist(drift_values, weights=np.full(len(drift_values), 1 / len(drift_values)), **outline_style, **bins)
    axes.axis("off")


def _legend(figure: Figure, groups: Sequence[WeightGroup], reach: float) -> None:
    handles: list[Artist] = []
    worlds = sorted({world for group in groups for world in group.agents.select("world", "seed").unique().rows()})
    if 1 < len(worlds) <= _LEGEND_SEEDS:
        marker_style = {"marker": "o", "linestyle": "", "markersize": 4.5}
        handles += [Line2D([], [], color=seed_color(w), label=f"seed {seed}", **marker_style) for w, seed in worlds]
    handles.append(Patch(color=_DENSITY_COLOR, label="all agents"))
    handles.append(_drift_handle(groups, reach))
    beyond_count = sum(group.agents.filter(_is_beyond(group.weights, reach)).height for group in groups)
    if beyond_count:
        cross = {"marker": "x", "linestyle": "", "markersize": 3.5, "color": MUTED}
        handles.append(Line2D([], [], label=f"{beyond_count:,} agents beyond", **cross))
    narrow_columns = 3 if 4 < len(handles) <= 6 else 4
    columns = narrow_columns if len(figure.axes) < 5 else len(handles)
    figure.legend(handles=handles, loc="outside lower left", ncols=columns, columnspacing=1.0, handletextpad=0.3)


def _drift_handle(groups: Sequence[WeightGroup], reach: float) -> Artist:
    """Legend entry for the outline of drift: its share beyond the axes, and the weights that have no outline."""
    drift_values = [group.drift[name] for group in groups for name in group.weights if name in group.drift]
    missing_names = list(dict.fromkeys(name for group in groups for name in group.weights if name not in group.drift))
    outside_share = float((np.abs(np.concatenate(drift_values)) > reach).mean()) if drift_values else 0.0
    label = "drift alone" if outside_share < 0.01 else f"drift alone ({100 * outside_share:.0f} % beyond)"
    if missing_names:
        label = f"drift alone: not known of {', '.join(missing_names)}" if drift_values else "drift alone: not known"
    return Patch(facecolor="none", edgecolor=NEUTRAL_COLOR, linewidth=1.2, label=label)


def _is_beyond(names: Sequence[str], reach: float) -> pl.Expr:
    """Whether any of these weights of an agent is beyond the axes."""
    return pl.any_horizontal(pl.col(*names).abs() > reach)


def _reach(group: WeightGroup) -> float:
    """Half the range of the axes, just large enough for nearly all agents."""
    if group.agents.is_empty():
        return _MIN_HALF_RANGE
    weights = np.abs(group.agents.select(group.weights).to_numpy())
    bulk, largest = np.quantile(weights, _SHARE_WITHIN, axis=0).max(), weights.max()
    return max(_MIN_HALF_RANGE, min(_MARGIN * float(bulk), 1.08 * float(largest)))
