"""Drift: neutral genes that mutate along the recorded pedigree.

Given the pedigree, a gene without effects is a random walk down it: founders draw it from the law of founders, and each
birth adds a mutation. Walks along a world's own pedigree show how far a weight can stray there without selection on it.
They include everything in the pedigree that affects drift: bottlenecks, families, and hitchhiking with whatever else
was selected.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.descent.genealogy import Genealogy, ancestry, depth
from hedon.config import Config
from hedon.config.layout import Gene

WALKS = 2000
"""Number of walks per world; the smallest p-value that they can show is 1 in 2000."""
_PIECE = 250  # walks at a time: 20 MB for 20,000 ancestors


@dataclass(frozen=True)
class MutationLaw:
    """How founders draw a gene and how it mutates: see `hedon.config.schema.evolution.GenomeConfig`.

    Attributes:
        mean, sd: Mean and standard deviation of the founders' normal distribution.
        noise: Name of the law of the mutations.
        df: Degrees of freedom of that law, if it has them.
        probability: Probability that a birth adds a mutation.
        scale: Scale of the mutations.
        limit: Weights are clipped to ± this.
        tabulated: Whether all births with the same `birth_number` get the same mutation.
        window: Length of a window [step].
        late: Whether genomes are drawn at the end of a window, when its number of births is known.
    """

    mean: float
    sd: float
    scale: float
    limit: float
    tabulated: bool
    window: int
    late: bool
    noise: str = "cauchy"
    df: float = 2.0
    probability: float = 1.0

    def draw(self, rng: np.random.Generator, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """Draws mutations of scale 1; 0 if a gene does not mutate.

        Args:
            rng: Random number generator.
            shape: Shape of the result.

        Returns:
            Independent values, of the given shape, float64.
        """
        if self.noise == "student_t":
            noise = rng.standard_t(self.df, shape)
        elif self.noise == "normal":
            noise = rng.standard_normal(shape)
        elif self.noise == "uniform":
            noise = rng.uniform(-1.0, 1.0, shape)
        else:
            noise = rng.standard_cauchy(shape)
        return noise if self.probability >= 1.0 else noise * (rng.random(shape) < self.probability)


def mutation_law(config: Config, gene: Gene) -> MutationLaw:
    """Law of one gene in a run.

    Args:
        config: Settings of the run.
        gene: A gene of a species' layout.
    """
    return MutationLaw(
        mean=gene.law.initial_mean,
        sd=gene.law.initial_sd,
        scale=gene.mutation.scale,
        limit=gene.mutation.limit,
        tabulated=config.world.mutation_noise == "tabulated",
        window=config.world.rollout_steps,
        late=config.world.inheritance == "at_window_end",
        noise=gene.mutation.law,
        df=gene.mutation.df,
        probability=gene.mutation.probability,
    )


def neutral_means(
    tree: Genealogy, sample: NDArray[np.int64], law: MutationLaw, rng: np.random.Generator, walks: int = WALKS
) -> NDArray[np.float64]:
    """Means, over a sample of agents, of neutral genes that walk down the pedigree.

    Only the ancestors of the sample are simulated.

    Args:
        tree: The pedigree, without gaps.
        sample: Positions of the agents, (n,).
        law: Law of founders and mutations.
        rng: Random number generator.
        walks: Number of genes, independent of each other.

    Returns:
        Shape (walks,).
    """
    nodes = np.flatnonzero(ancestry(tree, sample))
    place = _places(tree, nodes)[sample]
    genes = _walked(tree, nodes, law, rng, walks)
    return np.concatenate([gene[place].mean(axis=0, dtype=np.float64) for gene in genes])


def neutral_genes(
    tree: Genealogy, sample: NDArray[np.int64], law: MutationLaw, rng: np.random.Generator, walks: int
) -> NDArray[np.float32]:
    """Neutral genes of a sample of agents, from walks down the pedigree.

    Args:
        tree: The pedigree, without gaps.
        sample: Positions of the agents, (n,).
        law: Law of founders and mutations.
        rng: Random number generator.
        walks: Number of genes, independent of each other.

    Returns:
        Shape (n, walks).
    """
    nodes = np.flatnonzero(ancestry(tree, sample))
    place = _places(tree, nodes)[sample]
    return np.concatenate([gene[place] for gene in _walked(tree, nodes, law, rng, walks)], axis=1)


def neutral_courses(
    tree: Genealogy, living: Sequence[NDArray[np.int64]], law: MutationLaw, rng: np.random.Generator, walks: int
) -> NDArray[np.float64]:
    """Means, over the agents alive at some times, of neutral genes that walk down the pedigree.

    Args:
        tree: The pedigree, without gaps.
        living: Positions of the living agents at each time, (alive,) each; never empty.
        law: Law of founders and mutations.
        rng: Random number generator.
        walks: Number of genes, independent of each other.

    Returns:
        Shape (walks, times).
    """
    nodes = np.flatnonzero(ancestry(tree, np.concatenate(living)))
    place = _places(tree, nodes)
    genes = _walked(tree, nodes, law, rng, walks)
    return np.concatenate(
        [[gene[place[positions]].mean(axis=0, dtype=np.float64) for positions in living] for gene in genes], axis=1
    ).T


def _places(tree: Genealogy, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Position of each agent in `nodes`; 0 for agents that are not in it."""
    place = np.zeros(tree.size, np.int64)
    place[nodes] = np.arange(len(nodes))
    return place


