"""Was the outcome determined or left to chance? Compares futures of one world with fresh worlds."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import genealogy, shares_of_descent
from hedon.analysis.world.population import last_generation
from hedon.analysis.world.record import SEED, WorldRecord
from hedon.assay.resample import Floats
from hedon.assay.sample import Sample
from hedon.ensemble.demand import Past
from hedon.measure.catalogue import MEASURES, gene_mean
from hedon.measure.measure import Measure
from hedon.statistic.correction import holm
from hedon.statistic.interval import LEVEL
from hedon.statistic.law import t_above, t_quantile
from hedon.statistic.minimum import FOR_INTERVAL

FATES = ("alive_mean", "mean_energy", "generation")
"""Measures of a world's end. Other measures cover its whole history, which fresh worlds and futures do not share."""
LINEAGES, NEUTRAL = "lineages", "neutral genes"
DRAWS = 2000
"""Number of permutations per test."""
UNKNOWN = (math.nan, math.nan, math.nan, math.nan)
"""A ratio, its interval and its p value, if they cannot be computed."""
Futures = tuple[Past, Sample]
"""A world at a step, and the worlds that continue from it."""


@dataclass(frozen=True, eq=False)
class Divergence:
    """How far apart the futures of a world end in one measure, compared with fresh worlds.

    Attributes:
        step: Step at which the futures diverge [step].
        generation: Mean generation of the living at that step in fresh worlds.
        measure: Name of the measure, preceded by the species if there are several.
        pasts: Number of worlds that have futures.
        futures, fresh: Number of futures, and of fresh worlds, with a value.
        apart: Mean distance between two futures of one world, on the scale on which the measure is compared; averaged
            over genes if there are several.
        fresh_apart: Mean distance between two fresh worlds.
        ratio: `apart` / `fresh_apart`: near 0 if the outcome was determined by then, 1 if nothing was.
        low, high: Bounds of the 95 % interval of the ratio; NaN with too few worlds.
        p: Two-sided p value of the ratio's deviation from 1.
        p_holm: p after Holm correction for all measures and steps.
    """

    step: int
    generation: float
    measure: str
    pasts: int
    futures: int
    fresh: int
    apart: float
    fresh_apart: float
    ratio: float
    low: float
    high: float
    p: float
    p_holm: float = math.nan


@dataclass(frozen=True, eq=False)
class Overlap:
    """Whether the same agents have descendants in all futures of a world.

    Attributes:
        past: Seed of the world.
        step: Step at which its futures diverge [step].
        species: Species of the agents.
        agents: Number of agents alive at that step.
        everywhere: Number of these that have living descendants in every future.
        nowhere: Number of these that have no living descendants in any future.
        overlap: Share of the living that descends from the same agents in two futures, averaged over pairs of futures.
        chance: Expected overlap if the agents of that time were interchangeable.
        p: Chance of an overlap at least this large if they were.
        p_holm: p after Holm correction for all worlds, steps and species.
    """

    past: int
    step: int
    species: str
    agents: int
    everywhere: int
    nowhere: int
    overlap: float
    chance: float
    p: float
    p_holm: float = math.nan


def measures_of(world: WorldRecord) -> dict[str, list[Measure]]:
    """The measures by which futures and fresh worlds are compared: each weight, all neutral genes together, and others.

    The result contains the measures of each comparison, by its name.
    """
    measures = {f"{gene}_mean": [gene_mean(gene)] for gene in world.reward_names}
    if world.neutral_names:
        measures[NEUTRAL] = [gene_mean(gene) for gene in world.neutral_names]
    return measures | {name: [MEASURES[name]] for name in FATES if MEASURES[name].applies(world)}


def lineages_since(step: int) -> Measure:
    """The effective number of agents at a step from which the living at the end descend."""

    def of(world: WorldRecord) -> float | None:
        share = descent_shares(world, step)["share"].to_numpy()
        return 1.0 / float((share**2).sum()) if share.sum() > 0 else None

    return Measure(LINEAGES, "effective number of lineages since then", of, ratio=True)


