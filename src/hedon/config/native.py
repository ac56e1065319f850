"""A config in the form that the engine takes: plain dicts and lists, with layouts in place of names."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from hedon.config.config import Config
from hedon.config.food import FoodConfig
from hedon.config.layout import FAMILY_GENES, INNER_STATES, SpeciesLayout, diet, layouts, set_point_of, types
from hedon.config.learning import LearningConfig
from hedon.config.life import HazardConfig, distance_sd
from hedon.config.schedule import ScheduleConfig
from hedon.config.species import SpeciesConfig

FOOD_SCHEDULES = {"growth_rate": "growth", "capacity": "capacity"}
"""Settings of a food that may follow time, with the engine's names of them."""
HAZARD_SCHEDULE, OBSTACLE_SCHEDULE = "scale", "harmful"
PYTHON_ONLY = (
    "name",
    "preset",
    "fidelity",
    "arena.corner_radius",
    "arena.corner_chords",
    "arena.inner_walls",
    "food.color",
    "world.founders",
    "world.networks",
    "birth.distance_unit",
)
"""Settings that the engine does not get: names, colors, and what it gets as walls or as lengths in u."""


def engine_config(config: Config) -> dict[str, Any]:
    """The nested dict that the engine's structs are filled from."""
    made = layouts(config)
    return {
        "arena": {"width": config.arena.width, "height": config.arena.height},
        "physics": asdict(config.physics),
        "rules": {
            name: getattr(config.world, name)
            for name in (
                *("eaten_food", "mouths", "prey_sharing"),
                *("birth_order", "inheritance", "parents", "child_heading"),
            )
        },
        "food_radius": config.world.food_radius,
        "obstacle": asdict(config.obstacle) | {"schedule": _schedule(config.obstacle.schedule, OBSTACLE_SCHEDULE)},
        "food": [_food(food) for food in config.food.values()],
        "species": [_species(config, species, made[name]) for name, species in config.species.items()],
    }


def engine_learning(rollout_steps: int, learning: LearningConfig) -> dict[str, Any]:
    """The settings of learning as the engine takes them.

    Args:
        rollout_steps: length of a window [step].
        learning: of a species.
    """
    policy, *others = asdict(learning).items()
    return dict([policy, ("rollout_steps", rollout_steps), *others])


def _food(food: FoodConfig) -> dict[str, Any]:
    schedules = {f"{name}_schedule": _schedule(food.schedule, each) for each, name in FOOD_SCHEDULES.items()}
    return _without(asdict(food), "color", "gene", "schedule") | schedules


def _schedule(schedules: Mapping[str, ScheduleConfig], name: str) -> dict[str, Any]:
    schedule = schedules.get(name, ScheduleConfig())
    points = [{"step": step, "factor": factor} for step, factor in schedule.points]
    return {"form": schedule.form, "period": schedule.period, "points": points}


def _species(config: Config, species: SpeciesConfig, layout: SpeciesLayout) -> dict[str, Any]:
    number = {name: i for i, name in enumerate(types(config))}
    sensor = asdict(species.sensor)
    sensor["sees"] = [number[name] for name in layout.sees]
    sensor["smells"] = [number[name] for name in layout.smells]
    sensor["collides"] = [number[name] for name in layout.touches]
    eaten, sd = diet(config, species), distance_sd(config.arena, species.birth)
    birth = _without(asdict(species.birth), "distance_unit")
    return {
        "body": {"radius": species.body.radius, "density": species.body.density},
        "motor": {
            "min_force": species.motor.force_scale * species.motor.min_force,
            "max_force": species.motor.force_scale * species.motor.max_force,
            "angle": species.motor.angle,
        },
        "sensor": sensor,
        "population": asdict(species.population),
        "diet": {
            "food": [eaten.get(kind, 0.0) for kind in config.food],
            "prey": [eaten.get(name, 0.0) for name in config.species],
            "digestion_steps": species.diet.digestion_steps,
        },
        "energy": asdict(species.energy),
        **{state: _inner(species, layout, state) for state in INNER_STATES if state != "energy"},
        "hazard": _hazard(species.hazard),
        "birth": birth | {"rule": _ruled(species.birth.rule), "distance_sd": (sd, sd)},
        "genome": {"mutation_noise": config.world.mutation_noise} | _genome(species, layout),
        "reward": _reward(species, layout),
        "learning": engine_learning(config.world.rollout_steps, species.learning),
    }


def _hazard(hazard: HazardConfig) -> dict[str, Any]:
    return asdict(hazard) | {"rule": _ruled(hazard.rule), "schedule": _schedule(hazard.schedule, HAZARD_SCHEDULE)}


def _inner(species: SpeciesConfig, layout: SpeciesLayout, state: str) -> dict[str, Any]:
    own, present = getattr(species, state), state in layout.inner
    return asdict(own) | {"present": int(present), "observed": int(present and own.observed)}


def _genome(species: SpeciesConfig, layout: SpeciesLayout) -> dict[str, Any]:
    return {
        "genes": [
            {
                "initial_mean": gene.law.initial_mean,
                "initial_sd": gene.law.initial_sd,
                "mutation_law": gene.mutation.law,
                "mutation_scale": gene.mutation.scale,
                "mutation_df": gene.mutation.df,
                "mutation_probability": gene.mutation.probability,
                "limit": gene.mutation.limit,
            }
            for gene in layout.genes
        ],
        "learning": [{"sets": name, "gene": layout.gene_names.index(f"g_{name}")} for name in species.genome.learning],
    }


def _reward(species: SpeciesConfig, layout: SpeciesLayout) -> dict[str, Any]:
    place = {name: i for i, name in enumerate(layout.gene_names)}
    terms = [
        {
            "input": term.input,
            "index": term.index,
            "gene": place[term.gene],
            "second_gene": place[term.second_gene],
            "coef": term.coef,
        }
        for term in layout.terms
    ]
    reward = species.reward
    return {
        "action_norm": reward.action_norm,
        "family": reward.family,
        "threshold": reward.threshold,
        "threshold_width": reward.threshold_width,
        "rule": _ruled(reward.rule),
        **{f"{name}_gene": place.get(f"g_{name}", -1) for name in FAMILY_GENES},
        "memory": reward.memory,
        "set_points": [place.get(set_point_of(state), -1) for state in INNER_STATES],
        "terms": terms,
    }


def _ruled(place: str) -> int:
    return int(bool(place))


def _without(table: dict[str, Any], *names: str) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key not in names}
