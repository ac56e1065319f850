"""The settings of a world as the rules read them: per species, by name, with numbers as the engine stores them."""

from copy import deepcopy
from dataclasses import fields, is_dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from reference.draw import Draws
from reference.place import Arena

from hedon.config.config import Config
from hedon.config.expression import kind_of, limits_of
from hedon.config.layout import layouts

MAX_EXPONENT = 2.0
"""Genes that are exponents stay within ± this value."""


def held(value: Any) -> Any:
    """Sections as namespaces, and numbers as the engine stores them: 32-bit floats."""
    if is_dataclass(value):
        return SimpleNamespace(**{each.name: held(getattr(value, each.name)) for each in fields(value)})
    if isinstance(value, dict):
        return {name: held(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [held(inner) for inner in value]
    return float(np.float32(value)) if isinstance(value, float) else value


class Species:
    """The sections of one species, its genes by name, and what it eats, sees, touches and smells."""

    def __init__(self, config: Config, name: str, number: int) -> None:
        own, layout = config.species[name], layouts(config)[name]
        self.name, self.number = name, number
        for section in fields(own):
            setattr(self, section.name, held(getattr(own, section.name)))
        eaten: dict[str, float] = {}
        for each, factor in own.diet.eats:
            eaten |= dict.fromkeys(config.food if each == "*" else [each], factor)
        self.eats = {each: held(float(factor)) for each, factor in eaten.items() if factor}
        self.food_energy = [
            held(self.eats.get(kind, 0.0) * held(config.food[kind].gives.get("energy", 0.0))) for kind in config.food
        ]
        self.min_force, self.max_force = (
            held(own.motor.force_scale * limit) for limit in (own.motor.min_force, own.motor.max_force)
        )
        scale = config.arena.width if own.birth.distance_unit == "arena_width" else 1.0
        self.distance_sd = held(own.birth.distance_sd * scale)
        self.stores = {"energy": self.energy, **self.store}
        every = [*config.species, *config.food, "wall", *(["obstacle"] if config.obstacle.count else [])]
        solid = ("wall", "obstacle")
        self.sees, self.touches = (
            [each for each in every if each in solid or each in names or "*" in names]
            for names in (own.sensor.sees, own.body.collides)
        )
        self.sees = [each for each in self.sees if each not in config.food or not config.food[each].looks_like]
        self.smells = [
            each for each in (*config.species, *config.food) if each in own.sensor.smells or "*" in own.sensor.smells
        ]
        self.genes = layout.gene_names
        self.laws = [self._law(config, gene) for gene in self.genes]
        self.mutations = [self._mutation(gene) for gene in self.genes]

    def __getattr__(self, section: str) -> Any:  # the sections, for the type checker
        raise AttributeError(section)

    def _law(self, config: Config, gene: str) -> Any:
        """The distribution from which founders draw a gene."""
        genome, reward, name = self.genome, self.reward, gene[2:]
        weights = {
            **{kind: food.gene for kind, food in config.food.items()},
            **dict.fromkeys(config.species, genome.prey),
            "action": genome.action,
            **{each: pay.gene for each, pay in reward.pay.items()},
        }
        if gene.startswith("neutral_"):
            return genome.neutral
        if gene.startswith("extra_"):
            return genome.extra[gene.removeprefix("extra_")]
        if gene.startswith("set_point"):
            return self.stores[gene.removeprefix("set_point").removeprefix("_") or "energy"].set_point
        if gene.startswith("g_"):
            set_by = {path.replace(".", "_"): law for path, law in genome.set.items()}
            return (genome.family | genome.learning | set_by)[name]
        return held(weights[name]) if name in weights else genome.second

    def _mutation(self, gene: str) -> SimpleNamespace:
        """How a gene mutates: as set in its own section, or else in that of the genome."""
        genome = self.genome
        common = SimpleNamespace(
            law=genome.mutation_law,
            scale=genome.mutation_scale,
            df=genome.mutation_df,
            probability=genome.mutation_probability,
            limit=genome.weight_limit,
        )
        found = SimpleNamespace(**vars(genome.mutation.get(gene, common)))
        power = gene.startswith("w_") if self.reward.family == "sinh" else gene.endswith("_scale")
        if power or gene.startswith("g_"):
            found.limit = min(found.limit, MAX_EXPONENT)
        return found

    def gene(self, genome: np.ndarray, name: str) -> float:
        return float(genome[self.genes.index(name)])

    def with_genes(self, genome: np.ndarray) -> "Species":
        """The species with the values that this genome sets."""
        own = deepcopy(self)
        for path in self.genome.set:
            name = "g_" + path.replace(".", "_")
            limit = self.mutations[self.genes.index(name)].limit
            factor = 10 ** min(max(self.gene(genome, name), -limit), limit)
            if path == "motor.force_scale":
                own.min_force, own.max_force = held(factor * own.min_force), held(factor * own.max_force)
                continue
            if path == "birth.distance_sd":
                own.distance_sd = held(factor * own.distance_sd)
                continue
            low, high = limits_of(kind_of(path))
            section, (*names, last) = own, path.split(".")
            for each in names:
                section = section[each] if isinstance(section, dict) else getattr(section, each)
            setattr(section, last, held(min(max(factor * getattr(section, last), low), high)))
        return own


class Rules:
    """The settings of a whole world, its species, and its random draws."""

    def __init__(self, config: Config, seed: int) -> None:
        self.draw = Draws(seed)
        self.arena = Arena(config, self.draw)
        self.species = [Species(config, name, i) for i, name in enumerate(config.species)]
        self.names, self.kinds = list(config.species), list(config.food)
        self.foods = [held(food) for food in config.food.values()]
        self.hunting = any(name in each.eats for each in self.species for name in self.names)
        self.obstacle = held(config.obstacle)
        self.food_radius = held(config.world.food_radius)
        self.eaten_foods_seen = config.world.eaten_food == "seen"
        agents = sum(species.population.capacity for species in self.species)
        foods = sum(food.capacity for food in self.foods)
        self.most_sources = agents + foods * (2 if self.eaten_foods_seen else 1)
        self.all_mouths = config.world.mouths == "all"
        self.eats_all_prey = config.world.prey_at_mouth == "all"
        self.prey_before_step = config.world.prey_energy == "before_step"
        self.each_gains = config.world.prey_sharing == "each"
        self.births_first = config.world.birth_order == "before_deaths"
        self.inherits_late = config.world.inheritance == "at_window_end"
        self.resident_slots_only = config.world.parents == "resident_slots"
        self.shared_heading = config.world.child_heading == "shared"
        self.mutation_noise = config.world.mutation_noise
        self.window = config.world.rollout_steps
        self.known: dict[tuple[int, bytes], Species] = {}

    def of(self, agent: Any) -> Species:
        """The species of an agent, with the values that its genome sets."""
        return self.with_genes(agent.species, agent.genome)

    def with_genes(self, number: int, genome: np.ndarray) -> Species:
        """A species with the values that this genome sets."""
        common, key = self.species[number], (number, genome.tobytes())
        if not common.genome.set:
            return common
        if key not in self.known:
            self.known[key] = common.with_genes(genome)
        return self.known[key]
