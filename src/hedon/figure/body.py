"""What does an agent's body look like: its mouth, touch sectors, motors and rays?

The body is drawn with its heading upward. Angles are measured counter-clockwise from the heading.
"""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Wedge
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.figure.style import BLUE, INK, MUTED, VERMILION, new_figure, styled

_BODY = "#dce8f2"
_MOUTH_WIDTH = 0.1  # of the radius
_FORCE_LENGTH = 0.55  # of the arrow of the largest force, in radii
_VIEW = 2.1  # how far the picture of the body reaches to each side, in radii
_SCALE = 100.0  # length of the scale bar of the rays [u]

Point = tuple[float, float]


def draw_body(config: Config) -> Figure:
    """Draws the body with mouth, touch sectors and motors, and next to it the rays at full length."""
    species = next(iter(config.species.values()))
    with styled():
        figure = new_figure(8.6, 3.7)
        body, rays = figure.subplots(1, 2)
        _draw_parts(body, config, species)
        _draw_rays(rays, species)
        for axes in (body, rays):
            axes.set_aspect("equal")
            axes.axis("off")
    return figure


def ray_directions(species_config: SpeciesConfig) -> NDArray[np.float64]:
    """Unit vectors of the rays of an agent that looks along +y, the right-most first, shape (rays, 2)."""
    spread = math.radians(species_config.sensor.ray_spread)
    angle = np.linspace(-spread, spread, species_config.sensor.ray_count)
    return np.stack([-np.sin(angle), np.cos(angle)], axis=-1)


def _draw_parts(axes: Axes, config: Config, species: SpeciesConfig) -> None:
    radius = species.body.radius
    axes.add_patch(Circle((0, 0), radius, facecolor=_BODY, edgecolor=MUTED, linewidth=0.8))
    _draw_touch(axes, species)
    _draw_mouth(axes, species)
    _draw_motors(axes, species)
    _draw_food(axes, species, next(iter(config.food.values())), config.world.food_radius)
    axes.annotate(
        "",
        (0, 1.75 * radius),
        xytext=(0, radius),
        arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.2, "shrinkA": 0},
    )
    axes.text(-0.08 * radius, 1.6 * radius, "heading", ha="right", fontsize=8)
    mass = species.body.density * math.pi * radius**2
    axes.set_title(f"the body: radius {radius:g} u, mass {mass:.3g}")
    axes.set(xlim=(-_VIEW * radius, _VIEW * radius), ylim=(-1.42 * radius, 1.8 * radius))


def _draw_touch(axes: Axes, species: SpeciesConfig) -> None:
    radius, count = species.body.radius, species.sensor.touch_sectors
    edges = [[(0.0, 0.0), _at(radius, 360.0 * i / count)] for i in range(count)]
    axes.add_collection(LineCollection(edges, colors="white", linewidths=1.4))
    for sector in range(count):
        position = _at(0.55 * radius, 360.0 * (sector + 0.5) / count)
        axes.text(*position, str(sector), ha="center", va="center", color=BLUE, fontsize=11, fontweight="bold")
    text = f"touch: {count} sectors of {360 / count:g}°"
    _point_out(axes, text, _at(0.9 * radius, 180.0 * (1 + 1 / count)), (0.0, -1.3 * radius))


def _draw_mouth(axes: Axes, species: SpeciesConfig) -> None:
    radius, spread, center = species.body.radius, species.sensor.mouth_spread, species.sensor.mouth_center
    width, heading = _MOUTH_WIDTH * radius, 90 + center
    axes.add_patch(Wedge((0, 0), radius, heading - spread, heading + spread, width=width, facecolor=INK, zorder=3))
    span = f"{center - spread:g}° to {center + spread:g}°".replace("-", "\N{MINUS SIGN}") if center else f"±{spread:g}°"
    _point_out(axes, f"mouth: {span}", _at(radius, center + 0.75 * spread), (-1.5 * radius, 1.1 * radius))


