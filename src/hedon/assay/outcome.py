"""What became of each founder and its descendants, from the records of a run without mutation."""

from collections.abc import Sequence

import numpy as np
import polars as pl

from hedon.analysis.agent.lifetime import durations
from hedon.analysis.descent.genealogy import founder, genealogy

MEASURES = {
    "descendants": "living descendants at the end, the founder included",
    "offspring": "children of the founder",
    "food": "energy eaten per step lived, by the founder and its descendants",
    "lifespan": "steps that the founder lived, or has lived by the end",
}


def founder_outcomes(agents: pl.DataFrame, names: Sequence[str], last_step: int) -> pl.DataFrame:
    """One row per founder of one world, by agent_id.

    Args:
        agents: the world's rows of the table `agents`.
        names: genome columns.
        last_step: up to which the records reach [step].

    Returns:
        agent_id, the genes, and a column for each of `MEASURES`. Without mutation the descendants of a founder have its
        genes.
    """
    rows = agents.sort("agent_id")
    tree = genealogy(rows)
    line = founder(tree)
    lived, _ = durations(rows, last_step)
    gained = rows["energy_gained"].to_numpy().astype(np.float64)
    first = np.flatnonzero(tree.parent < 0)
    of_line = {
        "descendants": np.bincount(line, tree.alive, tree.size),
        "food": np.bincount(line, gained, tree.size) / np.maximum(np.bincount(line, lived, tree.size), 1.0),
        "offspring": rows["children"].to_numpy().astype(np.float64),
        "lifespan": lived,
    }
    measures = {name: pl.Series(of_line[name][first]) for name in MEASURES}
    return rows[first].select("agent_id", *names).with_columns(**measures)
