"""Indices of the shape of a world's phylogeny over time, computed with phylotrackpy."""

from importlib import import_module
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import ALIVE
from hedon.export.phylogeny import require_tree
from hedon.export.table import ExportError

INDICES = {
    "phylogenetic_diversity": ("get_phylogenetic_diversity", ()),
    "mean_pairwise_distance": ("get_mean_pairwise_distance", (False,)),
    "sackin_index": ("sackin_index", ()),
    "mean_depth": ("get_ave_depth", ()),
}
"""Columns, each with the method of phylotrackpy's `Systematics` that computes it, and its arguments."""


def index_table(agents: pl.DataFrame, now: int, points: int) -> pl.DataFrame:
    """Indices of the phylogeny of the living at evenly spaced times.

    Each agent is a taxon; edges lead from parents to children and have length 1. Ancestors are kept as long as a
    descendant is alive.

    Args:
        agents: Agents of one world and species, by agent_id, as from `pedigree`.
        now: Last step [step].
        points: Number of times.

    Returns:
        step; living; phylogenetic_diversity, the number of edges in the tree of the living (Faith 1992), in which
        families of different founders are joined by one edge each; mean_pairwise_distance, the number of edges between
        two living agents, over pairs with a common ancestor; sackin_index (Shao and Sokal 1990), which increases with
        the size and the imbalance of the tree; mean_depth, generations since the founders. Null if no agents are alive.

    Raises:
        ExportError: phylotrackpy is not installed, or children have two parents, so that there is no tree.
    """
    tree = require_tree(agents)
    try:
        systematics = import_module("phylotrackpy.systematics")
    except ImportError:
        raise ExportError("indices need phylotrackpy: pip install 'hedon[phylogeny]'") from None
    living = systematics.Systematics(lambda organism: organism)
    taxa: dict[int, Any] = {}
    times = np.unique(np.linspace(0, now, points + 1).round().astype(np.int64)[1:])
    birth_order = np.argsort(tree.birth, kind="stable")
    death_order = np.argsort(tree.death, kind="stable")
    birth_count = death_count = 0
    rows = []
    for time in times.tolist():
        # In order of time, since the dead cannot be added as parents; births precede deaths in each step.
        while True:
            birth = tree.birth[birth_order[birth_count]] if birth_count < tree.size else ALIVE
            death = tree.death[death_order[death_count]] if death_count < tree.size else ALIVE
            if min(birth, death) > time or min(birth, death) == ALIVE:
                break
            if birth <= death:
                agent = int(birth_order[birth_count])
                parent = int(tree.parent[agent])
                taxa[agent] = living.add_org(agent, taxa[parent]) if parent >= 0 else living.add_org(agent)
                birth_count += 1
            else:
                living.remove_org(taxa[int(death_order[death_count])])
                death_count += 1
        count = living.get_num_active()
        values = {
            name: getattr(living, method)(*arguments) if count else None
            for name, (method, arguments) in INDICES.items()
        }
        rows.append({"step": time, "living": count} | values)
    return pl.DataFrame(rows, schema={"step": pl.Int64, "living": pl.Int64} | dict.fromkeys(INDICES, pl.Float64))
