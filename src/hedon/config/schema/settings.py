"""The root of a config: all settings of a run and their origin."""

from dataclasses import dataclass

from hedon.config.field import OURS, section, setting
from hedon.config.room import MAX_FOOD_KINDS, MAX_SPECIES
from hedon.config.schema.arena import ArenaConfig
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.measure import MAX_MEASURES, MeasureConfig
from hedon.config.schema.obstacle import ObstacleConfig
from hedon.config.schema.physics import PhysicsConfig
from hedon.config.schema.species import ONLY, SpeciesConfig
from hedon.config.schema.world import WorldConfig

PROVENANCE = ("name", "preset", "fidelity")
"""Fields that record where a config came from; they change no result."""


def changes_worlds(path: str) -> bool:
    """Whether a setting can change a world; a config's origin and its measures cannot."""
    return path not in PROVENANCE and not path.startswith("measure.")


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of one run. The defaults are the preset `baseline` with the fidelity `corrected`.

    Sections outside `species` describe the world. There is at least one species; the only one of a file without
    `[species]` is called `agent`.
    """

    name: str = setting("baseline", "name of the run", "", OURS)
    preset: str = setting("baseline", "preset that the config is based on", "", OURS)
    fidelity: str = setting("corrected", "fidelity that the preset was combined with", "", OURS)
    arena: ArenaConfig = section(ArenaConfig)
    physics: PhysicsConfig = section(PhysicsConfig)
    obstacle: ObstacleConfig = section(ObstacleConfig)
    food: dict[str, FoodConfig] = section(lambda: {"normal": FoodConfig()}, most=MAX_FOOD_KINDS)
    world: WorldConfig = section(WorldConfig)
    species: dict[str, SpeciesConfig] = section(lambda: {ONLY: SpeciesConfig()}, most=MAX_SPECIES)
    measure: dict[str, MeasureConfig] = section(most=MAX_MEASURES, derived=True)
