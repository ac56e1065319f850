"""Exports the pedigree of a world as a tree sequence, for tskit and compatible tools."""

from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import ALIVE
from hedon.export.phylogeny import require_tree
from hedon.export.table import ExportError

LAST_BIRTH = 0.5
"""Time before the end at which births in the last step are placed [step]; nodes must be older than their children."""


def tree_sequence(agents: pl.DataFrame, genes: tuple[str, ...], now: int) -> Any:
    """The lives of a world as a `tskit.TreeSequence` with one tree.

    A node is a moment of a lineage: the birth of a founder, a birth in the life of the parent, or an agent alive at
    the end, which is a sample. Times count back from the end [step]. `simplify()` returns the tree of the living, which
    `newick` also writes. Each node belongs to an individual, the agent, whose metadata are its agent_id, the steps of
    its birth and death, and its genes.

    Args:
        agents: Agents of one world and species, by agent_id, as from `pedigree`.
        genes: Genome columns to include in the metadata.
        now: Step at which the pedigree ends.

    Raises:
        ExportError: tskit is not installed, or children have two parents, so that there is no tree.
    """
    try:
        import tskit
    except ModuleNotFoundError as error:
        raise ExportError(f'--format trees needs {error.name}: pip install "hedon[phylogeny]"') from error
    tree = require_tree(agents)
    offspring = np.flatnonzero(tree.parent >= 0)
    births = offspring[np.lexsort((tree.birth[offspring], tree.parent[offspring]))]  # by parent, in the order of time
    parent, living, roots = tree.parent[births], np.flatnonzero(tree.death == ALIVE), np.flatnonzero(tree.parent < 0)
    tip, root = len(births), len(births) + len(living)  # indices of the first such nodes
    first_node = np.full(tree.size, -1)  # first node of each agent's life
    first_node[living] = tip + np.arange(len(living))
    last_node = first_node.copy()
    first_node[parent[::-1]] = np.arange(len(births))[::-1]
    next_node = np.append(np.where(parent[1:] == parent[:-1], np.arange(1, len(births)), -1), -1)[: len(births)]
    next_node = np.where(next_node < 0, last_node[parent], next_node)

    edge_parents = np.concatenate([np.arange(len(births)), np.arange(len(births)), root + np.arange(len(roots))])
    edge_children = np.concatenate([next_node, first_node[births], first_node[roots]])
    has_child = edge_children >= 0
    node_times = np.where(tree.birth[births] < now, now - tree.birth[births], LAST_BIRTH)
    tables = tskit.TableCollection(sequence_length=1)
    tables.time_units = "steps"
    _set_individuals(tables, tskit, agents, genes)
    tables.nodes.set_columns(
        flags=np.r_[np.zeros(tip, np.uint32), np.ones(len(living), np.uint32), np.zeros(len(roots), np.uint32)],
        time=np.r_[node_times, np.zeros(len(living)), (now - tree.birth[roots]).astype(np.float64)],
        individual=np.r_[parent, living, roots].astype(np.int32),
    )
    edges = int(has_child.sum())
    tables.edges.set_columns(
        left=np.zeros(edges),
        right=np.ones(edges),
        parent=edge_parents[has_child].astype(np.int32),
        child=edge_children[has_child].astype(np.int32),
    )
    tables.sort()
    return tables.tree_sequence()


def _set_individuals(tables: Any, tskit: Any, agents: pl.DataFrame, genes: tuple[str, ...]) -> None:
    names = [*("agent_id", "birth_step", "death_step"), *(name for name in genes if name in agents.columns)]
    tables.individuals.metadata_schema = tskit.MetadataSchema({"codec": "json"})
    for row in agents.select(names).iter_rows(named=True):
        tables.individuals.add_row(metadata=row)
