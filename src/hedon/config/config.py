"""The root of a config: all settings of a run, and where they came from."""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

from hedon.config.arena import ArenaConfig
from hedon.config.body import BodyConfig, MotorConfig, SensorConfig
from hedon.config.energy import EnergyConfig
from hedon.config.evolution import GenomeConfig, RewardConfig
from hedon.config.field import OURS, Doc
from hedon.config.food import FoodConfig
from hedon.config.inner import NutrientConfig, ToxinConfig
from hedon.config.learning import LearningConfig
from hedon.config.life import BirthConfig, HazardConfig
from hedon.config.obstacle import ObstacleConfig
from hedon.config.physics import PhysicsConfig
from hedon.config.population import PopulationConfig
from hedon.config.species import ONLY, PER_SPECIES, DietConfig, SpeciesConfig

PROVENANCE = ("name", "preset", "fidelity")
"""Fields that say where a config came from; they change no result."""


@dataclass(frozen=True, slots=True)
class Config:
    """One run's settings. The defaults are the preset `baseline` with the fidelity `corrected`."""

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
    body: BodyConfig = field(default_factory=BodyConfig)
    motor: MotorConfig = field(default_factory=MotorConfig)
    sensor: SensorConfig = field(default_factory=SensorConfig)
    population: PopulationConfig = field(default_factory=PopulationConfig)
    diet: DietConfig = field(default_factory=DietConfig)
    obstacle: ObstacleConfig = field(default_factory=ObstacleConfig)
    food: dict[str, FoodConfig] = field(default_factory=lambda: {"normal": FoodConfig()})
    energy: EnergyConfig = field(default_factory=EnergyConfig)
    nutrient: NutrientConfig = field(default_factory=NutrientConfig)
    toxin: ToxinConfig = field(default_factory=ToxinConfig)
    hazard: HazardConfig = field(default_factory=HazardConfig)
    birth: BirthConfig = field(default_factory=BirthConfig)
    genome: GenomeConfig = field(default_factory=GenomeConfig)
    reward: RewardConfig = field(default_factory=RewardConfig)
    learning: LearningConfig = field(default_factory=LearningConfig)
    species: dict[str, SpeciesConfig] = field(default_factory=dict)

    @property
    def agents(self) -> dict[str, SpeciesConfig]:
        """Every species by name, in order; without `[species]` there is one, which the config's sections describe."""
        if self.species:
            return self.species
        return {ONLY: SpeciesConfig(**{name: getattr(self, name) for name in PER_SPECIES})}
