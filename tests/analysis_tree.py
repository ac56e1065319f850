"""Random pedigrees, and a simple way to trace ancestors in them."""

import numpy as np

from hedon.analysis.descent.genealogy import ALIVE, Genealogy


def random_tree(rng: np.random.Generator, count: int, founders: int) -> Genealogy:
    """Each agent has a random earlier agent as its parent; one in five is alive."""
    parent = np.array([-1 if i < founders else rng.integers(max(0, i - 30), i) for i in range(count)])
    birth = np.where(parent < 0, 0, np.arange(count))
    return Genealogy(parent, birth, np.where(rng.random(count) < 0.2, ALIVE, birth + 40), 0)


def lines(tree: Genealogy, agent: int) -> list[int]:
    """An agent and its ancestors, up to the founder."""
    path = [agent]
    while tree.parent[path[-1]] >= 0:
        path.append(int(tree.parent[path[-1]]))
    return path
