"""Places of food: draws from the law of a kind, and the number of foods that fit there at once."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.food import FoodConfig
from hedon.demography.placement import is_within_walls

spatial: Any = load("scipy.spatial", suppress_warning=True)  # takes a fifth of a second to import

TRIES = 20_000
"""Places that the engine tries for each founder and each food of a new world (`world/population.h`)."""
SCENES = 4
"""Number of times that a kind's places are filled to estimate how many there are."""
_BATCH = 512  # places drawn at once
_SAMPLE = 512  # maximum number of places kept
_PARTS = 16  # intervals of a forecast; a drifting center is fixed within each

Floats = NDArray[np.float64]


def draw_food_places(
    config: Config, food: FoodConfig, count: int, step: float, rng: np.random.Generator, turn: int = 0
) -> Floats:
    """Draws places as the engine does for new food; some may be outside the arena.

    Args:
        config: Settings of the world, for the arena.
        food: Settings of the kind, with its law.
        count: Number of places.
        step: Step at which the food appears, for drifting centers [step].
        rng: Random number generator.
        turn: Index of the center to use, if centers take turns.

    Returns:
        Centers [u], shape (count, 2).
    """
    law, size = food.placement, np.array([config.arena.width, config.arena.height])
    if law.form == "uniform":
        return rng.random((count, 2)) * size
    center = rng.integers(len(law.centers), size=count) if law.form == "mixture" else np.full(count, turn)
    middle = np.array(law.centers)[center] + step * np.array(law.drift)
    offsets = rng.uniform(-1, 1, (count, 2)) if law.form == "rectangle" else rng.normal(size=(count, 2))
    return np.clip(middle, 0.0, size) + np.array(law.sd) * offsets


def throw(
    draw: Callable[[int], Floats],
    free: Callable[[Floats], NDArray[np.bool_]],
    reach: float,
    count: int,
    *,
    tries: int = TRIES,
    budget: float = np.inf,
) -> Floats:
    """Puts things one after another at the first free place drawn.

    Args:
        draw: Function that draws n places, (n, 2).
        free: Function that flags the places that are otherwise free, (n,).
        reach: Minimum distance between two of the things [u].
        count: Number of things.
        tries: Number of places tried for each; if none is free, the rest is given up.
        budget: Number of places tried for all of them.

    Returns:
        Centers of those that found a place [u], (found, 2).
    """
    placed, attempts, misses = np.empty((0, 2)), 0, 0
    while len(placed) < count and misses < tries and attempts < budget:
        places = draw(_BATCH)
        open_places = free(places)
        if len(placed):
            open_places &= spatial.KDTree(placed).query(places)[0] >= reach
        indices = np.flatnonzero(open_places)
        overlaps = np.hypot(*np.moveaxis(places[indices, None] - places[indices], 2, 0)) < reach
        accepted = np.zeros(len(indices), bool)
        for i in range(len(indices)):
            accepted[i] = not (overlaps[i] & accepted).any()
        chosen = indices[accepted][: count - len(placed)]
        placed = np.vstack([placed, places[chosen]])
        attempts += _BATCH
        misses = _BATCH - 1 - int(chosen[-1]) if len(chosen) else misses + _BATCH
    return placed


@dataclass(frozen=True)
class FoodPlaces:
    """The places of one kind of food in the absence of agents.

    Attributes:
        limit: Number of foods that find a place during a forecast if none is eaten, at most the capacity of the kind;
            around one center, if centers take turns.
        share: Share of the drawn places that are within the arena.
        sample: Some of the places [u], (places, 2).
        scene: Places occupied at the same time [u], (foods, 2).
    """

    limit: float
    share: float
    sample: Floats
    scene: Floats


def food_places(config: Config, food: FoodConfig, steps: int, rng: np.random.Generator) -> FoodPlaces:
    """Estimates how many foods of a kind fit where its law puts them, by placing them.

    Args:
        config: Settings of the world, for the arena and sizes.
        food: Settings of the kind.
        steps: Time for which the engine tries [step].
        rng: Random number generator.
    """
    turns = len(food.placement.centers) if food.placement.form == "switching" else 1
    scenes = [_fill(config, food, steps, rng, scene % turns) for scene in range(SCENES)]
    draws = np.vstack(
        [draw_food_places(config, food, 1024, scene / SCENES * steps, rng, scene % turns) for scene in range(SCENES)]
    )
    sample = np.vstack(scenes)
    return FoodPlaces(
        limit=float(np.mean([len(foods) for foods in scenes])),
        share=float(is_within_walls(config, config.world.food_radius, draws).mean()),
        sample=sample[rng.permutation(len(sample))[:_SAMPLE]],
        scene=scenes[0],
    )


def _fill(config: Config, food: FoodConfig, steps: int, rng: np.random.Generator, turn: int) -> Floats:
    """Places of foods that grow and are not eaten; a drifting center leaves them behind."""
    radius, moves = config.world.food_radius, any(food.placement.drift)
    reach = max(2 * radius, food.placement.spacing)
    stages = _PARTS if moves else 1
    budget = max(min(food.candidates * steps, TRIES) // stages, 1)
    placed = np.empty((0, 2))
    for stage in range(stages):
        food_count = food.initial_count + food.growth_rate * steps * (stage + 1) / stages
        tree = spatial.KDTree(placed) if len(placed) else None

        def free(places: Floats, tree: Any = tree) -> NDArray[np.bool_]:
            is_clear = is_within_walls(config, radius, places)
            return is_clear if tree is None else is_clear & (tree.query(places)[0] >= reach)

        added = throw(
            lambda count, stage=stage: draw_food_places(config, food, count, steps * stage / stages, rng, turn),
            free,
            reach,
            (min(food.capacity, int(food_count)) if moves else food.capacity) - len(placed),
            tries=budget,
            budget=budget,
        )
        placed = np.vstack([placed, added])
    return placed


def missing_at_start(config: Config, rng: np.random.Generator) -> str:
    """Description of what finds no place in a new world; empty if all founders and initial foods fit."""
    size = np.array([config.arena.width, config.arena.height])
    bodies, radii = np.empty((0, 2)), np.empty(0)

    def free(radius: float) -> Callable[[Floats], NDArray[np.bool_]]:
        def of(places: Floats) -> NDArray[np.bool_]:
            is_clear = is_within_walls(config, radius, places)
            for other_radius in np.unique(radii):
                is_clear &= spatial.KDTree(bodies[radii == other_radius]).query(places)[0] >= radius + other_radius
            return is_clear

        return of

    crowd = [
        (f"founders of {name}", species.population.initial_count, species.body.radius, 0.0, None)
        for name, species in config.species.items()
    ]
    foods = [
        (f"foods of the kind {name}", food.initial_count, config.world.food_radius, food.placement.spacing, food)
        for name, food in config.food.items()
    ]
    for label, count, radius, spacing, food in (*crowd, *foods):
        placed = throw(
            lambda n, food=food: (
                rng.random((n, 2)) * size if food is None else draw_food_places(config, food, n, 0, rng)
            ),
            free(radius),
            max(2 * radius, spacing),
            count,
        )
        if len(placed) < count:
            return f"{len(placed):,} of {count:,} {label} find a place"
        bodies, radii = np.vstack([bodies, placed]), np.append(radii, np.full(count, radius))
    return ""
