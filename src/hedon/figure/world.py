"""What does a world look like at one moment, and what does an agent see?"""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection, PatchCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Wedge

from hedon.config.color import OBSTACLE_COLOR, species_color
from hedon.figure.outline import wall_outline
from hedon.figure.style import INK, MUTED, PALE, new_figure, styled, wrapped_legend
from hedon.record.snapshot import Snapshot

AGENT_COLOR = "#bed3e6"
"""Color of agents if colors do not show their energy."""
_FLOOR = "#fbfbf8"
_WALL = "#3b4854"
_NEAR = 0.85  # reading of a ray above which an object blocks the view
_LEGEND_COLUMNS = 5  # at most, in one row
_LEGEND_HEIGHT = 0.4  # of two rows, which the figure leaves room for [inch]
_WIDTH = 7.2  # of the figure [inch]
_ENERGY_COLORS = LinearSegmentedColormap.from_list("energy", ["#f1f4f7", "#bed3e6", "#7fb0d6", "#4189c4", "#1f68a8"])


def draw_world(snapshot: Snapshot, colors: Mapping[str, str], rays_of: Sequence[int] = ()) -> Figure:
    """Draws the arena, its foods and its agents with heading, mouth and energy, and the rays of some agents.

    Args:
        snapshot: State of the world.
        colors: Color of each food kind.
        rays_of: Indices of agents in the snapshot whose rays are drawn, each up to the object that it hits.
    """
    low = snapshot.walls.reshape(-1, 2).min(axis=0)
    high = snapshot.walls.reshape(-1, 2).max(axis=0)
    width, height = high - low
    with styled():
        figure = new_figure(_WIDTH, _WIDTH * 0.86 * height / width + 0.8)
        axes = figure.subplots()
        draw_walls(axes, snapshot.walls)
        draw_obstacles(axes, snapshot.obstacles)
        for index in rays_of:
            _draw_rays(axes, snapshot, index, colors)
        draw_foods(axes, snapshot, colors)
        if len(snapshot.x):
            top = _top_energy(snapshot.energy)
            _draw_energy_bar(figure, axes, snapshot, draw_agents(axes, snapshot, top), top)
        if len(rays_of):
            _draw_rings(axes, snapshot, rays_of)
        _draw_scale(axes, low, width)
        axes.set_title(
            f"seed {snapshot.seed}, step {snapshot.step:,}: {len(snapshot.x)} agents, {len(snapshot.food_x)} foods",
            fontsize=9,
        )
        _legend(figure, snapshot, colors, bool(len(rays_of)))
        margin = 0.012 * width
        axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


def telling_agent(snapshot: Snapshot) -> int | None:
    """Index of the agent whose rays see most without being blocked by near objects; None if no agent is alive."""
    if len(snapshot.x) == 0:
        return None
    hits = ((snapshot.rays >= 0) & (snapshot.rays < _NEAR)).sum(axis=1)  # (agents, types)
    weights = np.ones(hits.shape[1])
    solid = 2 if len(snapshot.obstacles) else 1
    weights[1:-solid], weights[-solid] = 2.0, 0.2  # agents look for food, and walls are everywhere
    return int(np.argmax(hits @ weights))


def ray_segments(snapshot: Snapshot, index: int) -> tuple[np.ndarray, np.ndarray]:
    """The rays of one agent, from the surface of its body to the object that they hit or to their end.

    Returns:
        Segments [u], shape (rays, 2, 2), and the type of object that each ray hits, shape (rays,); −1 for none.
    """
    species_index = snapshot.species[index]
    readings = snapshot.rays[index, : snapshot.ray_count[species_index]]
    spread = np.radians(snapshot.of_agents("ray_spread")[index])
    reach = snapshot.of_agents("ray_length")[index]
    angle = snapshot.angle[index] + np.linspace(-spread, spread, len(readings))
    direction = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
    best = readings.max(axis=1)
    kind = np.where(best >= 0, readings.argmax(axis=1), -1)
    length = np.where(kind >= 0, (1 - best) * reach, reach)
    center = np.array([snapshot.x[index], snapshot.y[index]])
    start = center + snapshot.of_agents("radius")[index] * direction
    return np.stack([start, start + length[:, None] * direction], axis=1), kind


