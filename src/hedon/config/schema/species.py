"""Species: all settings of a kind of agent."""

import re
from dataclasses import dataclass, fields

from hedon.config.field import OURS, section, setting
from hedon.config.room import MAX_QUERIES, MAX_STORES
from hedon.config.schema.body import BodyConfig, MotorConfig, SensorConfig
from hedon.config.schema.evolution import GenomeConfig, RewardConfig
from hedon.config.schema.learning import LearningConfig
from hedon.config.schema.life import BirthConfig, HazardConfig
from hedon.config.schema.neighbor import NeighborConfig
from hedon.config.schema.population import PopulationConfig
from hedon.config.schema.store import ENERGY, EnergyConfig, StoreConfig

ONLY = "agent"
"""Name of the species of a file without `[species]`."""
EVERYTHING = "*"
"""Stands for all names in a list of names."""


@dataclass(frozen=True, slots=True)
class DietConfig:
    """Foods and species that a species eats."""

    eats: tuple[tuple[str, float], ...] = setting(
        ((EVERYTHING, 1.0),),
        "kinds of food, each with a factor on its energy, and species, each with the share of its energy that is "
        'gained; "*" for every kind of food. What is not named is touched, but not eaten',
        "",
        OURS,
        max_items=12,
        each=(-1e4, 1e4),
    )
    digestion_steps: int = setting(
        0, "after eating an agent, for how long no other is eaten", "step", OURS, ge=0, le=1_000_000
    )


@dataclass(frozen=True, slots=True)
class SpeciesConfig:
    """Settings of one species. In a file, `[species.NAME.energy]` overrides settings of `[energy]`, and so on."""

    body: BodyConfig = section(BodyConfig)
    motor: MotorConfig = section(MotorConfig)
    sensor: SensorConfig = section(SensorConfig)
    population: PopulationConfig = section(PopulationConfig)
    diet: DietConfig = section(DietConfig)
    energy: EnergyConfig = section(EnergyConfig)
    store: dict[str, StoreConfig] = section(most=MAX_STORES - 1)
    neighbor: dict[str, NeighborConfig] = section(most=MAX_QUERIES, derived=True)
    hazard: HazardConfig = section(HazardConfig)
    birth: BirthConfig = section(BirthConfig)
    genome: GenomeConfig = section(GenomeConfig, derived=True)
    reward: RewardConfig = section(RewardConfig)
    learning: LearningConfig = section(LearningConfig)

    @property
    def stores(self) -> dict[str, StoreConfig]:
        """All stores by name: energy first, then the others in their order."""
        return {ENERGY: self.energy, **self.store}


PER_SPECIES = tuple(each.name for each in fields(SpeciesConfig))
"""Sections of a species. At the top level of a file they are the defaults of all species."""
RULE_USES = ("reward", "hazard", "birth")
"""Sections of a species that may have a rule in Python."""


def default_path(path: str) -> str:
    """Path at the top level of a file that applies to all species: `birth.kappa` for `species.prey.birth.kappa`."""
    return re.sub(r"^species\.[^.]+\.", "", path)