def descent_shares(world: WorldRecord, step: int) -> pl.DataFrame:
    """The share of the living at the end that descends from each agent alive at a step.

    Args:
        world: The world.
        step: The step [step].

    Returns:
        Columns agent_id and share, by agent_id. The shares sum to 1, or are all 0 in an extinct world.
    """
    was_alive = pl.col("death_step").is_null() | (pl.col("death_step") > step)
    old = pl.col("birth_step") <= step
    parents = [name for name in ("parent_id", "mate_id") if name in world.agents.columns]
    # Agents alive then count separately, even if one is the parent of another.
    rows = world.agents.filter(was_alive | ~old).sort("agent_id")
    rows = rows.with_columns(pl.when(~old).then(pl.col(parents)))
    tree = genealogy(rows)
    share = shares_of_descent(tree, rows, tree.alive.astype(np.float64)) / max(int(tree.alive.sum()), 1)
    return rows.select("agent_id", old.alias("old"), share=share).filter("old").drop("old")


def diverged(fresh: Sample, futures: Sequence[Futures]) -> list[Divergence]:
    """Compares futures with fresh worlds, for each step from which there are futures, by species and measure."""
    results = []
    for step in sorted({past.step for past, _ in futures}):
        samples = [sample for past, sample in futures if past.step == step]
        for species in fresh.demand.config.species:
            worlds = fresh.of_species(species)
            prefix = f"{species}." if len(fresh.demand.config.species) > 1 else ""
            groups = [each.of_species(species) for each in samples]
            generation = _generation_at(step, worlds)
            for name, measures in {**measures_of(worlds[0]), LINEAGES: [lineages_since(step)]}.items():
                values = [_values(measures, group) for group in groups]
                results.append(_divergence(step, generation, f"{prefix}{name}", values, _values(measures, worlds)))
    corrected = holm([each.p for each in results])
    return [replace(each, p_holm=p) for each, p in zip(results, corrected, strict=True)]


def overlaps(futures: Sequence[Futures]) -> list[Overlap]:
    """Whether the same agents have descendants in all futures, for each world that has futures."""
    results = []
    for past, sample in futures:
        for species in sample.demand.config.species:
            shares = [descent_shares(world, past.step)["share"].to_numpy() for world in sample.of_species(species)]
            living = [each for each in shares if each.sum() > 0]
            if len(living) > 1:
                results.append(overlap(past.seed, past.step, species, np.stack(living)))
    corrected = holm([each.p for each in results])
    return [replace(each, p_holm=p) for each, p in zip(results, corrected, strict=True)]


def _generation_at(step: int, worlds: Sequence[WorldRecord]) -> float:
    """The mean generation of the living at a step, over worlds; NaN if no agents were alive."""
    generations = [last_generation(world.population.filter(pl.col("step") <= step)) for world in worlds]
    recorded = [generation for generation in generations if generation is not None]
    return float(np.mean(recorded)) if recorded else math.nan


def _values(measures: Sequence[Measure], worlds: Sequence[WorldRecord]) -> Floats:
    """The measures of each world that has all of them, each on its own scale, (worlds, measures)."""
    rows = []
    for world in worlds:
        values = [measure.value(world) for measure in measures]
        row = [measure.scaled(value) for measure, value in zip(measures, values, strict=True) if value is not None]
        if len(row) == len(measures):
            rows.append(row)
    return np.array(rows, float).reshape(len(rows), len(measures))


def _divergence(step: int, generation: float, name: str, futures: Sequence[Floats], fresh: Floats) -> Divergence:
    groups = [group for group in futures if len(group) >= FOR_INTERVAL]
    sufficient = bool(groups) and len(fresh) >= FOR_INTERVAL
    apart, fresh_apart = (
        _mean_distance([group for group in futures if len(group) > 1]),
        _mean_distance([fresh]),
    )
    ratio, low, high, p = distance_ratio(groups, fresh) if sufficient else UNKNOWN
    worlds = (len(futures), sum(map(len, futures)), len(fresh))
    return Divergence(step, generation, name, *worlds, apart, fresh_apart, ratio, low, high, p)