def draw_walls(axes: Axes, walls: np.ndarray, linewidth: float = 2.4) -> None:
    """Draws walls, and the floor that they enclose.

    Args:
        axes: Axes to draw on.
        walls: End points x1, y1, x2, y2 of each wall [u], shape (w, 4).
        linewidth: Width of the walls [pt].
    """
    outline = wall_outline(walls)
    if outline is not None:
        axes.add_patch(Polygon(outline, closed=True, facecolor=_FLOOR, edgecolor="none", zorder=0))
    segments = list(walls.reshape(-1, 2, 2))
    axes.add_collection(LineCollection(segments, colors=_WALL, linewidths=linewidth, capstyle="round", zorder=5))


def draw_obstacles(axes: Axes, obstacles: np.ndarray) -> None:
    """Draws obstacles as solid polygons.

    Args:
        axes: Axes to draw on.
        obstacles: Corners of each obstacle [u], shape (o, corners, 2).
    """
    polygons = [Polygon(corners, closed=True) for corners in obstacles]
    axes.add_collection(PatchCollection(polygons, facecolor=OBSTACLE_COLOR, edgecolor=_WALL, linewidth=0.8, zorder=2))


def draw_foods(axes: Axes, snapshot: Snapshot, colors: Mapping[str, str]) -> None:
    """Draws the foods as discs, each in its kind's color.

    Args:
        axes: Axes to draw on.
        snapshot: State of the world with its foods.
        colors: Color of each food kind.
    """
    places = np.stack([snapshot.food_x, snapshot.food_y], axis=-1)
    for i, kind in enumerate(snapshot.food_kinds):
        kind_places = places[snapshot.food_kind == i]
        _discs(axes, kind_places, snapshot.food_radius, facecolors=colors[kind], edgecolors="white", linewidths=0.5)


def draw_agents(axes: Axes, snapshot: Snapshot, top: float | None = None) -> EllipseCollection:
    """Draws the agents as discs with mouth and heading.

    Args:
        axes: Axes to draw on.
        snapshot: State of the world, with at least one agent.
        top: Energy at and above which the color is the darkest; None to draw all agents in the same color.

    Returns:
        The discs.

    Raises:
        ValueError: No agent is alive.
    """
    centers = np.stack([snapshot.x, snapshot.y], axis=-1)
    discs, radius, spread = None, snapshot.of_agents("radius"), snapshot.of_agents("mouth_spread")
    for species in np.unique(snapshot.species).tolist():
        in_species = snapshot.species == species
        several = len(snapshot.species_names) > 1
        edge = {"edgecolors": species_color(species) if several else MUTED, "linewidths": 1.8 if several else 0.5}
        discs = _discs(axes, centers[in_species], radius[in_species], **edge)
        if top is None:
            discs.set_facecolor(AGENT_COLOR)
        else:
            discs.set(array=snapshot.energy[in_species], cmap=_ENERGY_COLORS, norm=Normalize(0, top))
    degree = np.degrees(snapshot.angle) + snapshot.of_agents("mouth_center") + 90.0  # Matplotlib counts from +x
    mouths = [
        Wedge((x, y), r, a - half, a + half, width=1.9)
        for (x, y), a, r, half in zip(centers, degree, radius, spread, strict=True)
    ]
    axes.add_collection(PatchCollection(mouths, facecolor=INK, edgecolor="none", zorder=4))
    headings = np.stack([-np.sin(snapshot.angle), np.cos(snapshot.angle)], axis=-1)
    noses = np.stack([centers, centers + 0.82 * radius[:, None] * headings], axis=1)
    axes.add_collection(LineCollection(list(noses), colors=INK, linewidths=0.9, zorder=4))
    if discs is None:
        raise ValueError("nobody lives")
    return discs


def draw_ring(axes: Axes, snapshot: Snapshot, index: int) -> None:
    """Draws a ring around the agent at this index of the snapshot."""
    center = np.array([[snapshot.x[index], snapshot.y[index]]])
    radius = float(snapshot.of_agents("radius")[index]) + 1.5
    _discs(axes, center, radius, facecolors="none", edgecolors=INK, linewidths=1.4)


def _top_energy(energy: np.ndarray) -> float:
    """The energy drawn darkest: few agents have more; at least 40, which newcomers have, even in poor worlds."""
    return max(float(np.quantile(energy, 0.95)), 40.0)


