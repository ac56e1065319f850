"""The definition of a case: a short, lively world, and what must happen in it."""

from dataclasses import dataclass, field

from hedon.config.config import Config
from hedon.config.load import load_config

LIVELY = (
    *("world.rollout_steps=32", "learning.minibatch_size=16", "learning.update_epochs=1"),
    *("arena.width=240", "arena.height=200", "population.capacity=30", "population.initial_count=20"),
    *("energy.initial=3", "energy.basic_cost=0.02", "energy.action_cost=4e-5", "birth.kappa=0.05"),
    *("hazard.kappa=0.4", "hazard.alpha_age=2e-4", "hazard.beta_age=0.01"),
    *("motor.max_force=640", "motor.min_force=-80", "physics.max_speed=40"),
    *('food."*".gene.initial_mean=1', "genome.mutation_scale=0.5", "genome.neutral_count=2"),
    *('food."*".growth_rate=1.7', 'food."*".capacity=30', 'food."*".initial_count=10'),
)
"""Many births and deaths within a hundred steps."""


@dataclass(frozen=True)
class Case:
    """A world for one or more mechanisms, and the least number of times that each event must happen in it."""

    mechanism: str
    settings: tuple[str, ...] = ()
    happens: dict[str, float] = field(default_factory=dict)
    preset: str = "baseline"
    fidelity: str | None = None
    steps: int = 70

    @property
    def config(self) -> Config:
        return load_config(self.preset, self.fidelity, (*LIVELY, *self.settings))


def each(species: str, *settings: str) -> tuple[str, ...]:
    """Settings of one species."""
    return tuple(f"species.{species}.{setting}" for setting in settings)


def kind(name: str, form: str, centers: str, sd: str, *more: str) -> tuple[str, ...]:
    """A kind of food with its own placement."""
    place = (f'form="{form}"', f"centers={centers}", f"sd={sd}", *more)
    own = ("gives.energy=0.4", "growth_rate=0.8", "capacity=12", "initial_count=4")
    return tuple(f"food.{name}.{setting}" for setting in (*own, *(f"placement.{each}" for each in place)))
