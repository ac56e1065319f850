"""The root of a config: all settings of a run, and where they came from."""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

from hedon.config.arena import ArenaConfig
from hedon.config.field import OURS, Doc, Table
from hedon.config.food import FoodConfig
from hedon.config.obstacle import ObstacleConfig
from hedon.config.physics import PhysicsConfig
from hedon.config.room import MAX_FOOD_KINDS, MAX_SPECIES
from hedon.config.species import ONLY, SpeciesConfig
from hedon.config.world import WorldConfig

PROVENANCE = ("name", "preset", "fidelity")
"""Fields that say where a config came from; they change no result."""


@dataclass(frozen=True, slots=True)
class Config:
    """One run's settings. The defaults are the preset `baseline` with the fidelity `corrected`.

    What stands beside `species` is the world. There is at least one species; the only one of a file without `[species]`
    is called `agent`.
    """

    # For the validator: no conversion between types, no unknown names, no NaN or infinity, in any section.
    __pydantic_config__: ClassVar[Any] = {"strict": True, "extra": "forbid", "allow_inf_nan": False}

    name: Annotated[
        str,
        Doc("name of the run", "", OURS),
    ] = "baseline"
    preset: Annotated[
        str,
        Doc("preset that the config is based on", "", OURS),
    ] = "baseline"
    fidelity: Annotated[
        str,
        Doc("fidelity that the preset was combined with", "", OURS),
    ] = "corrected"
    arena: ArenaConfig = field(default_factory=ArenaConfig)
    physics: PhysicsConfig = field(default_factory=PhysicsConfig)
    obstacle: ObstacleConfig = field(default_factory=ObstacleConfig)
    food: Annotated[dict[str, FoodConfig], Table(most=MAX_FOOD_KINDS)] = field(
        default_factory=lambda: {"normal": FoodConfig()}
    )
    world: WorldConfig = field(default_factory=WorldConfig)
    species: Annotated[dict[str, SpeciesConfig], Table(most=MAX_SPECIES)] = field(
        default_factory=lambda: {ONLY: SpeciesConfig()}
    )

    def with_(self, path: str, value: Any) -> "Config":
        """The same config with another value of one setting, checked.

        Args:
            path: As in a complete file, `species.prey.birth.kappa`, or as in a short one: `birth.kappa` is that of all
                species, `food.*.energy` that of all kinds of food.
            value: Of the setting's type; a table for a section.

        Raises:
            ConfigError: There is no such setting, or the value cannot be used.
        """
        from hedon.config.load import with_setting

        return with_setting(self, path, value)
