"""Probability that a newborn finds a free place, sampled by placing agents and foods at random."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.arena import ArenaConfig, outline, walls
from hedon.config.schema.life import distance_sd

spatial: Any = load("scipy.spatial", suppress_warning=True)

SCENES = 12
"""Random scenes per number of agents; each is tried with every agent as a parent."""
_BATCH = 256  # maximum number of places drawn at once
_THROWS = 200  # batches; a scene too full for these stays with fewer agents

Floats = NDArray[np.float64]


def placement_success(
    config: Config, species: str, sizes: Sequence[int], rng: np.random.Generator, scenes: int = SCENES
) -> Floats:
    """Probability that a birth finds a place, for some numbers of agents, in scenes as at the start of a run.

    Agents and the initial foods are placed at random without overlap; a parent, any of them, tries as many Gaussian
    places around itself as allowed. In a run agents gather near food, and foods are fewer, so this is a guide, not a
    prediction.

    Returns:
        One probability per size, (sizes,).
    """
    return np.mean([_scene_success(config, species, sizes, rng) for _ in range(scenes)], axis=0)


def is_free(config: Config, radius: float, places: Floats, agents: Floats, foods: Floats) -> NDArray[np.bool_]:
    """Whether an agent's disc fits at each place: within the walls, clear of all agents and foods.

    Args:
        config: Settings of the world.
        radius: Radius of the disc, and of all agents [u].
        places: Centers to check [u], shape (n, 2).
        agents: Centers of the agents present [u], shape (a, 2).
        foods: Centers of the foods present [u], shape (f, 2).
    """
    free = is_within_walls(config, radius, places)
    for occupied, reach in ((agents, 2 * radius), (foods, radius + config.world.food_radius)):
        if len(occupied):
            nearest, _ = spatial.KDTree(occupied).query(places[free], distance_upper_bound=reach)
            free[free] = np.isinf(nearest)
    return free


def _scene_success(config: Config, species: str, sizes: Sequence[int], rng: np.random.Generator) -> list[float]:
    """Fills one scene, and returns the share of successful births at each size."""
    size = np.array([config.arena.width, config.arena.height])
    foods = rng.uniform(0, 1, (sum(food.initial_count for food in config.food.values()), 2)) * size
    species_config = config.species[species]
    radius, attempts, sd = (
        species_config.body.radius,
        species_config.birth.attempts,
        distance_sd(config.arena, species_config.birth),
    )
    agents, shares = np.empty((0, 2)), []
    for count in sizes:
        agents = _fill(config, radius, agents, foods, count, size, rng)
        candidates = agents[:, None] + sd * rng.normal(size=(len(agents), attempts, 2))
        free = is_free(config, radius, candidates.reshape(-1, 2), agents, foods).reshape(-1, attempts)
        shares.append(float(free.any(axis=1).mean()) if len(agents) else 0.0)
    return shares


def _fill(
    config: Config, radius: float, agents: Floats, foods: Floats, count: int, size: Floats, rng: np.random.Generator
) -> Floats:
    """Adds agents at random free places until there are `count`, or no more fit."""
    for _ in range(_THROWS):
        if len(agents) >= count:
            break
        places = rng.uniform(0, 1, (min(_BATCH, 2 * (count - len(agents))), 2)) * size
        places = places[is_free(config, radius, places, agents, foods)]
        overlaps = np.linalg.norm(places[:, None] - places[None], axis=2) < 2 * radius
        accepted = np.zeros(len(places), bool)
        for i in range(len(places)):
            accepted[i] = not (overlaps[i] & accepted).any()
        agents = np.vstack([agents, places[accepted][: count - len(agents)]])
    return agents


def is_within_walls(config: Config, radius: float, places: Floats) -> NDArray[np.bool_]:
    """Whether a disc is within the outer polygon, which is convex, and clear of all inner walls.

    Args:
        config: Settings of the world.
        radius: Radius of the disc [u].
        places: Centers to check [u], shape (n, 2).

    Returns:
        A flag per place, shape (n,).
    """
    inward, offset, segments = _walls(config.arena)
    gap = np.multiply.outer(places[:, 0], inward[0]) + np.multiply.outer(places[:, 1], inward[1]) - offset
    free = gap.min(axis=1) >= radius
    for a, wall in segments:
        share = np.clip((places - a) @ wall / max(wall @ wall, 1e-12), 0.0, 1.0)
        free &= np.linalg.norm(places - a - share[:, None] * wall, axis=1) >= radius
    return free


@cache
def _walls(arena: ArenaConfig) -> tuple[Floats, Floats, list[tuple[Floats, Floats]]]:
    """Outer walls as half planes: normals (2, walls) and offsets (walls,); start and extent of each inner wall."""
    corners = np.array(outline(arena))
    along = np.roll(corners, -1, axis=0) - corners
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    inward = np.array([along[:, 1], -along[:, 0]])  # the inside is to the right
    ends = walls(arena)[len(corners) :].astype(np.float64)
    return (
        inward,
        np.einsum("ni,in->n", corners, inward),
        [(segment[:2], segment[2:] - segment[:2]) for segment in ends],
    )
