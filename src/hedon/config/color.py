"""Colors of all things shown, shared by figures, videos and the page.

Each has a contrast of at least 3 : 1 against white and against the page's light and dark backgrounds (WCAG 2.2,
1.4.11). Based on Okabe & Ito (2008), "Color universal design", with the palest colors darkened.
"""

from collections.abc import Iterable, Mapping, Sequence

from hedon.config.schema.settings import Settings

SPECIES_COLORS = ("#b5508f", "#d55e00", "#2f7fc1", "#6b7884")
FOOD_COLORS = ("#3f8f4f", "#b07d1a", "#8e44ad", "#2f7fc1", "#d55e00", "#0e8f8f", "#a35a2a", "#6b7884")
"""Colors of food kinds that set no color or one already in use."""
ACTION_COLOR = "#0072b2"
NEUTRAL_COLOR = "#7d8893"
OBSTACLE_COLOR = "#9a7340"
OTHER_COLORS = ("#b8322a", "#3a5fa8", "#7a4fa3", "#b07d1a")
"""Colors of weights that are neither for something eaten nor for action."""


def species_color(index: int) -> str:
    """Color of a species."""
    return SPECIES_COLORS[index % len(SPECIES_COLORS)]


def food_colors(food_kinds: Sequence[str], wanted: Sequence[str] = ()) -> dict[str, str]:
    """Color of each food kind: the wanted one, or the next free one if another kind already has it."""
    preferred = wanted if len(wanted) == len(food_kinds) else FOOD_COLORS[:1] * len(food_kinds)
    colors: dict[str, str] = {}
    for kind, color in zip(food_kinds, preferred, strict=True):
        free = (candidate for candidate in FOOD_COLORS if candidate not in (*colors.values(), *preferred))
        colors[kind] = next(free, color) if color in colors.values() else color
    return colors


def meal_colors(config: Settings, prey: Sequence[str] = ()) -> dict[str, str]:
    """Color of each food kind in a config and of each species that is eaten."""
    foods = food_colors(list(config.food), [food.color for food in config.food.values()])
    return foods | {name: species_color(list(config.species).index(name)) for name in prey}


def weight_colors(names: Iterable[str], kinds: Mapping[str, str]) -> dict[str, str]:
    """Color of each weight: the color of what is eaten, or one for action, other rewards or neutral genes."""
    other_colors = iter(OTHER_COLORS * 8)
    colors = {}
    for name in names:
        color = {"w_action": ACTION_COLOR}.get(name) or kinds.get(name.removeprefix("w_"))
        colors[name] = color or (NEUTRAL_COLOR if name.startswith("neutral_") else next(other_colors))
    return colors
