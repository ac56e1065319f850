"""Which combinations of rewards evolved? Weights of the agents that were born last, as in the paper."""

from collections.abc import Sequence

import numpy as np
import polars as pl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from hedon.analysis.style import (
    MUTED,
    NEUTRAL_COLOR,
    PALE,
    new_figure,
    say_empty,
    seed_color,
    step_unit,
    styled,
)
from hedon.analysis.weight import LAST_AGENTS, last_agents

_MIN_HALF_RANGE = 1.0  # of the weight axes
_SHARE_WITHIN = 0.98  # of the agents, in each weight; the few beyond would squeeze all others
_MARGIN = 1.3
_BINS = 60
_DENSITY_COLOR = "#6b7884"
_LEGEND_SEEDS = 10  # more would hide the data


def draw_weights(
    agents: pl.DataFrame, food_kinds: Sequence[str], neutral_names: Sequence[str], count: int = LAST_AGENTS
) -> Figure:
    """One panel per food kind: its weight against the weight of action, a point per agent.

    Colors tell worlds apart, or the time of birth where there is one world. The curves beyond the axes are
    the distributions over all agents, with that of the first neutral marker behind them in gray.
    The axes reach as far as nearly all agents; crosses at their edge stand for those beyond.

    Args:
        agents: table `agents`.
        food_kinds: names.
        neutral_names: genome columns.
        count: agents per world.
    """
    rows = last_agents(agents, count)
    names = [f"w_{kind}" for kind in food_kinds]
    reach = _reach(rows, [*names, "w_action"])
    beyond = rows.filter(pl.any_horizontal(pl.col(*names, "w_action").abs() > reach)).height
    neutral = rows[neutral_names[0]].to_numpy() if neutral_names else np.array([])
    with styled():
        figure = new_figure(3.3 * len(names) + 1.3, 4.5)
        grid = figure.add_gridspec(
            2,
            len(names) + 1,
            width_ratios=[*[4] * len(names), 0.9],
            height_ratios=[0.9, 4],
            wspace=0,
            hspace=0,
        )
        for i, (kind, name) in enumerate(zip(food_kinds, names, strict=True)):
            axes = figure.add_subplot(grid[1, i])
            _scatter(figure, axes, rows, name)
            _edge_marks(axes, rows, name, reach)
            axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel=f"weight of {kind} food")
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_major_locator(MaxNLocator(5))
            if i == 0:
                axes.set_ylabel("weight of action")
            _marginal(figure.add_subplot(grid[0, i], sharex=axes), rows[name].to_numpy(), neutral, reach)
            if i == len(names) - 1:
                side = figure.add_subplot(grid[1, i + 1], sharey=axes)
                _marginal(side, rows["w_action"].to_numpy(), neutral, reach, upright=True)
        _legend(figure, rows, neutral, reach, beyond)
        if rows.is_empty():
            say_empty(figure.axes[0], "no agents recorded")
    return figure


def _scatter(figure: Figure, axes: Axes, rows: pl.DataFrame, name: str) -> None:
    for draw in (axes.axhline, axes.axvline):
        draw(0, color=PALE, linewidth=1.0, zorder=0.5)
    # Worlds in random order, so that the last does not cover the others.
    order = np.random.default_rng(0).permutation(rows.height)
    x, y = rows[name].to_numpy()[order], rows["w_action"].to_numpy()[order]
    size = float(np.clip(6e4 / max(rows.height, 1), 3.0, 14.0))
    look = {"s": size, "linewidths": 0, "alpha": 0.45, "rasterized": True}
    if rows["world"].n_unique() > 1:
        axes.scatter(x, y, c=[seed_color(world) for world in rows["world"].to_numpy()[order]], **look)
    elif rows["birth_step"].n_unique() < 2:
        axes.scatter(x, y, color=seed_color(0), **look)
    else:
        unit, unit_name = step_unit(float(rows["birth_step"].to_numpy().max()))
        births = rows["birth_step"].to_numpy()[order] / unit
        points = axes.scatter(x, y, c=births, cmap="viridis", **look)
        if name == next(column for column in rows.columns if column.startswith("w_")):
            bar = figure.colorbar(points, ax=axes, location="bottom", shrink=0.7, aspect=40, pad=0.02)
            bar.set_label(f"born at [{unit_name}]")
            if bar.solids is not None:
                bar.solids.set_alpha(1)
            bar.outline.set_visible(False)


def _edge_marks(axes: Axes, rows: pl.DataFrame, name: str, reach: float) -> None:
    """Crosses at the edge of the axes for the agents that lie beyond it."""
    rows = rows.filter(pl.any_horizontal(pl.col(name, "w_action").abs() > reach))
    x, y = (np.clip(rows[column].to_numpy(), -reach, reach) for column in (name, "w_action"))
    axes.scatter(x, y, marker="x", s=9, linewidths=0.7, color=MUTED, alpha=0.7, clip_on=False, zorder=3)


def _marginal(axes: Axes, values: np.ndarray, neutral: np.ndarray, reach: float, *, upright: bool = False) -> None:
    edges = np.linspace(-reach, reach, _BINS + 1)
    orientation = "horizontal" if upright else "vertical"
    look = {"bins": edges, "orientation": orientation, "histtype": "stepfilled"}
    if len(values):
        axes.hist(values, weights=np.full(len(values), 1 / len(values)), color=_DENSITY_COLOR, linewidth=0, **look)
    if len(neutral):
        axes.hist(
            neutral,
            weights=np.full(len(neutral), 1 / len(neutral)),
            **{**look, "histtype": "step"},
            color=NEUTRAL_COLOR,
            linewidth=1.2,
            label="neutral marker",
        )
    axes.axis("off")


def _legend(figure: Figure, rows: pl.DataFrame, neutral: np.ndarray, reach: float, beyond: int) -> None:
    handles: list[Artist] = []
    worlds = rows.select("world", "seed").unique().sort("world").rows()
    if 1 < len(worlds) <= _LEGEND_SEEDS:
        dot = {"marker": "o", "linestyle": "", "markersize": 4.5}
        handles += [Line2D([], [], color=seed_color(w), label=f"seed {seed}", **dot) for w, seed in worlds]
    handles.append(Patch(color=_DENSITY_COLOR, label="all agents"))
    if len(neutral):
        outside = float((np.abs(neutral) > reach).mean())
        label = "neutral marker" if outside < 0.01 else f"neutral marker ({100 * outside:.0f} % beyond)"
        handles.append(Patch(facecolor="none", edgecolor=NEUTRAL_COLOR, linewidth=1.2, label=label))
    if beyond:
        cross = {"marker": "x", "linestyle": "", "markersize": 3.5, "color": MUTED}
        handles.append(Line2D([], [], label=f"{beyond:,} agents beyond", **cross))
    narrow = 3 if 4 < len(handles) <= 6 else 4
    columns = narrow if len(figure.axes) < 5 else len(handles)
    figure.legend(handles=handles, loc="outside lower left", ncols=columns, columnspacing=1.0, handletextpad=0.3)


def _reach(rows: pl.DataFrame, names: Sequence[str]) -> float:
    """Half the range of the axes: room for nearly all agents, but none for what no agent has."""
    if rows.is_empty():
        return _MIN_HALF_RANGE
    weights = np.abs(rows.select(names).to_numpy())
    bulk, largest = np.quantile(weights, _SHARE_WITHIN, axis=0).max(), weights.max()
    return max(_MIN_HALF_RANGE, min(_MARGIN * float(bulk), 1.08 * float(largest)))
