"""Does fitness depend on each gene by itself? Neutral genes show what to expect by chance."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hedon.assay.resample import Floats, Ints, chance, permuted, within, world_draws, world_interval, world_moments


@dataclass(frozen=True)
class GeneEffect:
    """The quadratic dependence of relative fitness on one gene, ignoring the others.

    Attributes:
        gene: Genome column of the gene.
        slope: Slope at 0, per unit of the gene.
        slope_low, slope_high: Bounds of its 95 % interval over worlds.
        slope_p: Two-sided p value of the slope, from permutations of fitness among the founders of each world.
        curvature: Second derivative.
        curvature_low, curvature_high, curvature_p: Interval and p value of the curvature.
    """

    gene: str
    slope: float
    slope_low: float
    slope_high: float
    slope_p: float
    curvature: float
    curvature_low: float
    curvature_high: float
    curvature_p: float


def gene_effects(
    genes: Sequence[str], z: Floats, fitness: Floats, world: Ints, rng: np.random.Generator
) -> list[GeneEffect]:
    """The effect of each gene.

    Args:
        genes: Names of the genes.
        z: Genes of each founder, shape (n, genes).
        fitness: Fitness of each founder relative to the mean of its world, shape (n,).
        world: Index of each founder's world, from 0, shape (n,).
        rng: Source of random numbers.
    """
    deviation = within(fitness, world)
    null = within(permuted(fitness, world, rng), world)
    draws = world_draws(len(np.unique(world)), rng)[1:]
    effects = []
    for i, gene in enumerate(genes):
        terms = within(np.stack([z[:, i], z[:, i] ** 2 / 2], axis=1), world)
        inverse = np.linalg.pinv(terms.T @ terms)
        value = inverse @ (terms.T @ deviation)
        p = chance(value, inverse @ (terms.T @ null))
        worlds, cross_products, right = world_moments(terms, deviation, world)
        sums = np.linalg.pinv((draws @ cross_products.reshape(worlds, 4)).reshape(-1, 2, 2))
        low, high = world_interval((sums @ (draws @ right)[..., None])[..., 0], worlds)
        slope, curvature = ((float(value[k]), float(low[k]), float(high[k]), float(p[k])) for k in range(2))
        effects.append(GeneEffect(gene, *slope, *curvature))
    return effects


def flatness(terms: Floats, fitness: Floats, world: Ints, rng: np.random.Generator) -> float:
    """The chance that terms explain at least this much of fitness if genes have no effect.

    Args:
        terms: Terms of the regression, shape (n, p).
        fitness: Fitness of each founder relative to the mean of its world, shape (n,).
        world: Index of each founder's world, from 0, shape (n,).
        rng: Source of random numbers.
    """
    x, _ = np.linalg.qr(within(terms, world))
    deviation = within(fitness, world)
    null = within(permuted(fitness, world, rng), world)
    explained = ((x.T @ deviation) ** 2).sum()
    return float(chance(np.array(explained), ((x.T @ null) ** 2).sum(axis=0)))