def _draw_motors(axes: Axes, species: SpeciesConfig) -> None:
    radius, motor = species.body.radius, species.motor
    unit = _FORCE_LENGTH * radius / motor.max_force
    places = np.array([_at(radius, motor.angle), _at(radius, -motor.angle)])
    for x, y in places:
        for force, color in ((motor.max_force, VERMILION), (motor.min_force, MUTED)):
            axes.annotate(
                "",
                (x, y + unit * force),
                xytext=(x, y),
                arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0},
            )
    axes.scatter(*places.T, s=26, color=VERMILION, zorder=4)
    span = f"{motor.min_force:g} to {motor.max_force:g}".replace("-", "\N{MINUS SIGN}")
    for (x, y), name in zip(places, ("left motor", "right motor"), strict=True):
        side = math.copysign(1.0, x)
        axes.text(
            x + 0.16 * radius * side,
            y - 0.05 * radius,
            f"{name}, at {motor.angle:g}°:\nforce {span}",
            ha="left" if side > 0 else "right",
            va="top",
            fontsize=8,
        )


def _draw_food(axes: Axes, species: SpeciesConfig, food: FoodConfig, size: float) -> None:
    radius = species.body.radius
    position = _at(radius + size, species.sensor.mouth_center - 0.7 * species.sensor.mouth_spread)
    axes.add_patch(Circle(position, size, facecolor=food.color, edgecolor="white", linewidth=0.5))
    text = f"food, radius {size:g} u:\nthe mouth eats\nwhat it touches"
    axes.text(position[0] + 1.3 * size, position[1], text, va="center", fontsize=8)


def _draw_rays(axes: Axes, species: SpeciesConfig) -> None:
    radius, sensor = species.body.radius, species.sensor
    directions = ray_directions(species)
    reach = radius + sensor.ray_length
    segments = np.stack([radius * directions, reach * directions], axis=1)
    axes.add_collection(LineCollection(list(segments), colors=BLUE, linewidths=0.9))
    axes.add_patch(Circle((0, 0), radius, facecolor=_BODY, edgecolor=MUTED, linewidth=0.8))
    axes.plot([0, 0], [radius, 1.06 * reach], color=INK, linewidth=1.0, linestyle=(0, (4, 3)))
    axes.text(0, 1.08 * reach, "heading", ha="center", va="bottom", fontsize=8)
    for i in sorted({0, sensor.ray_count - 1}):
        x, y = 1.03 * reach * directions[i]
        axes.text(
            x, y, f"ray {i}", ha="left" if x > 0 else "right", va="top", color=BLUE, fontsize=8, fontweight="bold"
        )
    axes.set_title(f"the rays: {sensor.ray_count}, within ±{sensor.ray_spread:g}°, each {sensor.ray_length:g} u long")
    low = min(float(segments[..., 1].min()), -radius)
    axes.set(xlim=(-1.1 * reach, 1.1 * reach), ylim=(low - 0.05 * reach, 1.16 * reach))
    left = -1.1 * reach
    axes.plot([left, left + _SCALE], [low, low], color=MUTED, linewidth=1.6)
    axes.text(left + _SCALE + 0.02 * reach, low, f"{_SCALE:g} u", color=MUTED, va="center", fontsize=8)


def _point_out(axes: Axes, text: str, position: Point, label: Point) -> None:
    """Writes a label with a line to the part that it names."""
    arrow = {"arrowstyle": "-", "color": MUTED, "linewidth": 0.8}
    axes.annotate(text, position, xytext=label, fontsize=8, ha="center", va="center", arrowprops=arrow)


def _at(distance: float, degree: float) -> Point:
    """The point at a distance [u] from the center, at an angle from the heading, counter-clockwise."""
    angle = math.radians(degree)
    return -distance * math.sin(angle), distance * math.cos(angle)
