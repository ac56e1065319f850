"""Evolution from a claimed end point: does it stay there?"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hedon.analysis.gene.course import WorldCourse, world_course
from hedon.analysis.world.record import SEED, generator
from hedon.assay.resample import Floats
from hedon.assay.sample import Sample
from hedon.statistic.correction import holm
from hedon.statistic.drift import rank_score
from hedon.statistic.interval import Interval, mean_interval
from hedon.statistic.law import normal_above, normal_below

TIMES = 50
"""Intervals of a course."""
ALPHA = 0.05
VERDICTS = {
    "leaves": "moved further in one direction than neutral genes of the same pedigrees do",
    "held": "moved less than neutral genes do",
    "as drift": "moved as far as neutral genes do: this run cannot tell",
}


@dataclass(frozen=True, eq=False)
class WeightCourse:
    """One weight over time in all worlds that began at one point.

    Attributes:
        gene: column.
        start: mean of the founders' law.
        step: moments [step], (times,).
        mean: over the living of each world, (worlds, times); NaN after a world died out.
        null: bounds between which 95 % of neutral genes' means over worlds lie that begin as it does, (2, times).
        end: mean over worlds at the end, with Student's interval.
        score: mean standard normal score of the end among neutral genes.
        p: two-sided chance of such a score under drift (Stouffer).
        p_held: chance of ends as close to the start, or closer, under drift.
        p_holm, p_held_holm: corrected for both tests of all reward genes and starts; for a neutral gene, for its two.
        verdict: one of `VERDICTS`, by the corrected chances.
    """

    gene: str
    start: float
    step: Floats
    mean: Floats
    null: Floats
    end: Interval
    score: float
    p: float
    p_held: float
    p_holm: float = math.nan
    p_held_holm: float = math.nan
    verdict: str = "as drift"


@dataclass(frozen=True, eq=False)
class Stability:
    """The worlds that began at one point.

    Attributes:
        name: of the start.
        point: means of the founders' reward genes, by column.
        worlds: how many.
        extinct: how many died out.
        generations: mean over worlds.
        courses: of each weight, neutral genes too, by column.
        seeds: of the worlds in the courses.
    """

    name: str
    point: Mapping[str, float]
    worlds: int
    extinct: int
    generations: float
    courses: Mapping[str, WeightCourse]
    seeds: tuple[int, ...]


def measure_stability(sample: Sample) -> Stability:
    """Where the weights of finished worlds went."""
    worlds, steps = sample.worlds, sample.steps
    found = [world_course(world, steps / TIMES, generator(world)) for world in worlds]
    courses = [course for course in found if course is not None]
    names = worlds[0].weight_names
    step = np.arange(TIMES + 1) * steps / TIMES
    weights = {name: weight_course(name, worlds[0].gene(name).law.initial_mean, step, courses) for name in names}
    return Stability(
        name=sample.demand.name,
        point={name: worlds[0].gene(name).law.initial_mean for name in worlds[0].reward_names},
        worlds=len(worlds),
        extinct=sum(world.extinct_step is not None for world in worlds),
        generations=float(np.mean([course.generations for course in courses])) if courses else 0.0,
        courses=weights,
        seeds=tuple(world.seed for world, course in zip(worlds, found, strict=True) if course is not None),
    )


def weight_course(name: str, start: float, step: Floats, courses: Sequence[WorldCourse]) -> WeightCourse:
    """One weight over time in the worlds that have a course.

    Args:
        name: Column of the gene.
        start: Mean of the founders' law.
        step: Moments [step], (times,).
        courses: One per world.

    Returns:
        The course, without verdict. Its `p` are NaN where no world can tell: no course, or a gene that cannot change.
    """
    mean = np.full((len(courses), len(step)), np.nan)
    for row, course in zip(mean, courses, strict=True):
        row[: len(course.mean[name])] = course.mean[name]
    walks = min((len(course.neutral[name]) for course in courses), default=0)
    null = np.full((walks, len(step)), np.nan)
    if courses:
        stacked = np.full((len(courses), walks, len(step)), np.nan)
        for block, course in zip(stacked, courses, strict=True):
            block[:, : course.neutral[name].shape[1]] = course.neutral[name][:walks]
        living = np.isfinite(stacked).sum(axis=0)
        null = np.where(living > 0, np.nansum(stacked, axis=0) / np.maximum(living, 1), np.nan)
    rng = np.random.default_rng(SEED)
    ends = [(course.mean[name][-1], course.neutral[name][:, -1]) for course in courses]
    scores = _known([rank_score(end, neutral, rng) for end, neutral in ends])
    held = _known([rank_score(abs(end - start), np.abs(neutral - start), rng) for end, neutral in ends])
    return WeightCourse(
        gene=name,
        start=start,
        step=step,
        mean=mean,
        null=np.quantile(null, (0.025, 0.975), axis=0) if walks else np.full((2, len(step)), np.nan),
        end=mean_interval([course.mean[name][-1] for course in courses]),
        score=float(scores.mean()) if len(scores) else math.nan,
        p=_two_sided(scores),
        p_held=_below(held),
    )


def _known(scores: Sequence[float]) -> Floats:
    """The scores without NaN, which a gene has that cannot change."""
    every = np.array(scores, float)
    return every[np.isfinite(every)]


def judge(starts: Sequence[Stability]) -> list[Stability]:
    """The same starts with verdicts, corrected by Holm: both tests of every reward gene and start are one family."""
    reward = [(start.name, name) for start in starts for name in start.point]
    courses = {(start.name, name): course for start in starts for name, course in start.courses.items()}
    corrected = _corrected([courses[key] for key in reward])
    judged = dict(zip(reward, corrected, strict=True))
    judged |= {key: _corrected([course])[0] for key, course in courses.items() if key not in judged}
    return [replace(start, courses={name: judged[start.name, name] for name in start.courses}) for start in starts]


def _corrected(courses: Sequence[WeightCourse]) -> list[WeightCourse]:
    p = holm([chance for course in courses for chance in (course.p, course.p_held)])
    return [
        replace(
            course,
            p_holm=leaves,
            p_held_holm=held,
            verdict="leaves" if leaves < ALPHA else "held" if held < ALPHA else "as drift",
        )
        for course, leaves, held in zip(courses, p[::2], p[1::2], strict=True)
    ]


def _two_sided(scores: Floats) -> float:
    return float(2.0 * normal_above(abs(_combined(scores))))


def _below(scores: Floats) -> float:
    return normal_below(_combined(scores))


def _combined(scores: Floats) -> float:
    """The standard normal score of all worlds together (Stouffer); NaN without any."""
    return scores.sum() / math.sqrt(len(scores)) if len(scores) else math.nan
