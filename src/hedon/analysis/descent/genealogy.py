"""Who descends from whom? The recorded pedigree of one world as arrays, and what can be read off it.

Agents are numbered by position: parents come before their children, since an agent_id is never used again.
"""

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

ALIVE = np.iinfo(np.int64).max
"""Stands for the step of death of those who live."""

Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Genealogy:
    """The pedigree of one world, by agent_id.

    Attributes:
        parent: position of the parent, −1 for founders and for those whose parent is not recorded, (n,).
        birth, death: [step], (n,); a death of `ALIVE` for those who live.
        gaps: agents whose parent is not recorded: a damaged part is missing.
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
        """Which agents live at the end of the records, (n,)."""
        return self.death == ALIVE


def genealogy(agents: pl.DataFrame) -> Genealogy:
    """Builds the pedigree.

    Args:
        agents: table `agents` of one world, by agent_id; columns agent_id, parent_id, birth_step, death_step.
    """
    ids = agents["agent_id"].to_numpy()
    wanted = agents["parent_id"].fill_null(-1).to_numpy()
    at = np.searchsorted(ids, wanted)
    found = (wanted >= 0) & (at < len(ids))
    found[found] = ids[at[found]] == wanted[found]
    parent = np.where(found, at, -1).astype(np.int64)
    death = agents["death_step"].cast(pl.Int64).fill_null(ALIVE).to_numpy()
    birth = agents["birth_step"].cast(pl.Int64).to_numpy()
    return Genealogy(parent, birth, death, int(((wanted >= 0) & ~found).sum()))


def depth(tree: Genealogy) -> Ints:
    """Generation of each agent, counted in the pedigree: 0 for those without a recorded parent, (n,)."""
    generation = np.zeros(tree.size, np.int64)
    current = np.flatnonzero(tree.parent >= 0)
    line = tree.parent[current]
    while len(current):  # one round per generation: each climbs one step
        generation[current] += 1
        line = tree.parent[line]
        current, line = current[line >= 0], line[line >= 0]
    return generation


def founder(tree: Genealogy) -> Ints:
    """Position of the first ancestor of each agent, itself where it has no recorded parent, (n,)."""
    up = np.where(tree.parent < 0, np.arange(tree.size), tree.parent)
    while True:  # doubles the length of the climb in each round
        further = up[up]
        if np.array_equal(further, up):
            return up
        up = further


def ancestry(tree: Genealogy, agents: Ints) -> Flags:
    """Which agents are among some agents, or are ancestors of one, (n,).

    Args:
        tree: the pedigree.
        agents: positions, (m,).
    """
    marked = np.zeros(tree.size, bool)
    current = np.unique(agents)
    while len(current):
        marked[current] = True
        up = tree.parent[current]
        current = np.unique(up[up >= 0])
        current = current[~marked[current]]
    return marked


def common_ancestor(tree: Genealogy, agents: Ints) -> int | None:
    """The most recent common ancestor of some agents; None if they descend from several founders, or are none.

    Args:
        tree: the pedigree.
        agents: positions, (m,).
    """
    line = ancestry(tree, agents)
    if not len(agents) or np.count_nonzero(line & (tree.parent < 0)) != 1:
        return None
    # Every ancestor up to the common one leads to all the agents: from the founder down, the first who is one of
    # the agents or has two children on the way to them is where their lines part.
    marked = np.flatnonzero(line)
    on_the_way = np.bincount(tree.parent[marked][tree.parent[marked] >= 0], minlength=tree.size)
    parts = marked[(on_the_way[marked] != 1) | np.isin(marked, agents)]
    return int(parts[0])


def living_at(tree: Genealogy, step: int) -> Ints:
    """Positions of those alive after a step.

    Args:
        tree: the pedigree.
        step: after which [step]: agents born in it live, agents that die in it do not.

    Returns:
        Ascending positions, (alive,).
    """
    return np.flatnonzero((tree.birth <= step) & (tree.death > step))


def families(tree: Genealogy, steps: Ints) -> Ints:
    """How many founders live, or have living descendants, after each of some steps.

    Args:
        tree: the pedigree.
        steps: times [step], (times,).

    Returns:
        Numbers of founders, (times,).
    """
    last = np.full(tree.size, -1, np.int64)
    np.maximum.at(last, founder(tree), tree.death)
    ends = np.sort(last[last >= 0])
    begun = np.sort(tree.birth[tree.parent < 0])
    return np.searchsorted(begun, steps, side="right") - np.searchsorted(ends, steps, side="right")


def shares_of_descent(tree: Genealogy, agents: pl.DataFrame, amount: NDArray[np.float64]) -> NDArray[np.float64]:
    """What each agent has of an amount that it and its descendants have; with two parents each has half of a child's.

    Args:
        tree: of one world.
        agents: its rows of the table `agents`, by agent_id; the column mate_id where some have two parents.
        amount: of each agent, (n,).

    Returns:
        Sums over the agent itself and all that descend from it, (n,).
    """
    share = amount.astype(np.float64).tolist()
    pairs = list(zip(tree.parent.tolist(), _mates(agents).tolist(), strict=True))
    for i in range(tree.size - 1, -1, -1):  # children come after their parents
        known = [each for each in pairs[i] if each >= 0]
        for each in known:
            share[each] += share[i] / len(known)
    return np.array(share)


def _mates(agents: pl.DataFrame) -> Ints:
    """Position of the second parent of each agent, −1 where there is none, (n,)."""
    if "mate_id" not in agents.columns:
        return np.full(agents.height, -1, np.int64)
    ids, wanted = agents["agent_id"].to_numpy(), agents["mate_id"].fill_null(-1).to_numpy()
    at = np.minimum(np.searchsorted(ids, wanted), len(ids) - 1)
    return np.where((wanted >= 0) & (ids[at] == wanted), at, -1).astype(np.int64)
