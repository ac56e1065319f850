"""How often an agent that has learned nothing encounters places of food."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from lazy_loader import load
from numpy.typing import NDArray

from hedon.config import Config
from hedon.config.schema.species import SpeciesConfig
from hedon.demography.food_place import throw
from hedon.demography.motion import unlearned_walk
from hedon.demography.placement import is_within_walls

spatial: Any = load("scipy.spatial", suppress_warning=True)  # takes a fifth of a second to import

BINS = 16
"""Number of intervals of the time since birth; rates are means within each."""
_WALKERS = 512
_STRIDE = 4  # steps between two checks for touches: an agent moves less than a unit of length in a step
_PAUSE = 64  # touches within this time after another belong to the same visit [step]

Floats = NDArray[np.float64]


def encounter_rates(
    config: Config, species_config: SpeciesConfig, places: Sequence[Floats], steps: int, rng: np.random.Generator
) -> Floats:
    """Visits of an agent's mouth to a place of food, by the time since the agent was born.

    Agents start at uniformly distributed places and walk as in `hedon.demography.motion`. A mouth visits a place when
    it touches it, and visits it again after it has been away.

    Args:
        config: Settings of the world.
        species_config: Settings of the species.
        places: Centers of places [u], (places, 2) for each kind of food.
        steps: Length of the walk [step].
        rng: Random number generator for the walks.

    Returns:
        Visits per agent, place and step, (kinds, BINS), over equal parts of the time; 0 for a kind without places.
    """
    counts, size = [len(points) for points in places], np.array([config.arena.width, config.arena.height])
    start = throw(
        lambda count: rng.random((count, 2)) * size,
        lambda positions: is_within_walls(config, species_config.body.radius, positions),
        0.0,
        _WALKERS,
    )
    visits = np.zeros((len(places), BINS))
    if not len(start) or not sum(counts):
        return visits
    kind, sites = np.repeat(np.arange(len(places)), counts), np.vstack(places)
    tree, reach = spatial.KDTree(sites), species_config.body.radius + config.world.food_radius
    # When an agent last touched a place that it had visited.
    last_touch = np.full((len(start), len(sites)), -_PAUSE - 1)
    middle = np.exp(1j * math.radians(species_config.sensor.mouth_center))
    edge = (
        math.cos(math.radians(species_config.sensor.mouth_spread)) if species_config.sensor.mouth_spread < 180 else -2.0
    )
    walk = unlearned_walk(config, species_config, start[:, 0] + 1j * start[:, 1], steps, rng)
    for step, (place, heading) in enumerate(walk, start=1):
        if step % _STRIDE:
            continue
        walkers = spatial.KDTree(np.column_stack([place.real, place.imag]))
        near = walkers.sparse_distance_matrix(tree, reach, output_type="ndarray")  # far faster than a list per agent
        agent, site = near["i"], near["j"]
        toward = sites[site] @ [1, 1j] - place[agent]
        ahead = (toward * (heading[agent] * middle).conj()).real
        touches = ahead >= edge * np.abs(toward)
        elapsed = step - last_touch[agent, site]
        is_visit = touches & (elapsed > _PAUSE) & (step > _STRIDE)  # nothing grows under an agent
        visits[:, (step - 1) * BINS // steps] += np.bincount(kind[site[is_visit]], minlength=len(places))
        is_near = touches | (elapsed <= _PAUSE) | (step == _STRIDE)
        last_touch[agent[is_near], site[is_near]] = step
    return visits / (len(start) * np.maximum(counts, 1)[:, None] * (steps / BINS))


def gaps(config: Config, species_config: SpeciesConfig, scene: Floats) -> float:
    """Number of neighbors per food at a distance at which a body gets stuck between the two, out of its mouth's reach.

    Food is solid. Two pieces stop a body that meets both at once. Its mouth reaches neither if they are further apart
    than the mouth is wide, and the body does not pass between them if they are closer than its own width.

    Args:
        config: Settings of the world, for the size of food.
        species_config: Settings of the species.
        scene: Places occupied at the same time [u], (foods, 2).
    """
    if len(scene) < 2:
        return 0.0
    body_spacing = 2.0 * (species_config.body.radius + config.world.food_radius)
    mouth_spacing = body_spacing * math.sin(math.radians(min(species_config.sensor.mouth_spread, 90.0)))
    tree = spatial.KDTree(scene)
    return float(tree.count_neighbors(tree, body_spacing) - tree.count_neighbors(tree, mouth_spacing)) / len(scene)
