"""What do the arenas look like, and where does food grow in each?"""

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, FancyArrowPatch, Rectangle

from hedon.config import Config, PlacementConfig, walls
from hedon.figure import AGENT_COLOR, INK, MUTED, draw_agents, draw_foods, draw_walls, meal_colors, new_figure, styled
from hedon.record import Snapshot

_WIDTH = 9.0  # of the figure [inch]
_GAP = 0.16  # between panels [inch]
_HEAD = 0.66  # above each panel, for its title [inch]
_FOOT = 0.1  # below the last row [inch]
_DEVIATIONS = (1, 2)  # standard deviations at which ellipses are drawn around a center of food


@dataclass(frozen=True)
class ArenaPanel:
    """One arena.

    Attributes:
        label: Heading of the panel.
        config: Settings of the arena.
        snapshot: A world in the arena; None if there is no run.
    """

    label: str
    config: Config
    snapshot: Snapshot | None = None


def draw_arenas(rows: Sequence[Sequence[ArenaPanel]]) -> Figure:
    """Draws arenas side by side at the same scale: walls, agents, foods, and the distribution of places of food.

    The heading of each gives its size and numbers, and for each food kind its energy and largest supply.
    """
    columns = max(len(rows[0]) + 1, *(len(row) for row in rows))
    cell = (_WIDTH - _GAP) / columns
    scale = (cell - _GAP) / max(panel.config.arena.width for row in rows for panel in row)  # [inch/u]
    tallest = [scale * max(panel.config.arena.height for panel in row) for row in rows]
    height = sum(tallest) + _HEAD * len(rows) + _FOOT
    with styled():
        figure = new_figure(_WIDTH, height)
        figure.set_layout_engine("none")  # it would stretch panels to different scales
        top = height
        for row, row_height in zip(rows, tallest, strict=True):
            top -= _HEAD
            for column, panel in enumerate(row):
                w, h = panel.config.arena.width * scale, panel.config.arena.height * scale
                rectangle = ((_GAP + column * cell) / _WIDTH, (top - h) / height, w / _WIDTH, h / height)
                _draw_panel(figure.add_axes(rectangle), panel)
            top -= row_height
        legend_place = ((_GAP + (columns - 1) * cell) / _WIDTH, 1 - _HEAD / height)
        figure.legend(
            handles=_handles(rows), loc="upper left", bbox_to_anchor=legend_place, borderpad=0, borderaxespad=0
        )
    return figure


def _draw_panel(axes: Axes, panel: ArenaPanel) -> None:
    config, snapshot = panel.config, panel.snapshot
    colors = meal_colors(config)
    draw_walls(axes, walls(config.arena), 1.4)
    for kind, food in config.food.items():
        _draw_placement(axes, food.placement, colors[kind])
    state = "no run"
    if snapshot is not None:
        draw_foods(axes, snapshot, colors)
        if len(snapshot.x):
            draw_agents(axes, snapshot)
        state = f"{len(snapshot.x)} agents, {len(snapshot.food_x)} foods"
    width, height = config.arena.width, config.arena.height
    foods = "; ".join(
        f"{kind} {food.gives.get('energy', 0.0):+g} (≤ {food.capacity})" for kind, food in config.food.items()
    )
    axes.set_title(panel.label, pad=30)
    for line, text in enumerate((f"{width:g} \N{MULTIPLICATION SIGN} {height:g} u, {state}", foods)):
        axes.annotate(
            text.replace("-", "\N{MINUS SIGN}"),
            (0, 1),
            xycoords="axes fraction",
            xytext=(0, 17 - 11 * line),
            textcoords="offset points",
            color=MUTED,
            fontsize=7.5,
        )
    axes.set(xlim=(0, width), ylim=(0, height))
    axes.axis("off")
    for artist in axes.get_children():
        artist.set_clip_on(False)  # half the width of a wall is outside


def _draw_placement(axes: Axes, placement: PlacementConfig, color: str) -> None:
    """Draws ellipses around each center, and arrows between centers if food moves."""
    if placement.form == "uniform":
        return
    if placement.form == "rectangle":
        (x, y), (half_width, half_height) = placement.centers[0], placement.sd
        corner = (x - half_width, y - half_height)
        axes.add_patch(Rectangle(corner, 2 * half_width, 2 * half_height, color=color, alpha=0.15, zorder=1))
        return
    for center in placement.centers:
        for deviations in _DEVIATIONS:
            width, height = (2 * deviations * sd for sd in placement.sd)
            axes.add_patch(Ellipse(center, width, height, facecolor=color, edgecolor=color, alpha=0.1, zorder=1))
            axes.add_patch(Ellipse(center, width, height, fill=False, edgecolor=color, linewidth=1.0, zorder=6))
    if placement.form == "switching":
        centers = placement.centers
        for number, (center, next_center) in enumerate(zip(centers, centers[1:] + centers[:1], strict=True), 1):
            arrow = FancyArrowPatch(center, next_center, arrowstyle="-|>", mutation_scale=11, shrinkA=9, shrinkB=9)
            arrow.set(color=INK, linewidth=1.3, zorder=7)
            axes.add_patch(arrow)
            box = {"boxstyle": "circle,pad=0.2", "facecolor": "white", "edgecolor": INK, "linewidth": 0.8}
            axes.text(*center, str(number), ha="center", va="center", fontsize=8, bbox=box, zorder=8)


def _handles(rows: Sequence[Sequence[ArenaPanel]]) -> list[Line2D]:
    panels = [panel for row in rows for panel in row]
    colors = {kind: color for panel in panels for kind, color in meal_colors(panel.config).items()}
    places = [food.placement for panel in panels for food in panel.config.food.values()]
    marker_style = {"marker": "o", "linestyle": "", "markeredgecolor": MUTED, "markeredgewidth": 0.5}
    handles = [Line2D([], [], color=AGENT_COLOR, markersize=7, label="agent", **marker_style)]
    marker_style |= {"markersize": 4, "markeredgecolor": "white"}
    handles += [Line2D([], [], color=color, label=f"{kind} food", **marker_style) for kind, color in colors.items()]
    if any(placement.form != "uniform" for placement in places):
        ring = {"marker": "o", "linestyle": "", "markersize": 9, "markerfacecolor": "none"}
        label = "where food grows, if not\nanywhere: Gaussian, 1 and 2 sd"
        handles.append(Line2D([], [], color=next(iter(colors.values())), label=label, **ring))
    for threshold in sorted({placement.switch_after for placement in places if placement.form == "switching"}):
        label = f"next place, after {threshold:,} eaten"
        handles.append(Line2D([], [], color=INK, linewidth=1.3, marker=">", markersize=4, markevery=[1], label=label))
    return handles
