"""Tests whether a weight went further, or more in one direction, than drift alone would have carried it.

There are two controls. The *walk*: in each world, the mean weight of the agents alive at the end is compared with
neutral genes that mutate along the same pedigree (`descent.walk`), and `statistic.drift` tests its score among them.
The *recorded neutral genes* of the same worlds: the test is whether a weight strays further from its start than those
with its founders and mutations; under drift, it is as likely to rank first among them as last.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from hedon.analysis.descent.genealogy import Genealogy, depth, living_at
from hedon.analysis.descent.walk import WALKS, mutation_law, neutral_means
from hedon.analysis.gene.pedigree import walked_pedigree
from hedon.analysis.gene.weight import last_lived_step
from hedon.analysis.world.record import WorldRecord, generator
from hedon.statistic.correction import holm
from hedon.statistic.drift import ScoreTest, rank_score, rank_sum_p, score_tests
from hedon.statistic.interval import mean_bounds
from hedon.statistic.law import normal_above

NAN = math.nan


@dataclass(frozen=True)
class WorldDrift:
    """One weight of one world compared with neutral walks.

    Attributes:
        weight: Genome column.
        start: Mean of the founders' law.
        mean: Mean over the compared agents.
        null_low, null_median, null_high: Median of the walks, and the bounds of 95 % of them.
        score: Standard normal score of the mean's rank among the walks.
        p: Two-sided probability of such a rank under drift.
        generation: Mean generation of the compared agents.
    """

    weight: str
    start: float
    mean: float
    null_low: float
    null_median: float
    null_high: float
    score: float
    p: float
    generation: float = NAN


_KNOWN: WeakKeyDictionary[WorldRecord, dict[int | None, list[WorldDrift]]] = WeakKeyDictionary()


@dataclass(frozen=True)
class DriftTest(ScoreTest):
    """One weight of one condition tested against one control: walks, by its scores among them, or "recorded".

    For "recorded" the effect is the mean of |displacement of the weight| − |displacement of the neutral genes|, in the
    weight's units, and p refers to the sum over worlds of its rank among them. Only neutral genes with the weight's
    founders and mutations count; without any, this test is omitted. p_holm is corrected for all reward weights and all
    tests against walks, or for all reward weights against neutral genes; it is NaN for neutral genes, which are shown
    as a check of the method.

    Attributes:
        weight: Genome column.
    """

    weight: str = ""


def world_drift(
    world: WorldRecord, rng: np.random.Generator, walks: int = WALKS, last: int | None = None
) -> list[WorldDrift]:
    """Compares each weight of a world with neutral walks along its pedigree.

    Returns:
        A result for each weight; empty if no neutral gene can walk down the pedigree (see `walked_pedigree`).
    """
    tree = walked_pedigree(world)
    sample = np.array([], np.int64) if tree is None else _sample(tree, world, last)
    if tree is None or not len(sample):
        return []
    generation = float(depth(tree)[sample].mean())
    laws = {name: mutation_law(world.config, world.gene(name)) for name in world.weight_names}
    null = {law: neutral_means(tree, sample, law, rng, walks) for law in dict.fromkeys(laws.values())}
    results = []
    for name, law in laws.items():
        mean = float(world.agents[name].to_numpy()[sample].mean(dtype=np.float64))
        low, median, high = (float(bound) for bound in np.quantile(null[law], (0.025, 0.5, 0.975)))
        score = rank_score(mean, null[law], rng)
        p = float(2.0 * normal_above(abs(score)))
        results.append(WorldDrift(name, law.mean, mean, low, median, high, score, p, generation))
    return results


def standard_drift(world: WorldRecord, last: int | None = None) -> list[WorldDrift]:
    """`world_drift` with the world's own random numbers; cached for each world, since walks take long.

    Args:
        world: A world with its agents.
        last: Agents to compare, as in `world_drift`.
    """
    cached = _KNOWN.setdefault(world, {})
    if last not in cached:
        cached[last] = world_drift(world, generator(world), last=last)
    return cached[last]


def _sample(tree: Genealogy, world: WorldRecord, last: int | None) -> NDArray[np.int64]:
    """Positions of the agents to compare."""
    if last is None:
        return living_at(tree, last_lived_step(world.population))
    return np.lexsort((np.arange(tree.size), tree.birth))[-last:]


def drift_tests(
    worlds: Sequence[Sequence[WorldDrift]],
    reward_names: Sequence[str],
    neutral_names: Sequence[str],
    alike: Mapping[str, Sequence[str]],
    rng: np.random.Generator,
) -> list[DriftTest]:
    """Tests of one condition.

    Args:
        worlds: Results of `world_drift`, one list per world; empty ones are skipped.
        reward_names: Genome columns that enter the reward.
        neutral_names: Columns of the neutral genes.
        alike: For each reward weight, the neutral genes with its law, from `like_neutral`.
        rng: Random number generator that breaks ties.
    """
    drifts = [{result.weight: result for result in world} for world in worlds if world]
    walk_tests = [test for name in (*reward_names, *neutral_names) for test in _against_walks(name, drifts)]
    neutral_tests = [_against_neutral(name, alike[name], drifts, rng) for name in reward_names if alike.get(name)]
    return [*_corrected(walk_tests, neutral_names), *_corrected(neutral_tests, neutral_names)]


def _against_walks(name: str, worlds: Sequence[dict[str, WorldDrift]]) -> list[DriftTest]:
    scores = np.array([world[name].score for world in worlds])
    return [DriftTest(weight=name, **vars(test)) for test in score_tests(scores)]


def _against_neutral(
    name: str, neutral: Sequence[str], worlds: Sequence[dict[str, WorldDrift]], rng: np.random.Generator
) -> DriftTest:
    excess, ranks = [], []
    for world in worlds:
        displacement, controls = _displacement(world[name]), np.array([_displacement(world[gene]) for gene in neutral])
        excess.append(displacement - float(controls.mean()))
        ties = np.count_nonzero(controls == displacement)
        ranks.append(1 + np.count_nonzero(controls < displacement) + int(rng.integers(0, ties + 1)))
    p = rank_sum_p(ranks, [len(neutral) + 1] * len(ranks)) if ranks else NAN
    return DriftTest("recorded", len(excess), *mean_bounds(excess), p, weight=name)


def _displacement(result: WorldDrift) -> float:
    return abs(result.mean - result.start)


def _corrected(tests: Sequence[DriftTest], neutral_names: Sequence[str]) -> list[DriftTest]:
    corrected = holm([NAN if test.weight in neutral_names else test.p for test in tests])
    return [replace(test, p_holm=p) for test, p in zip(tests, corrected, strict=True)]
