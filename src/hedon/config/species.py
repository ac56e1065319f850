"""Species: everything that makes a kind of agent."""

from dataclasses import dataclass, field, fields
from typing import Annotated

from hedon.config.body import BodyConfig, MotorConfig, SensorConfig
from hedon.config.energy import EnergyConfig
from hedon.config.evolution import GenomeConfig, RewardConfig
from hedon.config.field import DERIVED, OURS, Doc, Range
from hedon.config.inner import NutrientConfig, ToxinConfig
from hedon.config.learning import LearningConfig
from hedon.config.life import BirthConfig, HazardConfig
from hedon.config.population import PopulationConfig

ONLY = "agent"
"""The name of the species of a file without `[species]`."""
EVERYTHING = "*"
"""In a list of names, what stands for all of them."""


@dataclass(frozen=True, slots=True)
class DietConfig:
    """What a species eats."""

    eats: Annotated[
        tuple[tuple[str, float], ...],
        Doc(
            "kinds of food, each with a factor on its energy, and species, each with the share of its energy that is "
            'gained; "*" for every kind of food. What is not named is touched, but not eaten',
            "",
            OURS,
            Range(max_items=12, each=(-1e4, 1e4)),
        ),
    ] = ((EVERYTHING, 1.0),)
    digestion_steps: Annotated[
        int,
        Doc("after eating an agent, for how long no other is eaten", "step", OURS, Range(ge=0, le=1_000_000)),
    ] = 0


@dataclass(frozen=True, slots=True)
class SpeciesConfig:
    """What describes one species. In a file, `[species.NAME.energy]` has what differs from `[energy]`, and so on."""

    body: BodyConfig = field(default_factory=BodyConfig)
    motor: MotorConfig = field(default_factory=MotorConfig)
    sensor: SensorConfig = field(default_factory=SensorConfig)
    population: PopulationConfig = field(default_factory=PopulationConfig)
    diet: DietConfig = field(default_factory=DietConfig)
    energy: EnergyConfig = field(default_factory=EnergyConfig)
    nutrient: NutrientConfig = field(default_factory=NutrientConfig)
    toxin: ToxinConfig = field(default_factory=ToxinConfig)
    hazard: HazardConfig = field(default_factory=HazardConfig)
    birth: BirthConfig = field(default_factory=BirthConfig)
    genome: Annotated[GenomeConfig, DERIVED] = field(default_factory=GenomeConfig)
    reward: RewardConfig = field(default_factory=RewardConfig)
    learning: LearningConfig = field(default_factory=LearningConfig)


PER_SPECIES = tuple(each.name for each in fields(SpeciesConfig))
"""The sections of a species. At the top of a file they are defaults for all its species."""
RULE_USES = ("reward", "hazard", "birth")
"""The sections of a species that may have a rule in Python."""
