"""Two groups of genomes in one world: which one grows, and how fast?

With p the share of a group among the living, selection of strength s per generation changes it by s·p·(1 − p) per
generation, and drift adds noise of mean 0. The estimate is the maximum-likelihood one of that diffusion (Watterson
1979), s = Σ Δp / Σ ∫ p(1 − p) dg over worlds: a world in which one group is lost adds nothing from then on. The log of
the ratio of the two groups changes by s per generation.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from scipy.integrate import trapezoid

from hedon.analysis.descent.genealogy import depth, founder, genealogy, living_at
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.assay.landscape import AssayError
from hedon.assay.resample import PERMUTATIONS, Floats, chance, world_draws, world_interval
from hedon.assay.surface import Estimate
from hedon.config.config import Config
from hedon.record.founder import Founders
from hedon.record.founder_table import load_founders
from hedon.record.reader import Run

TIMES = 101
"""Moments at which the living are counted."""
_SEED = 20260802


@dataclass(frozen=True, eq=False)
class Lines:
    """The numbers of two groups in one world over time.

    Attributes:
        seed: of the world.
        step: moments [step], up to the last at which somebody lived, (times,).
        count: living of the first and the second group, (times, 2).
        generation: mean generation of the living, (times,).
        first: whether each founder belongs to the first group, (founders,).
        descendants: living descendants of each founder at the last moment, (founders,).
        ended: whether the world died out.
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
        """The share of the first group among the living, (times,)."""
        return self.count[:, 0] / self.count.sum(axis=1)


@dataclass(frozen=True, eq=False)
class Contest:
    """How two groups fared.

    Attributes:
        groups: their names; numbers are of the first against the second.
        lines: of each world.
        selection: coefficient per generation, with its interval over worlds.
        share: of the first group at the end, mean over worlds, with its interval.
        start: its share at the beginning.
        p: chance of so large a change of the share if both groups are alike: founders exchange their groups.
        fixed, lost: worlds in which only the first group, or only the second, is left.
        generations: mean over worlds, at the end.
        config: of the run.
        steps: of each world [step].
    """

    groups: tuple[str, str]
    lines: tuple[Lines, ...]
    selection: Estimate
    share: Estimate
    start: float
    p: float
    fixed: int
    lost: int
    generations: float
    config: Config
    steps: int

    def course(self) -> tuple[np.ndarray, Floats, Floats]:
        """Steps, the log ratio of the groups' numbers summed over worlds, and its interval, (times,) and (2, times)."""
        step = np.linspace(0, self.steps, TIMES).round().astype(np.int64)
        counts = np.zeros((len(self.lines), TIMES, 2))
        for i, lines in enumerate(self.lines):
            counts[i, : len(lines.step)] = lines.count
        worlds = len(self.lines)
        draws = np.concatenate([np.ones((1, worlds)), world_draws(worlds, np.random.default_rng(_SEED))])
        summed = np.einsum("rw,wtg->rtg", draws, counts)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.log(summed[..., 0] / summed[..., 1])
        return step, ratio[0], world_interval(ratio[1:], worlds)


def world_lines(agents: pl.DataFrame, seed: int, first: Sequence[bool], steps: int) -> Lines:
    """Counts two groups in one world.

    Args:
        agents: its rows of the table `agents`, by agent_id.
        seed: of the world.
        first: whether each founder, by agent_id, belongs to the first group.
        steps: of the run [step].
    """
    tree = genealogy(agents)
    generation, line = depth(tree), founder(tree)
    founders = np.flatnonzero(tree.parent < 0)
    member = np.zeros(tree.size, bool)
    member[founders] = np.asarray(first)[agents["agent_id"].to_numpy()[founders]]
    of_first = member[line]
    counts, generations, moments = [], [], []
    descendants = np.zeros(len(founders))
    for step in np.linspace(0, steps, TIMES).round().astype(np.int64):
        living = living_at(tree, int(step))
        if not len(living):
            break
        mine = int(of_first[living].sum())
        counts.append((mine, len(living) - mine))
        generations.append(generation[living].mean())
        moments.append(step)
        descendants = np.bincount(line[living], minlength=tree.size)[founders].astype(np.float64)
    return Lines(
        seed=seed,
        step=np.array(moments),
        count=np.array(counts, np.float64),
        generation=np.array(generations),
        first=member[founders],
        descendants=descendants,
        ended=len(moments) < TIMES,
    )


def measure_contest(run: Run, groups: tuple[str, str]) -> Contest:
    """Reads a finished run of two groups.

    Args:
        run: of the assay; its table of founders has the two groups.
        groups: names of the first and the second.

    Raises:
        AssayError: The run has no table of founders.
    """
    worlds = read_worlds([run])
    config = worlds[0].config
    founders = load_founders(run.path, config)
    if founders is None:
        raise AssayError(f"{run.path}: has no table of founders, so it is not a contest")
    steps = max(run.manifest.steps_done)
    lines = [world_lines(world.agents, world.seed, _members(founders, world, groups[0]), steps) for world in worlds]
    return estimate(groups, lines, config, steps)


def estimate(groups: tuple[str, str], lines: Sequence[Lines], config: Config, steps: int) -> Contest:
    """Estimates what the numbers of two groups in some worlds tell; see `Contest`.

    Args:
        groups: names of the first and the second group.
        lines: numbers over time, one entry per world.
        config: of all the worlds.
        steps: of each world [step].
    """
    rng = np.random.default_rng(_SEED)
    worlds = len(lines)
    change = np.array([each.share[-1] - each.share[0] for each in lines])
    variation = np.array([trapezoid(each.share * (1 - each.share), each.generation) for each in lines])
    draws = np.concatenate([np.ones((1, worlds)), world_draws(worlds, rng)])
    with np.errstate(divide="ignore", invalid="ignore"):
        strength = (draws @ change) / (draws @ variation)
    low, high = world_interval(strength[1:], worlds)
    ends = np.array([each.share[-1] for each in lines])
    end_low, end_high = world_interval((draws[1:] @ ends) / worlds, worlds)
    return Contest(
        groups=groups,
        lines=tuple(lines),
        selection=Estimate(float(strength[0]), float(low), float(high)),
        share=Estimate(float(ends.mean()), float(end_low), float(end_high)),
        start=float(np.mean([each.share[0] for each in lines])),
        p=_exchange(lines, rng),
        fixed=int((ends == 1).sum()),
        lost=int((ends == 0).sum()),
        generations=float(np.mean([each.generation[-1] for each in lines])),
        config=config,
        steps=steps,
    )


def _members(founders: Founders, world: WorldRecord, group: str) -> list[bool]:
    return [name == group for name in founders.groups(world.seed, world.own.population.initial_count)]


def _exchange(lines: Sequence[Lines], rng: np.random.Generator) -> float:
    """The chance of so large a mean change of the share if it does not matter which founder is in which group."""
    observed, null = 0.0, np.zeros(PERMUTATIONS)
    for each in lines:
        weights = each.descendants / each.descendants.sum()
        expected = each.first.mean()
        observed += float(weights @ each.first) - expected
        labels = rng.permuted(np.tile(each.first, (PERMUTATIONS, 1)), axis=1)
        null += labels @ weights - expected
    return float(chance(np.array(observed), null))