def distance_ratio(groups: Sequence[Floats], fresh: Floats) -> tuple[float, float, float, float]:
    """The mean distance between two values of one group, divided by the mean distance between two fresh values.

    The interval is Student's interval of the logarithm with jackknife variance, leaving out each value in turn. It
    applies to these groups, and does not generalize to other groups.

    Args:
        groups: Values of the futures of each world, shape (n, measures) with n at least 3.
        fresh: Independent values, shape (m, measures) with m at least 3.

    Returns:
        The ratio, the bounds of its 95 % interval, and the two-sided p value for equal distances; NaN if all
        values of one side are equal.
    """
    apart, jackknife = _mean_distance(groups), [_distances_without(group) for group in groups]
    full_distances = [_mean_distance([group]) for group in groups]
    fresh_apart = _mean_distance([fresh])
    left_out = [
        apart + (distances - full_distance) / len(groups)
        for distances, full_distance in zip(jackknife, full_distances, strict=True)
    ]
    all_distances = [*left_out, _distances_without(fresh)]
    if not (apart > 0 and fresh_apart > 0 and all((distances > 0).all() for distances in all_distances)):
        return UNKNOWN
    variances = [(len(distances) - 1) * float(np.var(np.log(distances))) for distances in all_distances]
    inner, outer = sum(variances[:-1]), variances[-1]
    freedom = sum(len(group) - 1 for group in groups)
    degrees = (inner + outer) ** 2 / (inner**2 / freedom + outer**2 / (len(fresh) - 1))
    value, error = math.log(apart / fresh_apart), math.sqrt(inner + outer)
    half_width = t_quantile(0.5 * (1.0 + LEVEL), degrees) * error
    bounds = (math.exp(value - half_width), math.exp(value + half_width))
    return math.exp(value), *bounds, 2.0 * t_above(abs(value) / error, degrees)


def _mean_distance(groups: Sequence[Floats]) -> float:
    """The mean distance between two values of one group, with equal weight for each group; NaN without two values."""
    usable = [group for group in groups if len(group) > 1]
    sums = [_summed_distances(group).sum() / (len(group) * (len(group) - 1)) for group in usable]
    return float(np.mean(sums)) if sums else math.nan


def _summed_distances(values: Floats) -> Floats:
    """The distances of each value to all others, summed, (n,)."""
    return np.abs(values[:, None] - values).mean(axis=2).sum(axis=1)


def _distances_without(values: Floats) -> Floats:
    """The mean distance between two values, leaving out each value in turn, (n,)."""
    sums, n = _summed_distances(values), len(values)
    return (sums.sum() - 2.0 * sums) / ((n - 1) * (n - 2))


def overlap(past: int, step: int, species: str, shares: Floats, draws: int = DRAWS) -> Overlap:
    """The overlap of futures, and its expectation for permuted agents.

    Args:
        past: Seed of the world.
        step: Step at which its futures diverge [step].
        species: Species of the agents.
        shares: Share of each future's living that descends from each agent, shape (futures, agents), with two futures
            or more.
        draws: Number of permutations.
    """
    rng = np.random.default_rng([SEED, past, step])
    observed = _mean_overlap(shares)
    null = np.array([_mean_overlap(rng.permuted(shares, axis=1)) for _ in range(draws)])
    p = (1 + np.count_nonzero(null >= observed - 1e-12)) / (1 + draws)
    everywhere, somewhere = (shares > 0).all(axis=0), (shares > 0).any(axis=0)
    counts = (shares.shape[1], int(everywhere.sum()), int((~somewhere).sum()))
    return Overlap(past, step, species, *counts, observed, float(null.mean()), p)


def _mean_overlap(shares: Floats) -> float:
    """Σ min(p, q) over agents, averaged over all pairs of futures, from (futures, agents)."""
    ordered = np.sort(shares, axis=0)[::-1]  # the k-th largest share is the smaller one of k pairs
    futures = len(shares)
    return float((np.arange(futures) @ ordered).sum() / (futures * (futures - 1) / 2))