def _draw_energy_bar(figure: Figure, axes: Axes, snapshot: Snapshot, discs: EllipseCollection, top: float) -> None:
    extension = "max" if snapshot.energy.max() > top else "neither"
    bar = figure.colorbar(discs, ax=axes, location="right", shrink=0.5, aspect=24, pad=0.015, extend=extension)
    bar.set_label("energy of the agent")
    bar.outline.set_visible(False)


def _draw_rings(axes: Axes, snapshot: Snapshot, rays_of: Sequence[int]) -> None:
    for index in rays_of:
        draw_ring(axes, snapshot, index)


def _draw_rays(axes: Axes, snapshot: Snapshot, index: int, colors: Mapping[str, str]) -> None:
    segments, kind = ray_segments(snapshot, index)
    palette = {-1: PALE, **dict(enumerate(_type_colors(snapshot, colors)))}
    line_colors = [palette[k] for k in kind.tolist()]
    widths = np.where(kind >= 0, 1.1, 0.7)
    axes.add_collection(LineCollection(list(segments), colors=line_colors, linewidths=widths, alpha=0.85, zorder=2))
    ends = segments[kind >= 0, 1]
    ends_colors = [palette[k] for k in kind[kind >= 0].tolist()]
    axes.scatter(ends[:, 0], ends[:, 1], s=9, c=ends_colors, linewidths=0, zorder=6)


def _type_colors(snapshot: Snapshot, colors: Mapping[str, str]) -> list[str]:
    species = [species_color(i) for i in range(len(snapshot.species_names))]
    solid = [MUTED, OBSTACLE_COLOR] if len(snapshot.obstacles) else [MUTED]
    return [*species, *(colors[kind] for kind in snapshot.food_kinds), *solid]


def _discs(axes: Axes, centers: np.ndarray, radius: float | np.ndarray, **style: object) -> EllipseCollection:
    size = np.broadcast_to(2.0 * np.asarray(radius), len(centers))
    discs = EllipseCollection(
        size,
        size,
        np.zeros(len(centers)),
        units="xy",
        offsets=centers,
        offset_transform=axes.transData,
        **style,
    )
    discs.set_zorder(3)
    axes.add_collection(discs)
    return discs


def _draw_scale(axes: Axes, low: np.ndarray, width: float) -> None:
    length = 100.0 if width > 200 else 10.0
    y = low[1] - 0.022 * width
    axes.plot([low[0], low[0] + length], [y, y], color=MUTED, linewidth=1.6, clip_on=False)
    axes.text(low[0] + length + 0.01 * width, y, f"{length:.0f} u", color=MUTED, va="center", fontsize=8)


def _legend(figure: Figure, snapshot: Snapshot, colors: Mapping[str, str], with_rays: bool) -> None:
    marker_style = {"marker": "o", "linestyle": "", "markersize": 5}
    handles = [Line2D([], [], color=colors[kind], label=f"{kind} food", **marker_style) for kind in snapshot.food_kinds]
    ring = {"marker": "o", "markersize": 8, "linestyle": "", "markerfacecolor": "none", "markeredgewidth": 1.8}
    handles += [
        Line2D([], [], markeredgecolor=species_color(i), label=name, **ring)
        for i, name in enumerate(snapshot.species_names)
        if len(snapshot.species_names) > 1
    ]
    if with_rays:
        names = [name if len(snapshot.species_names) > 1 else "an agent" for name in snapshot.species_names]
        rays = {
            f"ray that sees {name}": color for name, color in zip(names, _type_colors(snapshot, colors), strict=False)
        }
        rays |= {f"sees {kind} food": colors[kind] for kind in snapshot.food_kinds}
        rays |= {"sees a wall": MUTED}
        rays |= {"sees an obstacle": OBSTACLE_COLOR} if len(snapshot.obstacles) else {}
        rays |= {"sees nothing": PALE}
        handles += [Line2D([], [], color=color, linewidth=1.4, label=label) for label, color in rays.items()]
    columns = len(handles) if len(handles) <= _LEGEND_COLUMNS else -(-len(handles) // 2)
    legend = wrapped_legend(figure, handles, columns, loc="outside lower center", columnspacing=1.4)
    extra_height = legend.get_window_extent().height / figure.dpi - _LEGEND_HEIGHT
    if extra_height > 0:
        figure.set_figheight(figure.get_figheight() + extra_height)
