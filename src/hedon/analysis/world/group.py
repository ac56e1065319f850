"""Whether agents of a species stay together, and how far they are from their predators, compared with chance.

A *group* is a set of agents of one species whose centers are linked by distances of at most `REACH`. The measure is the
size of an agent's own group, itself included, averaged over agents, so large groups weigh as much as the agents in
them. The same number of agents placed at random over the arena shows the effect of crowding alone. Positions come from
frames.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
from lazy_loader import load
from numpy.typing import NDArray

from hedon.analysis.world.record import WorldRecord, generator

sparse: Any = load("scipy.sparse", suppress_warning=True)  # imported late: these take a fifth of a second to load
spatial: Any = load("scipy.spatial", suppress_warning=True)

REACH = 30.0
"""Maximum distance between neighboring centers in a group [u]: three radii of the paper's agents. Our choice: at 40 u,
even agents placed at random form groups of dozens when the sequel's arena is full."""
MOST = 400
"""Maximum number of frames read per world, evenly spaced in time, since successive frames are alike."""


def group_sizes(places: NDArray[np.float64], reach: float = REACH) -> NDArray[np.int64]:
    """Size of each agent's group, itself included, (agents,).

    Args:
        places: Positions of the agents [u], (agents, 2).
        reach: Maximum distance between neighbors in a group [u].
    """
    count = len(places)
    pairs = spatial.KDTree(places).query_pairs(reach, output_type="ndarray")
    links = sparse.coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    member = sparse.csgraph.connected_components(links, directed=False)[1]
    return np.bincount(member)[member]


def nearest(places: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of each agent to the nearest of some others [u], (agents,).

    Args:
        places: Positions of the agents [u], (agents, 2).
        others: Positions of the others [u], (others, 2); at least one.
    """
    return spatial.KDTree(others).query(places)[0]


def company(world: WorldRecord, frames: pl.LazyFrame, hunters: Sequence[str]) -> pl.DataFrame:
    """Grouping of a world's agents, frame by frame.

    Args:
        world: Records of the species to measure.
        frames: Table `frames` of that world.
        hunters: Names of the species that eat it.

    Returns:
        By step: alive; group, the mean size of an agent's group; group_chance, the same for random positions; distance,
        the mean to the nearest hunter [u], null without hunters; distance_chance, the same for random positions of the
        agents and actual positions of the hunters.
    """
    steps = frames.select(pl.col("step").unique().sort()).collect()["step"].to_numpy()
    sampled_steps = (
        steps[np.unique(np.linspace(0, len(steps) - 1, min(len(steps), MOST)).astype(int))] if len(steps) else steps
    )
    names = [world.species, *hunters]
    table = frames.filter(pl.col("step").is_in(sampled_steps.tolist()) & pl.col("kind").is_in(names))
    rng, arena = generator(world), world.config.arena
    rows = []
    for moment in table.collect().sort("step", "kind", "id").partition_by("step"):
        positions = moment.filter(pl.col("kind") == world.species).select("x", "y").to_numpy().astype(np.float64)
        hunter_positions = moment.filter(pl.col("kind") != world.species).select("x", "y").to_numpy().astype(np.float64)
        if not len(positions):
            continue
        random_positions = rng.uniform((0, 0), (arena.width, arena.height), (len(positions), 2))
        row = {"step": moment["step"][0], "alive": len(positions)}
        row |= {"group": group_sizes(positions).mean(), "group_chance": group_sizes(random_positions).mean()}
        has_hunters = len(hunter_positions) > 0
        row["distance"] = nearest(positions, hunter_positions).mean() if has_hunters else None
        row["distance_chance"] = nearest(random_positions, hunter_positions).mean() if has_hunters else None
        rows.append(row)
    floats = ("group", "group_chance", "distance", "distance_chance")
    schema = {"step": pl.Int64, "alive": pl.Int64} | dict.fromkeys(floats, pl.Float64)
    return pl.DataFrame(rows, schema=schema)
