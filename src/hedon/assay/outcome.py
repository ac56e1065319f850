"""The outcome of each founder and its descendants, from the records of a run without mutation."""

from collections.abc import Sequence

import numpy as np
import polars as pl

from hedon.analysis.agent.lifetime import durations
from hedon.analysis.descent.genealogy import genealogy, shares_of_descent

MEASURES = {
    "descendants": "living descendants at the end, the founder included; with two parents, half of each child",
    "offspring": "children of the founder",
    "food": "energy eaten per step lived, by the founder and its descendants",
    "lifespan": "steps that the founder lived, or has lived by the end",
}


def founder_outcomes(agents: pl.DataFrame, names: Sequence[str], last_step: int) -> pl.DataFrame:
    """One row per founder of one world, by agent_id.

    Args:
        agents: The world's rows of the table `agents`.
        names: Genome columns.
        last_step: Last recorded step [step].

    Returns:
        agent_id, the genes, and a column for each of `MEASURES`. Without mutation, the descendants of a founder have
        its genes if children have one parent.
    """
    rows = agents.sort("agent_id")
    tree = genealogy(rows)
    lifetimes, _ = durations(rows, last_step)
    energy_gained = rows["energy_gained"].to_numpy().astype(np.float64)
    founders = np.flatnonzero(tree.parent < 0)
    outcomes = {
        "descendants": shares_of_descent(tree, rows, tree.alive.astype(np.float64)),
        "food": shares_of_descent(tree, rows, energy_gained)
        / np.maximum(shares_of_descent(tree, rows, lifetimes), 1.0),
        "offspring": rows["children"].to_numpy().astype(np.float64),
        "lifespan": lifetimes,
    }
    measures = {name: pl.Series(outcomes[name][founders]) for name in MEASURES}
    return rows[founders].select("agent_id", *names).with_columns(**measures)