def _walked(
    tree: Genealogy, nodes: NDArray[np.int64], law: MutationLaw, rng: np.random.Generator, walks: int
) -> Iterator[NDArray[np.float32]]:
    """Genes of `nodes`, which include all their own ancestors, several walks at a time: (len(nodes), walks)."""
    place = _places(tree, nodes)
    generation = depth(tree)[nodes]
    order = np.argsort(generation, kind="stable")
    levels = np.split(order, np.cumsum(np.bincount(generation))[:-1])
    parent = place[tree.parent[nodes]]
    number = birth_number(tree, law.window, law.late)[nodes]
    for first in range(0, walks, _PIECE):
        count = min(_PIECE, walks - first)
        gene = np.empty((len(nodes), count), np.float32)
        founders = rng.normal(law.mean, law.sd, (len(levels[0]), count))
        gene[levels[0]] = np.clip(founders, -law.limit, law.limit)
        table = law.draw(rng, (int(number.max()) + 1 if law.tabulated else 0, count))
        for level in levels[1:]:
            noise = table[number[level]] if law.tabulated else law.draw(rng, (len(level), count))
            gene[level] = np.clip(gene[parent[level]] + law.scale * noise, -law.limit, law.limit)
        yield gene


def lineages(
    law: MutationLaw, mutations: int, worlds: int, count: int, rng: np.random.Generator, births: int = 1, genes: int = 1
) -> NDArray[np.float32]:
    """Neutral genes along single lines of descent, without a pedigree.

    Returns:
        Genes of the founder and after each mutation, shape (mutations + 1, worlds, count, genes).
    """
    shape = (worlds, count, genes)
    values = np.empty((mutations + 1, *shape), np.float32)
    values[0] = np.clip(rng.normal(law.mean, law.sd, shape), -law.limit, law.limit)
    table = law.draw(rng, (worlds, births if law.tabulated else 0, genes))
    for i in range(mutations):
        if law.tabulated:
            noise = np.take_along_axis(table, rng.integers(births, size=(worlds, count))[..., None], axis=1)
        else:
            noise = law.draw(rng, shape)
        values[i + 1] = np.clip(values[i] + law.scale * noise, -law.limit, law.limit)
    return values


def is_mutated(tree: Genealogy, law: MutationLaw, last_step: int) -> NDArray[np.bool_]:
    """Whether an agent's recorded genome is its parent's recorded one plus a mutation; False for founders, shape (n,).

    If genomes are drawn at the end of a window, an agent that died in the window of its birth never had a genome of its
    own, and one born in an unfinished window has none yet.

    Args:
        tree: The pedigree.
        law: Law of founders and mutations.
        last_step: End of the records [step].
    """
    born = tree.parent >= 0
    if not law.late:
        return born
    end = -(-tree.birth // law.window) * law.window
    is_final = ~born | ((tree.death > end) & (end <= last_step))
    return born & is_final & is_final[tree.parent]


def birth_number(tree: Genealogy, window: int, late: bool) -> NDArray[np.int64]:
    """Numbers births so that births with the same tabulated noise share a number.

    Tabulated noise depends on a birth's index within its window of learning and on a number of births: that of the
    window itself if genomes are drawn at its end (`late`), else the previous window's.

    Args:
        tree: The pedigree.
        window: Length of a window [step].
        late: Whether genomes are drawn at the end of a window.

    Returns:
        Numbers from 0 without gaps, in the order of (births, index); 0 for founders, shape (n,).
    """
    born = tree.parent >= 0
    # An agent born in step s (counted from 0) has birth s + 1; ids, and thus positions, follow the order of birth.
    window_index = np.where(born, (tree.birth - 1) // window, -1)
    index = pl.DataFrame({"window": window_index}).select(pl.int_range(pl.len()).over("window")).to_series().to_numpy()
    births = np.bincount(window_index[born] + 1, minlength=2)  # per window, after a 0 for the one before the first
    birth_count = births[window_index + late]
    number = np.zeros(tree.size, np.int64)
    pairs = np.stack([birth_count, index], axis=1)[born]
    number[born] = np.unique(pairs, axis=0, return_inverse=True)[1].ravel() if born.any() else 0
    return number
