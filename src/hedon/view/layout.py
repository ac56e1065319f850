"""Describes a world in the terms of the page. No other part of the viewer depends on settings.

The page's terms are species, types that senses distinguish, foods, genes, rays and walls. The page draws and labels
everything that the description lists.
"""

from typing import Any

from hedon.config.color import OBSTACLE_COLOR, meal_colors, species_color, weight_colors
from hedon.config.config import Config
from hedon.config.expression import gene_column, kind_of, limits_of
from hedon.config.layout import Gene, SpeciesLayout, gene_columns, layouts
from hedon.config.schema.arena import walls
from hedon.config.schema.species import SpeciesConfig
from hedon.config.title import weight_title
from hedon.config.type import diet, types


def describe(config: Config) -> dict[str, Any]:
    """The layout of a world.

    Returns:
        `species`: for each its name, color, capacity, radius [u], mouth_degrees (on each side of its middle),
        mouth_center_degrees, rays (count, spread_degrees on each side of the heading, length [u]), sees (indices into
        `types`, by channel), noses (count, degrees between the heading and each of two, decay [1/u] of smell with
        distance), smells (indices into `types`, by channel), sets (numbers that genes multiply by 10^gene: place, the
        path of the setting; gene, an index into `genes`; low and high, its limits), genes (indices into `genes`, in
        genome order), laws (by gene, mean and sd of the founders; law, scale, df and probability of the noise that a
        birth adds; and the limit), mating (number of parents of a child), reward (see `_reward`), stores (name and
        capacity of each, energy first) and observed (name, unit, scale and meaning of each observation other than rays
        and touch);
        `types`: names that senses distinguish: the species, the foods, walls and, if there are any, obstacles;
        `foods`: name, radius [u], energy and color of each;
        `genes`: genes of all species, each once: name, role (as `Gene.role`), input (what it rewards, "" for none),
        title in plain words, unit and color;
        `meals`: what an agent may eat, in the order in which the engine counts it;
        `obstacle_corners`: number of corners of each obstacle, 0 without obstacles; `obstacle_color`;
        `arena`: width, height [u] and walls (ax, ay, bx, by) [u]; `window`: steps between two updates of the network;
        `energy_capacity`: largest energy of an agent; `mutation_noise`, as the setting; `founders`: whether they come
        from a table.
    """
    layouts_by_species = layouts(config)
    colors = meal_colors(config)
    foods = [
        {
            "name": name,
            "radius": config.world.food_radius,
            "energy": food.gives.get("energy", 0.0),
            "color": colors[name],
        }
        for name, food in config.food.items()
    ]
    hunting = any(name in config.species for species in config.species.values() for name in diet(config, species))
    return {
        "species": [
            _species(config, name, species, layouts_by_species[name]) for name, species in config.species.items()
        ],
        "types": list(types(config)),
        "foods": foods,
        "genes": _genes(config, layouts_by_species),
        "meals": [*config.food, *(config.species if hunting else ())],
        "obstacle_corners": config.obstacle.corners if config.obstacle.count else 0,
        "obstacle_color": OBSTACLE_COLOR,
        "arena": {
            "width": config.arena.width,
            "height": config.arena.height,
            "walls": [[float(value) for value in wall] for wall in walls(config.arena)],
        },
        "window": config.world.rollout_steps,
        "energy_capacity": max(species.energy.capacity for species in config.species.values()),
        "mutation_noise": config.world.mutation_noise,
        "founders": bool(config.world.founders),
    }


def _species(config: Config, name: str, species: SpeciesConfig, layout: SpeciesLayout) -> dict[str, Any]:
    all_types, columns = types(config), gene_columns(config)
    return {
        "name": name,
        "color": species_color(list(config.species).index(name)),
        "capacity": species.population.capacity,
        "radius": species.body.radius,
        "mouth_degrees": species.sensor.mouth_spread,
        "mouth_center_degrees": species.sensor.mouth_center,
        "rays": {
            "count": species.sensor.ray_count,
            "spread_degrees": species.sensor.ray_spread,
            "length": species.sensor.ray_length,
        },
        "sees": [all_types.index(seen) for seen in layout.sees],
        "noses": {
            "count": species.sensor.noses,
            "degrees": species.sensor.nose_angle,
            "decay": species.sensor.smell_decay,
        },
        "smells": [all_types.index(smelled) for smelled in layout.smells],
        "sets": [
            {"place": path, "gene": columns.index(gene_column(path)), "low": low, "high": high}
            for path, (low, high) in ((path, limits_of(kind_of(path))) for path in species.genome.set)
        ],
        "genes": [columns.index(gene) for gene in layout.gene_names],
        "laws": [_law(gene) for gene in layout.genes],
        "mating": species.birth.mating,
        "reward": _reward(species, layout, columns),
        "stores": [{"name": name, "capacity": store.capacity} for name, store in species.stores.items()],
        "observed": [
            {"name": channel.name, "unit": channel.unit, "scale": channel.scale, "meaning": channel.meaning}
            for channel in layout.observed
        ],
    }


def _law(gene: Gene) -> dict[str, Any]:
    mutation = gene.mutation
    return {
        "mean": gene.law.initial_mean,
        "sd": gene.law.initial_sd,
        "law": mutation.law,
        "scale": mutation.scale,
        "df": mutation.df,
        "probability": mutation.probability,
        "limit": mutation.limit,
    }


def _reward(species: SpeciesConfig, layout: SpeciesLayout, columns: tuple[str, ...]) -> dict[str, Any]:
    """The parts of a life's reward that follow from its meals and genes.

    Returns:
        `meals`: the terms that contribute meals · coef · gene, each with meal (index into the `meals` of the
        layout), gene (index into its `genes`) and coef; `rest`: the names of all other terms.
    """
    is_linear = species.reward.family == "linear" and not species.reward.rule
    terms = () if species.reward.rule else layout.terms
    meals = [term for term in terms if is_linear and term.channel.source == "meals"]
    return {
        "meals": [{"meal": term.channel.index, "gene": columns.index(term.gene), "coef": term.coef} for term in meals],
        "rest": [term.name for term in terms if term not in meals],
    }


def _genes(config: Config, layouts_by_species: dict[str, SpeciesLayout]) -> list[dict[str, str]]:
    gene_by_name: dict[str, Gene] = {gene.name: gene for layout in layouts_by_species.values() for gene in layout.genes}
    linear = {
        name: layout for name, layout in layouts_by_species.items() if config.species[name].reward.family == "linear"
    }
    eaten = {
        term.gene
        for layout in linear.values()
        for term in layout.terms
        if (term.channel.source, term.coef) == ("meals", 1)
    }
    columns = gene_columns(config)
    colors = weight_colors(columns, meal_colors(config, list(config.species)))
    return [
        {
            "name": name,
            "role": gene_by_name[name].role,
            "input": "" if gene_by_name[name].role == "neutral" else name.removeprefix("w_"),
            "title": name.replace("_", " gene ") if gene_by_name[name].role == "neutral" else weight_title(name),
            "unit": "reward per meal" if name in eaten else "",
            "color": colors[name],
        }
        for name in columns
    ]
