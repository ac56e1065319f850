"""Types: what senses can distinguish, and which types a species eats, sees, touches and smells."""

from collections.abc import Sequence

from hedon.config.schema.settings import Settings
from hedon.config.schema.species import EVERYTHING, SpeciesConfig

WALL = "wall"
"""Type of a wall."""
OBSTACLE = "obstacle"
"""Type of an obstacle, in worlds with obstacles."""
SOLID = (WALL, OBSTACLE)
"""Types that every species sees and collides with, if they exist."""


def types(config: Settings) -> tuple[str, ...]:
    """Types that senses can distinguish, in the engine's order: species, food kinds, walls, obstacles."""
    return (*config.species, *config.food, *(SOLID if config.obstacle.count else (WALL,)))


def diet(config: Settings, species: SpeciesConfig) -> dict[str, float]:
    """Factors of what a species eats, by name."""
    return {
        kind: factor
        for name, factor in species.diet.eats
        for kind in (config.food if name == EVERYTHING else [name])
        if factor != 0.0
    }


def hunted(config: Settings) -> str:
    """The first species that another species eats.

    Raises:
        StopIteration: No species eats another.
    """
    return next(name for name in config.species if hunters(config, name))


def hunters(config: Settings, name: str) -> tuple[str, ...]:
    """The other species that eat a species, in order."""
    return tuple(other for other, species in config.species.items() if other != name and name in diet(config, species))


def chosen(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """Types selected by a list of names, in order; walls and obstacles are always among them."""
    all_types = types(config)
    return all_types if EVERYTHING in names else tuple(name for name in all_types if name in names or name in SOLID)


def look(config: Settings, name: str) -> str:
    """The type that agents see in place of this type."""
    return (config.food[name].looks_like or name) if name in config.food else name


def seen(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """Types that rays distinguish for a list of names; a type that looks like another is left out."""
    return tuple(name for name in chosen(config, names) if look(config, name) == name)


def asked_for(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """Types that a query finds for a list of names, in order: species and food kinds."""
    all_species = config.species if EVERYTHING in names else ()
    return tuple(name for name in (*config.species, *config.food) if name in names or name in all_species)


def smelled(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """Sources of smell selected by a list of names, in order: species and food kinds."""
    return tuple(name for name in (*config.species, *config.food) if name in names or EVERYTHING in names)
