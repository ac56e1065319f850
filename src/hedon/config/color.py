"""The color of each thing: one table for figures, videos and the page.

Each of them stands out, by a contrast of at least 3 : 1, from white, from the light ground of the page and from its
dark one (WCAG 2.2, 1.4.11). After Okabe & Ito (2008), "Color universal design", darker where they were too pale.
"""

from collections.abc import Iterable, Mapping, Sequence

from hedon.config.schema.settings import Settings

SPECIES_COLORS = ("#b5508f", "#d55e00", "#2f7fc1", "#6b7884")
FOOD_COLORS = ("#3f8f4f", "#b07d1a", "#8e44ad", "#2f7fc1", "#d55e00", "#0e8f8f", "#a35a2a", "#6b7884")
"""Of kinds of food that name no color, or one that is taken."""
ACTION_COLOR = "#0072b2"
NEUTRAL_COLOR = "#7d8893"
OBSTACLE_COLOR = "#9a7340"
OTHER_COLORS = ("#b8322a", "#3a5fa8", "#7a4fa3", "#b07d1a")
"""Of weights that are neither for something eaten nor for action."""


def species_color(index: int) -> str:
    """The color of a species."""
    return SPECIES_COLORS[index % len(SPECIES_COLORS)]


def food_colors(food_kinds: Sequence[str], wanted: Sequence[str] = ()) -> dict[str, str]:
    """A color per food kind: the one that is wanted; where another kind has it already, the next one that is free."""
    given = wanted if len(wanted) == len(food_kinds) else FOOD_COLORS[:1] * len(food_kinds)
    colors: dict[str, str] = {}
    for kind, color in zip(food_kinds, given, strict=True):
        free = (each for each in FOOD_COLORS if each not in (*colors.values(), *given))
        colors[kind] = next(free, color) if color in colors.values() else color
    return colors


def meal_colors(config: Settings, prey: Sequence[str] = ()) -> dict[str, str]:
    """A color per food kind of a config, and per species that is eaten."""
    foods = food_colors(list(config.food), [food.color for food in config.food.values()])
    return foods | {name: species_color(list(config.species).index(name)) for name in prey}


def weight_colors(names: Iterable[str], kinds: Mapping[str, str]) -> dict[str, str]:
    """A color per weight: that of what is eaten, or those of action, of other rewards and of neutral genes."""
    others = iter(OTHER_COLORS * 8)
    colors = {}
    for name in names:
        known = {"w_action": ACTION_COLOR}.get(name) or kinds.get(name.removeprefix("w_"))
        colors[name] = known or (NEUTRAL_COLOR if name.startswith("neutral_") else next(others))
    return colors
