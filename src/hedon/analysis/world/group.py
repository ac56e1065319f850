"""Do agents of a species keep together, and how far are they from those that eat them? By frames, against chance.

A *group* is a set of agents of one species whose centers hang together by distances of at most `REACH`. The size that
counts is that of the group in which an agent is, itself included, so that large groups weigh as much as the agents in
them. The same number of agents placed evenly over the arena by chance tells what crowding alone would do.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
from lazy_loader import load
from numpy.typing import NDArray

from hedon.analysis.world.record import WorldRecord, generator

sparse: Any = load("scipy.sparse", suppress_warning=True)  # these take a fifth of a second to load
csgraph: Any = load("scipy.sparse.csgraph", suppress_warning=True)
spatial: Any = load("scipy.spatial", suppress_warning=True)

REACH = 30.0
"""Distance of two centers within a group [u]: three radii of the paper's agents. Our choice: at 40 u even agents
that are placed by chance hang together in groups of dozens where the sequel's arena is full."""
MOST = 400
"""Most frames of a world that are read, evenly over its time: neighbors in time are alike."""


def group_sizes(places: NDArray[np.float64], reach: float = REACH) -> NDArray[np.int64]:
    """The size of the group of each agent, itself included, (agents,).

    Args:
        places: of the agents [u], (agents, 2).
        reach: largest distance of two neighbors in a group [u].
    """
    count = len(places)
    pairs = spatial.KDTree(places).query_pairs(reach, output_type="ndarray")
    links = sparse.coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    member = csgraph.connected_components(links, directed=False)[1]
    return np.bincount(member)[member]


def nearest(places: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of each agent to the nearest of some others [u], (agents,).

    Args:
        places: of the agents [u], (agents, 2).
        others: of the others [u], (others, 2); at least one.
    """
    return spatial.KDTree(others).query(places)[0]


def company(world: WorldRecord, frames: pl.LazyFrame, hunters: Sequence[str]) -> pl.DataFrame:
    """How the agents of a world keep company, frame by frame.

    Args:
        world: of the species that is asked.
        frames: table `frames` of that world.
        hunters: names of the species that eat it.

    Returns:
        By step: alive; group, the mean size of an agent's group; group_chance, the same by chance; distance, the mean
        to the nearest hunter [u], null while there is none; distance_chance, the same if the agents were placed by
        chance and the hunters where they are.
    """
    steps = frames.select(pl.col("step").unique().sort()).collect()["step"].to_numpy()
    shown = steps[np.unique(np.linspace(0, len(steps) - 1, min(len(steps), MOST)).astype(int))] if len(steps) else steps
    names = [world.species, *hunters]
    table = frames.filter(pl.col("step").is_in(shown.tolist()) & pl.col("kind").is_in(names))
    draw, arena = generator(world), world.config.arena
    rows = []
    for moment in table.collect().sort("step", "kind", "id").partition_by("step"):
        mine = moment.filter(pl.col("kind") == world.species).select("x", "y").to_numpy().astype(np.float64)
        others = moment.filter(pl.col("kind") != world.species).select("x", "y").to_numpy().astype(np.float64)
        if not len(mine):
            continue
        chance = draw.uniform((0, 0), (arena.width, arena.height), (len(mine), 2))
        row = {"step": moment["step"][0], "alive": len(mine)}
        row |= {"group": group_sizes(mine).mean(), "group_chance": group_sizes(chance).mean()}
        known = len(others) > 0
        row["distance"] = nearest(mine, others).mean() if known else None
        row["distance_chance"] = nearest(chance, others).mean() if known else None
        rows.append(row)
    floats = ("group", "group_chance", "distance", "distance_chance")
    schema = {"step": pl.Int64, "alive": pl.Int64} | dict.fromkeys(floats, pl.Float64)
    return pl.DataFrame(rows, schema=schema)
