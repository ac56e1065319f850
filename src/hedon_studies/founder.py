"""Founders of studies of one gene, and how their fitness depends on it."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import hedon.assay
from hedon.config import Config
from hedon.record import Founders, make_founders


def spread_gene(config: Config, low: float, high: float, fixed: Mapping[str, float]) -> Founders:
    """Founders whose genes are spread independently and evenly, except some that are equal in all.

    Args:
        config: Settings of the worlds.
        low: Least value of the genes, neutral ones included.
        high: Greatest value.
        fixed: Values of the genes that are equal in all founders.
    """
    spread = hedon.assay.spread_founders(config, hedon.assay.Spread(low, high), next(iter(config.species)))
    genomes = np.array(spread.values)
    for gene, value in fixed.items():
        genomes[:, spread.genes.index(gene)] = value
    return make_founders(spread.genes, genomes, list(spread.group))


def fitness_slope(genes: NDArray[np.floating], fitness: NDArray[np.floating]) -> float | None:
    """The slope of relative fitness on a gene, by least squares.

    Args:
        genes: Gene of each founder, shape (founders,).
        fitness: Its fitness, such as its number of children, shape (founders,).

    Returns:
        None if no founder has any fitness, or if the fitness of some is not known (NaN), as in records that are cut.
    """
    mean = fitness.mean()
    return float(np.polyfit(genes, fitness / mean, 1)[0]) if mean > 0 else None


def known_mean(values: NDArray[np.floating]) -> float | None:
    """The mean of some founders' numbers; None without founders, or if a number is not known (NaN).

    Args:
        values: Number of each founder, shape (founders,).
    """
    return float(values.mean()) if len(values) and np.isfinite(values).all() else None
