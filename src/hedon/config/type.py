"""Types: what senses can tell apart, and which of them a species eats, sees, touches and smells."""

from collections.abc import Sequence

from hedon.config.schema.settings import Settings
from hedon.config.schema.species import EVERYTHING, SpeciesConfig

WALL = "wall"
"""What senses call a wall."""
OBSTACLE = "obstacle"
"""What senses call an obstacle, in worlds that have some."""
SOLID = (WALL, OBSTACLE)
"""What every species sees and collides with, where it is."""


def types(config: Settings) -> tuple[str, ...]:
    """What senses may tell apart, in the engine's order: the species, the kinds of food, walls, and obstacles."""
    return (*config.species, *config.food, *(SOLID if config.obstacle.count else (WALL,)))


def diet(config: Settings, species: SpeciesConfig) -> dict[str, float]:
    """What a species eats: factors by name."""
    return {
        each: factor
        for name, factor in species.diet.eats
        for each in (config.food if name == EVERYTHING else [name])
        if factor != 0.0
    }


def hunted(config: Settings) -> str:
    """The first species that another one eats.

    Raises:
        StopIteration: no species is eaten by another.
    """
    return next(name for name in config.species if hunters(config, name))


def hunters(config: Settings, name: str) -> tuple[str, ...]:
    """The other species that eat a species, in order."""
    return tuple(other for other, each in config.species.items() if other != name and name in diet(config, each))


def chosen(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """The types that a list of names stands for, in order; walls and obstacles are always among them."""
    every = types(config)
    return every if EVERYTHING in names else tuple(name for name in every if name in names or name in SOLID)


def look(config: Settings, name: str) -> str:
    """The type that agents see where one of this type is."""
    return (config.food[name].looks_like or name) if name in config.food else name


def seen(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """The types that a list of names stands for to rays: what looks like another type is not told apart."""
    return tuple(name for name in chosen(config, names) if look(config, name) == name)


def asked_for(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """The types that a query finds by a list of names, in order: species and kinds of food."""
    every = config.species if EVERYTHING in names else ()
    return tuple(name for name in (*config.species, *config.food) if name in names or name in every)


def smelled(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """The sources of smell that a list of names stands for, in order: species and kinds of food."""
    return tuple(name for name in (*config.species, *config.food) if name in names or EVERYTHING in names)
