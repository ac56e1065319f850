"""Small, crowded worlds whose species differ in diet, starvation, mating and genes."""

from pathlib import Path

from resumed_run import SMALL
from two_stores import FED

from hedon.config.config import Config
from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.manifest import Manifest

STEPS = 300
CROWDED = (
    *SMALL,
    'learning.policy="random"',
    "arena.width=160",
    "arena.height=160",
    "population.initial_count=8",
    "food.normal.growth_rate=0.5",
    "energy.initial=8",
    "energy.basic_cost=0.05",
)
SHARK = ('species.shark.diet.eats=[["shark", 0.6], ["normal", 1.0]]', "species.shark.diet.digestion_steps=20")
WORLDS = {
    "cannibals alone": SHARK,
    "cannibals that need no food": ('species.shark.diet.eats=[["shark", 0.6]]',),
    "one species that starves": ('energy.at_zero="death"',),
    "two species that leave each other alone": ("species.a.population.capacity=12", "species.b.population.capacity=12"),
    "hunters that share each prey": (
        'world.prey_sharing="each"',
        "species.prey.birth.kappa=0.1",
        'species.hunter.diet.eats=[["prey", 0.5], ["hunter", 0.5]]',
        'species.hunter.energy.at_zero="death"',
    ),
    "species that differ in everything": (
        "genome.neutral_count=4",
        "obstacle.count=2",
        "obstacle.min_side=10",
        "obstacle.max_side=10",
        "obstacle.damage=0.01",
        *FED[:-1],
        "food.poison.gives.energy=-0.6",
        "food.poison.gives.toxin=1",
        "food.normal.schedule.growth_rate={points=[[0, 1.0], [100, 0.5]], period=200}",
        "species.prey.genome.neutral_count=3",
        'species.prey.birth.mating="pairs"',
        "species.prey.birth.mating_range=100",
        "species.prey.reward.drive_reduction_coef=0.1",
        'species.hunter.diet.eats=[["prey", 0.5]]',
        'species.hunter.energy.at_zero="death"',
        "species.hunter.diet.digestion_steps=10",
        'species.hunter.learning.policy="ppo"',
        'species.hunter.birth.network="learned"',
        "species.hunter.reward.pay.see_prey.coef=0.1",
        "species.idle.diet.eats=[]",
        "species.idle.hazard.schedule.scale={points=[[0, 1.0], [100, 3.0]]}",
        "species.late.population.initial_count=0",
    ),
}


def mechanism_config(name: str) -> Config:
    """The config of one of the `WORLDS`."""
    return load_config("baseline", overrides=(*CROWDED, *WORLDS[name]))


def mechanism_run(config: Config, out: Path, steps: int = STEPS, seeds: tuple[int, ...] = (1, 2)) -> Manifest:
    """Runs a config, with frames, and checkpoints at the start and the end."""
    return run(RunPlan(config, seeds, steps, out, 1, 50, 1e9))
