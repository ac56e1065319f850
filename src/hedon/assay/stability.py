"""Does evolution stay at a claimed end point if it starts there?"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hedon.analysis.gene.course import WorldCourse, world_course
from hedon.analysis.world.record import SEED, generator
from hedon.assay.resample import Floats
from hedon.assay.sample import Sample
from hedon.statistic.correction import holm
from hedon.statistic.drift import rank_score, score_tests
from hedon.statistic.interval import Interval, mean_interval
from hedon.statistic.law import normal_below

TIMES = 50
"""Number of intervals in a course."""
ALPHA = 0.05
VERDICTS = {
    "leaves": "moved further in one direction than neutral genes of the same pedigrees do",
    "held": "moved less than neutral genes do",
    "as drift": "moved as far as neutral genes do: this run cannot tell",
}


@dataclass(frozen=True, eq=False)
class WeightCourse:
    """One weight over time in all worlds that started at one point.

    Attributes:
        gene: Genome column of the weight.
        start: Mean of the founders' distribution.
        step: Moments [step], shape (times,).
        mean: Mean over the living of each world, shape (worlds, times); NaN after a world died out.
        null: 95 % bounds of the mean over worlds of neutral genes with the same start, shape (2, times).
        end: Mean over worlds at the end, with Student's interval.
        score: Mean standard normal score of the end among neutral genes.
        p: Two-sided p value of the score under drift (Stouffer).
        p_held: Chance of ends as close to the start, or closer, under drift.
        p_holm, p_held_holm: The two p values, corrected for both tests of all reward genes and starts; for a neutral
            gene, only for its own two tests.
        verdict: One of `VERDICTS`, from the corrected p values.
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
    """The worlds that started at one point.

    Attributes:
        name: Name of the start.
        point: Means of the founders' reward genes, by column.
        worlds: Number of worlds.
        extinct: Number of worlds that died out.
        generations: Generations at the end, averaged over worlds.
        courses: Course of each weight and neutral gene, by column.
        seeds: Seeds of the worlds in the courses.
    """

    name: str
    point: Mapping[str, float]
    worlds: int
    extinct: int
    generations: float
    courses: Mapping[str, WeightCourse]
    seeds: tuple[int, ...]


def measure_stability(sample: Sample) -> Stability:
    """Measures the courses of all weights in finished worlds."""
    worlds, steps = sample.worlds, sample.steps
    all_courses = [world_course(world, steps / TIMES, generator(world)) for world in worlds]
    courses = [course for course in all_courses if course is not None]
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
        seeds=tuple(world.seed for world, course in zip(worlds, all_courses, strict=True) if course is not None),
    )


def weight_course(name: str, start: float, step: Floats, courses: Sequence[WorldCourse]) -> WeightCourse:
    """One weight over time in the worlds that have a course.

    Args:
        name: Genome column of the weight.
        start: Mean of the founders' distribution.
        step: Moments [step], shape (times,).
        courses: Course of each world.

    Returns:
        The course, without a verdict. Its p values are NaN if no world has a course, or the gene cannot change.
    """
    mean = np.full((len(courses), len(step)), np.nan)
    for row, course in zip(mean, courses, strict=True):
        row[: len(course.mean[name])] = course.mean[name]
    walk_count = min((len(course.neutral[name]) for course in courses), default=0)
    null = np.full((walk_count, len(step)), np.nan)
    if courses:
        stacked = np.full((len(courses), walk_count, len(step)), np.nan)
        for block, course in zip(stacked, courses, strict=True):
            block[:, : course.neutral[name].shape[1]] = course.neutral[name][:walk_count]
        null = mean_over_worlds(stacked)
    rng = np.random.default_rng(SEED)
    ends = [(course.mean[name][-1], course.neutral[name][:, -1]) for course in courses]
    direction, _, _ = score_tests(np.array([rank_score(end, neutral, rng) for end, neutral in ends], float))
    held = np.array([rank_score(abs(end - start), np.abs(neutral - start), rng) for end, neutral in ends], float)
    return WeightCourse(
        gene=name,
        start=start,
        step=step,
        mean=mean,
        null=np.quantile(null, (0.025, 0.975), axis=0) if walk_count else np.full((2, len(step)), np.nan),
        end=mean_interval([course.mean[name][-1] for course in courses]),
        score=direction.effect,
        p=direction.p,
        p_held=_held_chance(held[np.isfinite(held)]),
    )


def mean_over_worlds(values: Floats) -> Floats:
    """The mean over the first axis of the values that are not NaN; NaN if there are none."""
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def judge(starts: Sequence[Stability]) -> list[Stability]:
    """Adds verdicts after Holm correction; both tests of every reward gene and start form one family."""
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


def _held_chance(scores: Floats) -> float:
    """The chance of such small scores, all worlds together (Stouffer); NaN without any."""
    return normal_below(scores.sum() / math.sqrt(len(scores))) if len(scores) else math.nan
