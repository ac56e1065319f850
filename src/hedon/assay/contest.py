"""Two groups of genomes in one world: which one grows, and how fast?

Let p be the share of a group among the living. Selection of strength s per generation changes it by s·p·(1 − p) per
generation, and drift adds noise with mean 0. We use the maximum-likelihood estimate for this diffusion (Watterson
1979), s = Σ Δp / Σ ∫ p(1 − p) dg over worlds. A world in which one group is lost contributes nothing from then on. The
log ratio of the two groups changes by s per generation.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import depth, founder, genealogy, living_at, shares_of_descent
from hedon.analysis.world.record import WorldRecord
from hedon.assay.landscape import AssayError
from hedon.assay.resample import (
    PERMUTATIONS,
    Estimate,
    Floats,
    chance,
    diffusion_strength,
    share_estimate,
    world_draws,
    world_interval,
)
from hedon.assay.sample import Sample
from hedon.record.founder import Founders

TIMES = 101
"""Number of moments at which the living are counted."""
_SEED = 20260802
Point = Mapping[str, float]
"""The genes of a group, by column."""


@dataclass(frozen=True, eq=False)
class Lines:
    """The numbers of two groups in one world over time.

    Attributes:
        seed: Seed of the world.
        step: Moments up to the last one with living agents [step], shape (times,).
        count: Living agents of the first and the second group, shape (times, 2); an agent with genes of both is divided
            between them.
        generation: Mean generation of the living, shape (times,).
        first: Whether each founder belongs to the first group, shape (founders,).
        descendants: Living descendants of each founder at the last moment, shape (founders,); each of two parents
            counts half of a child.
        ended: Whether the world died out.
    """

    seed: int
    step: np.ndarray
    count: Floats
    generation: Floats
    first: np.ndarray
    descendants: Floats
    ended: bool

    @property
    def share(self) -> Floats:
        """The share of the first group among the living, shape (times,)."""
        return self.count[:, 0] / self.count.sum(axis=1)

    @property
    def selection(self) -> float:
        """The selection coefficient estimated from this world only; NaN if the share never varied."""
        variation = float(self.variation.sum())
        return float(self.share[-1] - self.share[0]) / variation if variation > 0 else float("nan")

    @property
    def variation(self) -> Floats:
        """The integral of p(1 − p) over the generations of each interval, shape (times − 1,)."""
        variance = self.share * (1 - self.share)
        return (variance[1:] + variance[:-1]) / 2 * np.diff(self.generation)

    @property
    def sums(self) -> Floats:
        """Sums over intervals, shape (5,): Δp, pΔp, V, pV and p²V, with p at their starts and V = p(1 − p)Δg."""
        share, change = self.share[:-1], np.diff(self.share)
        variation = share * (1.0 - share) * np.diff(self.generation)
        parts = (change, share * change, variation, share * variation, share**2 * variation)
        return np.array([part.sum() for part in parts])


@dataclass(frozen=True, eq=False)
class AtShare:
    """The result of two groups in worlds whose founders had one share of the first.

    Attributes:
        start: Share of the first group among the founders.
        share: Its mean over the worlds' generations, weighted by p(1 − p); NaN if it never varied.
        selection: Selection coefficient of the first group per generation.
        end: Share at the end, averaged over worlds.
        worlds: Number of worlds.
        extinct: Number of worlds that died out; they are used for as long as they lived.
        fixed, lost: Number of worlds in which only the first group, or only the second, was left.
        generations: Mean generation at the end, averaged over worlds.
    """

    start: float
    share: float
    selection: Estimate
    end: Estimate
    worlds: int
    extinct: int
    fixed: int
    lost: int
    generations: float


@dataclass(frozen=True, eq=False)
class Contest:
    """The result of a contest between two groups.

    Attributes:
        groups: Names of the groups; all numbers refer to the first against the second.
        lines: Numbers of both groups over time, in each world.
        result: Their result in all worlds together.
        p: p value of the change of the share, from a permutation test that exchanges the groups of founders.
        steps: Length of each world [step].
    """

    groups: tuple[str, str]
    lines: tuple[Lines, ...]
    result: AtShare
    p: float
    steps: int

    def course(self) -> tuple[np.ndarray, Floats, Floats]:
        """The steps, the log ratio of the groups' numbers summed over worlds, and its interval.

        Returns:
            Arrays of shape (times,), (times,) and (2, times).
        """
        step = np.linspace(0, self.steps, TIMES).round().astype(np.int64)
        counts = np.zeros((len(self.lines), TIMES, 2))
        for i, lines in enumerate(self.lines):
            counts[i, : len(lines.step)] = lines.count
        worlds = len(self.lines)
        draws = world_draws(worlds, np.random.default_rng(_SEED))
        totals = np.einsum("rw,wtg->rtg", draws, counts)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.log(totals[..., 0] / totals[..., 1])
        return step, ratio[0], world_interval(ratio[1:], worlds)


def world_lines(agents: pl.DataFrame, seed: int, member: Floats, steps: int) -> Lines:
    """Counts two groups in one world.

    Args:
        agents: Rows of the table `agents` of one world and species, by agent_id.
        seed: Seed of the world.
        member: Membership of each agent in the first group, from 0 to 1, shape (agents,).
        steps: Length of the run [step].
    """
    tree = genealogy(agents)
    generation = depth(tree)
    founders = np.flatnonzero(tree.parent < 0)
    counts, generations, moments = [], [], []
    living = founders
    for step in np.linspace(0, steps, TIMES).round().astype(np.int64):
        alive = living_at(tree, int(step))
        if not len(alive):
            break
        living = alive
        first_count = float(member[living].sum())
        counts.append((first_count, len(living) - first_count))
        generations.append(generation[living].mean())
        moments.append(step)
    alive_at_end = np.zeros(tree.size)
    alive_at_end[living] = 1.0
    return Lines(
        seed=seed,
        step=np.array(moments),
        count=np.array(counts, np.float64),
        generation=np.array(generations),
        first=member[founders],
        descendants=shares_of_descent(tree, agents, alive_at_end)[founders],
        ended=len(moments) < TIMES,
    )


def by_descent(agents: pl.DataFrame, first: Sequence[bool], first_id: int = 0) -> Floats:
    """The membership of each agent in the first group, by descent from its founder: 0 or 1, shape (agents,).

    Args:
        agents: Agents of one world, by agent_id.
        first: Whether each founder belongs to the first group.
        first_id: agent_id of the first founder.
    """
    line = founder(genealogy(agents))
    return np.asarray(first, np.float64)[agents["agent_id"].to_numpy()[line] - first_id]


def by_gene(agents: pl.DataFrame, a: Mapping[str, float], b: Mapping[str, float]) -> Floats:
    """The share of distinguishing genes that each agent has from the first of two points, shape (agents,).

    If children have two parents, groups are distinguished by the genes in which they differ; there is no mutation.

    Args:
        agents: Agents of one world.
        a: Genes of the first group, by column.
        b: Genes of the second group, with the same columns.

    Raises:
        AssayError: The points are equal, or have different genes.
    """
    genes = [gene for gene, value in a.items() if b.get(gene) != value]
    if not genes or a.keys() != b.keys():
        raise AssayError("two groups of a world with birth.mating = pairs must be points with other values of one gene")
    values = agents.select(genes).to_numpy().astype(np.float32)
    return np.asarray(np.mean(values == np.array([a[gene] for gene in genes], np.float32), axis=1, dtype=np.float64))


def sample_lines(sample: Sample, groups: tuple[str, str], species: str) -> list[Lines]:
    """The numbers of two groups in each world of a sample.

    Raises:
        AssayError: There is no table of founders, or its groups cannot be distinguished.
    """
    founders = sample.demand.founders
    if founders is None:
        raise AssayError(f"{sample.demand.name}: has no table of founders, so it is not a contest")
    return [_lines(world, founders, groups, sample.steps) for world in sample.of_species(species)]


def estimate(groups: tuple[str, str], lines: Sequence[Lines], steps: int) -> Contest:
    """Estimates selection from the numbers of two groups in some worlds.

    Args:
        groups: Names of the first and the second group.
        lines: Numbers over time, one entry per world.
        steps: Length of each world [step].
    """
    start = float(np.mean([world_line.share[0] for world_line in lines]))
    p = _exchange(lines, np.random.default_rng(_SEED))
    return Contest(groups, tuple(lines), at_share(start, lines), p, steps)


def at_share(start: float, lines: Sequence[Lines]) -> AtShare:
    """The result of worlds that started with one share.

    Args:
        start: Share of the first group among the founders.
        lines: Numbers over time, one entry per world.
    """
    by_seed = sorted(lines, key=lambda world_line: world_line.seed)  # sums must not depend on the order of seeds
    _, _, total, weighted, _ = np.sum([world_line.sums for world_line in by_seed], axis=0)
    change = np.concatenate([np.diff(world_line.share) for world_line in lines])
    variation = np.concatenate([world_line.variation for world_line in lines])
    end_shares = np.array([world_line.share[-1] for world_line in lines])
    return AtShare(
        start=start,
        share=float(weighted / total) if total > 0 else np.nan,
        selection=diffusion_strength(change, variation, len(lines)),
        end=share_estimate(end_shares),
        worlds=len(lines),
        extinct=sum(world_line.ended for world_line in lines),
        fixed=int((end_shares == 1).sum()),
        lost=int((end_shares == 0).sum()),
        generations=float(np.mean([world_line.generation[-1] for world_line in lines])),
    )


def points_of(founders: Founders, groups: tuple[str, str], species: str) -> tuple[Point, Point]:
    """The genes of two groups that have one row each.

    Raises:
        AssayError: A group has several rows, or lacks a gene of the other.
    """
    species_founders = founders.of_species(species)
    rows = [[i for i, group in enumerate(species_founders.group) if group == name] for name in groups]
    if any(len(indices) != 1 for indices in rows) or np.isnan(species_founders.values).any():
        raise AssayError(
            "with birth.mating = pairs a child has genes of two parents: give two points that name the same genes, "
            "such as see_agent=0 and see_agent=5"
        )
    first, second = (
        dict(zip(species_founders.genes, map(float, species_founders.values[indices[0]]), strict=True))
        for indices in rows
    )
    return first, second


def _lines(world: WorldRecord, founders: Founders, groups: tuple[str, str], steps: int) -> Lines:
    if world.species_config.birth.mating == "pairs":
        points = points_of(founders, groups, world.species)
        return world_lines(world.agents, world.seed, by_gene(world.agents, *points), steps)
    first_id = 0  # IDs of founders follow the order of species
    for name, species in world.config.species.items():
        if name == world.species:
            break
        first_id += species.population.initial_count
    first = [name == groups[0] for name in founders.groups(world.seed, world.species_config.population.initial_count)]
    return world_lines(world.agents, world.seed, by_descent(world.agents, first, first_id), steps)


def _exchange(lines: Sequence[Lines], rng: np.random.Generator) -> float:
    """The p value of the mean change of the share if the assignment of founders to groups does not matter."""
    observed, null = 0.0, np.zeros(PERMUTATIONS)
    for world_line in lines:
        weights = world_line.descendants / world_line.descendants.sum()
        expected = world_line.first.mean()
        observed += float(weights @ world_line.first) - expected
        labels = rng.permuted(np.tile(world_line.first, (PERMUTATIONS, 1)), axis=1)
        null += labels @ weights - expected
    return float(chance(np.array(observed), null))
