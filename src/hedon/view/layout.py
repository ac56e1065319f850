"""What a world consists of, in the words that the page understands: the only place of the viewer that knows settings.

The page knows species, types that senses tell apart, foods, genes, rays and walls. It draws and names whatever this
description lists.
"""

from typing import Any

from hedon.config.arena import walls
from hedon.config.config import Config
from hedon.config.layout import Gene, SpeciesLayout, diet, gene_columns, layouts, types
from hedon.config.species import SpeciesConfig


def describe(config: Config) -> dict[str, Any]:
    """The layout of a world.

    Returns:
        `species`: of each its name, capacity, radius [u], mouth_degrees (on each side of its middle),
            mouth_center_degrees, rays (count,
        spread_degrees on each side of the heading, length [u]), sees (indices into `types`, by channel), noses (count,
        degrees between the heading and each of two, decay [1/u] of smell with distance), smells (indices into `types`,
        by channel), genes (indices into `genes`, in genome order) and reward (see `_reward`);
        `types`: names that senses tell apart: the species, the foods, walls, and obstacles where there are any;
        `foods`: name, radius [u], energy and color of each;
        `genes`: of all species, each once: name, role (as `Gene.role`) and input (what it rewards, "" for none);
        `meals`: what an agent may eat, in the order in which the engine counts it;
        `obstacle_corners`: of each obstacle; 0 where there are none;
        `arena`: width, height [u] and walls (ax, ay, bx, by) [u]; `window`: steps between two times of learning;
        `energy_capacity`: most energy of an agent.
    """
    made = layouts(config)
    foods = [
        {"name": name, "radius": config.world.food_radius, "energy": food.gives.get("energy", 0.0), "color": food.color}
        for name, food in config.food.items()
    ]
    hunting = any(name in config.species for each in config.species.values() for name in diet(config, each))
    return {
        "species": [_species(config, name, each, made[name]) for name, each in config.species.items()],
        "types": list(types(config)),
        "foods": foods,
        "genes": _genes(config, made),
        "meals": [*config.food, *(config.species if hunting else ())],
        "obstacle_corners": config.obstacle.corners if config.obstacle.count else 0,
        "arena": {
            "width": config.arena.width,
            "height": config.arena.height,
            "walls": [[float(value) for value in wall] for wall in walls(config.arena)],
        },
        "window": config.world.rollout_steps,
        "energy_capacity": max(each.energy.capacity for each in config.species.values()),
    }


def _species(config: Config, name: str, species: SpeciesConfig, layout: SpeciesLayout) -> dict[str, Any]:
    every, columns = types(config), gene_columns(config)
    return {
        "name": name,
        "capacity": species.population.capacity,
        "radius": species.body.radius,
        "mouth_degrees": species.sensor.mouth_spread,
        "mouth_center_degrees": species.sensor.mouth_center,
        "rays": {
            "count": species.sensor.ray_count,
            "spread_degrees": species.sensor.ray_spread,
            "length": species.sensor.ray_length,
        },
        "sees": [every.index(seen) for seen in layout.sees],
        "noses": {
            "count": species.sensor.noses,
            "degrees": species.sensor.nose_angle,
            "decay": species.sensor.smell_decay,
        },
        "smells": [every.index(smelled) for smelled in layout.smells],
        "genes": [columns.index(gene) for gene in layout.gene_names],
        "reward": _reward(species, layout, columns),
    }


def _reward(species: SpeciesConfig, layout: SpeciesLayout, columns: tuple[str, ...]) -> dict[str, Any]:
    """What a life's reward is made of, as far as its meals and its genes tell.

    Returns:
        `meals`: the terms of which a life has had meals · coef · gene, each with meal (index into the `meals` of the
        layout), gene (index into its `genes`) and coef; `rest`: the names of all other terms.
    """
    told = species.reward.family == "linear" and not species.reward.rule
    terms = () if species.reward.rule else layout.terms
    meals = [term for term in terms if told and term.input == "food"]
    return {
        "meals": [{"meal": term.index, "gene": columns.index(term.gene), "coef": term.coef} for term in meals],
        "rest": [term.name for term in terms if term not in meals],
    }


def _genes(config: Config, made: dict[str, SpeciesLayout]) -> list[dict[str, str]]:
    known: dict[str, Gene] = {gene.name: gene for layout in made.values() for gene in layout.genes}
    return [
        {
            "name": name,
            "role": known[name].role,
            "input": "" if known[name].role == "neutral" else name.removeprefix("w_"),
        }
        for name in gene_columns(config)
    ]
