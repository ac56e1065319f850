"""The recorded pedigree of one world as arrays, and measures of it.

Agents are numbered by position: parents come before their children, since an agent_id is never reused.
"""

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

ALIVE = np.iinfo(np.int64).max
"""Step of death of agents that are alive."""

Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Genealogy:
    """The pedigree of one world, by agent_id.

    Attributes:
        parent: Position of the parent, −1 for founders and for agents whose parent is not recorded, (n,).
        birth, death: Steps of birth and death [step], (n,); the death of living agents is `ALIVE`.
        gaps: Number of agents whose parent is missing because a part of the records is damaged.
    """

    parent: Ints
    birth: Ints
    death: Ints
    gaps: int

    @property
    def size(self) -> int:
        """Number of agents."""
        return len(self.parent)

    @property
    def alive(self) -> Flags:
        """Whether each agent is alive at the end of the records, (n,)."""
        return self.death == ALIVE


def genealogy(agents: pl.DataFrame) -> Genealogy:
    """Builds the pedigree.

    Args:
        agents: Table `agents` of one world, by agent_id; columns agent_id, parent_id, birth_step, death_step.
    """
    ids = agents["agent_id"].to_numpy()
    parent_ids = agents["parent_id"].fill_null(-1).to_numpy()
    position = np.searchsorted(ids, parent_ids)
    has_parent = (parent_ids >= 0) & (position < len(ids))
    has_parent[has_parent] = ids[position[has_parent]] == parent_ids[has_parent]
    parent = np.where(has_parent, position, -1).astype(np.int64)
    death = agents["death_step"].cast(pl.Int64).fill_null(ALIVE).to_numpy()
    birth = agents["birth_step"].cast(pl.Int64).to_numpy()
    return Genealogy(parent, birth, death, int(((parent_ids >= 0) & ~has_parent).sum()))


def depth(tree: Genealogy) -> Ints:
    """Generation of each agent in the pedigree: 0 for agents without a recorded parent, (n,)."""
    generation = np.zeros(tree.size, np.int64)
    current = np.flatnonzero(tree.parent >= 0)
    line = tree.parent[current]
    while len(current):  # one round per generation
        generation[current] += 1
        line = tree.parent[line]
        current, line = current[line >= 0], line[line >= 0]
    return generation


def founder(tree: Genealogy) -> Ints:
    """Position of each agent's first recorded ancestor, itself if it has no recorded parent, (n,)."""
    ancestor = np.where(tree.parent < 0, np.arange(tree.size), tree.parent)
    while True:  # each round doubles the distance climbed
        next_ancestor = ancestor[ancestor]
        if np.array_equal(next_ancestor, ancestor):
            return ancestor
        ancestor = next_ancestor


def ancestry(tree: Genealogy, agents: Ints) -> Flags:
    """Whether each agent is one of some agents or an ancestor of one, (n,).

    Args:
        tree: The pedigree.
        agents: Positions of the agents, (m,).
    """
    is_ancestor = np.zeros(tree.size, bool)
    current = np.unique(agents)
    while len(current):
        is_ancestor[current] = True
        parents = tree.parent[current]
        current = np.unique(parents[parents >= 0])
        current = current[~is_ancestor[current]]
    return is_ancestor


def common_ancestor(tree: Genealogy, agents: Ints) -> int | None:
    """Most recent common ancestor of some agents; None if they descend from several founders or there are none.

    Args:
        tree: The pedigree.
        agents: Positions of the agents, (m,).
    """
    is_ancestor = ancestry(tree, agents)
    if not len(agents) or np.count_nonzero(is_ancestor & (tree.parent < 0)) != 1:
        return None
    # Every ancestor up to the common one leads to all the agents. Their lines part at the first agent, from the founder
    # down, that is one of them or has two children among their ancestors.
    ancestors = np.flatnonzero(is_ancestor)
    child_count = np.bincount(tree.parent[ancestors][tree.parent[ancestors] >= 0], minlength=tree.size)
    branching = ancestors[(child_count[ancestors] != 1) | np.isin(ancestors, agents)]
    return int(branching[0])


def living_at(tree: Genealogy, step: int) -> Ints:
    """Positions of the agents alive after a step.

    Args:
        tree: The pedigree.
        step: Agents born in this step count as alive, agents that die in it do not [step].

    Returns:
        Ascending positions, (alive,).
    """
    return np.flatnonzero((tree.birth <= step) & (tree.death > step))


def families(tree: Genealogy, steps: Ints) -> Ints:
    """Number of founders that are alive or have living descendants after each of some steps.

    Args:
        tree: The pedigree.
        steps: Times [step], (times,).

    Returns:
        Numbers of founders, (times,).
    """
    last_death = np.full(tree.size, -1, np.int64)
    np.maximum.at(last_death, founder(tree), tree.death)
    extinctions = np.sort(last_death[last_death >= 0])
    founding_steps = np.sort(tree.birth[tree.parent < 0])
    return np.searchsorted(founding_steps, steps, side="right") - np.searchsorted(extinctions, steps, side="right")


def shares_of_descent(tree: Genealogy, agents: pl.DataFrame, amount: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sums an amount over each agent and its descendants; of two parents, each gets half of a child's amount.

    Args:
        tree: Pedigree of one world.
        agents: The world's rows of the table `agents`, by agent_id; with the column mate_id if some have two parents.
        amount: Amount of each agent, (n,).

    Returns:
        Sums over each agent and all its descendants, (n,).
    """
    share = amount.astype(np.float64).tolist()
    pairs = list(zip(tree.parent.tolist(), _mates(agents).tolist(), strict=True))
    for i in range(tree.size - 1, -1, -1):  # children come after their parents
        parents = [parent for parent in pairs[i] if parent >= 0]
        for parent in parents:
            share[parent] += share[i] / len(parents)
    return np.array(share)


def _mates(agents: pl.DataFrame) -> Ints:
    """Position of each agent's second parent, −1 if there is none, (n,)."""
    if "mate_id" not in agents.columns:
        return np.full(agents.height, -1, np.int64)
    ids, mate_ids = agents["agent_id"].to_numpy(), agents["mate_id"].fill_null(-1).to_numpy()
    position = np.minimum(np.searchsorted(ids, mate_ids), len(ids) - 1)
    return np.where((mate_ids >= 0) & (ids[position] == mate_ids), position, -1).astype(np.int64)
