"""Effects of mutations on life: each birth is an experiment, because a child's own mutation is random.

Mutations are drawn after a parent has bred, so among the children of one parent they are independent of everything
else. Comparing siblings therefore shows what a gene causes, whatever place, energy and ancestors their parent had. The
regression is of the deviation of a child's outcome from its siblings' mean on the same deviation of its mutation.
Mutations are Cauchy, so a few are enormous: they are clipped, or replaced by the normal scores of their ranks.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
from lazy_loader import load
from numpy.typing import NDArray

from hedon.analysis.agent.lifetime import durations
from hedon.analysis.descent.genealogy import genealogy
from hedon.analysis.descent.walk import is_mutated, mutation_law
from hedon.analysis.world.record import WorldRecord
from hedon.statistic.bootstrap import REPLICATES, percentile_interval, resampled_sums
from hedon.statistic.law import normal_above

special: Any = load("scipy.special", suppress_warning=True)  # takes a fifth of a second to load

OUTCOMES = ("food", "lifespan", "children")
SCALES = ("clipped", "rank")
CLIP = 1.0
"""Largest mutation that is used unclipped; with the default scale of 0.02, one in eighty is larger."""
KNOWN = 0.9
"""Initial part of the run in which a child must be born, since little is known of those born later. Being dead must not
be the criterion, as that would select by the outcome."""
YOUNG = 1024
"""Minimum number of steps for food per step [step]; a meal in a life of three steps is uninformative."""
FEWEST = 30
"""Minimum number of parents with several children for an estimate."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Births:
    """Children with their own mutations and their outcomes.

    Attributes:
        change: Child's genome minus parent's, (n, genes).
        outcome: Energy eaten per step, lifespan or age so far [step], and children, (n, 3).
        parent: Number that identifies the parent, (n,).
    """

    change: Floats
    outcome: Floats
    parent: NDArray[np.int64]


def births_of(world: WorldRecord) -> Births:
    """Children of one world with recorded parents, born in the first `KNOWN` of the run."""
    agents = world.agents
    tree = genealogy(agents)
    duration, _ = durations(agents, world.last_step)
    law = mutation_law(world.config, world.gene(world.weight_names[0]))  # all genes mutate at the same births
    mutated = is_mutated(tree, law, world.last_step)
    child = np.flatnonzero(mutated & (tree.birth <= KNOWN * world.last_step))
    genome = agents.select(world.weight_names).to_numpy().astype(np.float64)
    energy_gained = agents["energy_gained"].to_numpy().astype(np.float64)
    outcome = np.stack([energy_gained / np.maximum(duration, YOUNG), duration, agents["children"].to_numpy()], axis=1)
    return Births(genome[child] - genome[tree.parent[child]], outcome[child], tree.parent[child])


def pool(births: Sequence[Births]) -> Births:
    """Combines the births of several worlds, keeping their parents distinct."""
    offsets = np.cumsum([0, *(int(world_births.parent.max(initial=-1)) + 1 for world_births in births)])
    return Births(
        np.concatenate([world_births.change for world_births in births]),
        np.concatenate([world_births.outcome for world_births in births]),
        np.concatenate([world_births.parent + offset for world_births, offset in zip(births, offsets, strict=False)]),
    )


def mutation_effects(
    births: Births, names: Sequence[str], rng: np.random.Generator, replicates: int = REPLICATES
) -> list[dict[str, Any]]:
    """Effects of each gene on each outcome, on both scales.

    Returns:
        A row for each scale of `SCALES`, outcome of `OUTCOMES` and weight (genome column): births and parents included,
        only parents with several children; effect, the change of the outcome relative to its mean, per unit of the
        weight, or per standard deviation of the rank; low and high, bounds of its 95 % interval, from a bootstrap over
        parents; p, two-sided, from the bootstrap's standard error. No rows if too few parents have several children.
    """
    _, parent, count = np.unique(births.parent, return_inverse=True, return_counts=True)
    has_siblings = count[parent] > 1
    _, parent = np.unique(parent[has_siblings], return_inverse=True)
    if not has_siblings.any() or parent.max() + 1 < FEWEST:
        return []
    mean = births.outcome[has_siblings].mean(axis=0)
    y = _among_siblings(births.outcome[has_siblings] / np.where(mean > 0, mean, 1.0), parent)
    rows = []
    for scale in SCALES:
        x = _among_siblings(_scaled(births.change[has_siblings], scale), parent)
        columns = [*(x[:, g] * y[:, k] for g in range(x.shape[1]) for k in range(y.shape[1])), *(x**2).T]
        features = np.stack([np.bincount(parent, column) for column in columns], axis=1)
        unit = np.maximum(features.std(axis=0), 1e-300)  # sums are in single precision
        resampled = resampled_sums(features / unit, np.arange(len(features)), rng, replicates)
        sums = np.concatenate([(features / unit).sum(axis=0, keepdims=True), resampled]) * unit
        genes, outcomes = x.shape[1], y.shape[1]
        numerators = sums[:, : genes * outcomes].reshape(-1, genes, outcomes)
        denominators = sums[:, genes * outcomes :, None]
        slopes = np.divide(numerators, denominators, out=np.full_like(numerators, np.nan), where=denominators > 0)
        low, high = percentile_interval(slopes[1:])
        error = slopes[1:].std(axis=0)
        for k, outcome in enumerate(OUTCOMES):
            for g, name in enumerate(names):
                effect = float(slopes[0, g, k])
                z = abs(effect) / error[g, k] if error[g, k] > 0 else np.nan
                row = {"outcome": outcome, "weight": name, "scale": scale, "births": len(x), "parents": len(features)}
                row |= {"effect": effect, "low": float(low[g, k]), "high": float(high[g, k])}
                rows.append(row | {"p": float(2.0 * normal_above(z))})
    return rows


def _scaled(change: Floats, scale: str) -> Floats:
    if scale == "clipped":
        return np.clip(change, -CLIP, CLIP)
    rank = pl.from_numpy(change).select(pl.all().rank("average")).to_numpy()
    return np.asarray(special.ndtri((rank - 0.5) / len(change)), np.float64)


def _among_siblings(values: Floats, parent: NDArray[np.int64]) -> Floats:
    """Deviations from the mean of the siblings, (n, columns)."""
    count = np.bincount(parent)
    means = np.stack([np.bincount(parent, column) / count for column in values.T], axis=1)
    return values - means[parent]
