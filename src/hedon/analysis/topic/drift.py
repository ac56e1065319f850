"""Topics on drift: weights against neutral genes, mean reversion along a run, modes over worlds."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from hedon.analysis.gene.course import WorldCourse, standard_courses
from hedon.analysis.gene.drift import drift_tests, standard_drift
from hedon.analysis.gene.pedigree import like_neutral
from hedon.analysis.gene.weight import end_mean
from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.world.record import SEED, Conditions, labels, with_roles
from hedon.statistic.correction import holm
from hedon.statistic.minimum import FOR_VERDICT
from hedon.statistic.mode import modes
from hedon.statistic.reversion import Reversion, is_usable, reversion


def drift(conditions: Conditions) -> list[ResultTable]:
    """Each weight against drift."""
    world_rows, rows = [], []
    for condition, worlds in conditions.items():
        drifts = [standard_drift(world) for world in worlds]
        for world, results in zip(worlds, drifts, strict=True):
            world_rows += [labels(world) | asdict(result) for result in results]
        names = worlds[0].reward_names, worlds[0].neutral_names
        tests = drift_tests(drifts, *names, like_neutral(worlds[0]), np.random.default_rng(SEED))
        rows += [{"condition": condition, "weight": test.weight} | asdict(test) for test in tests]
    note = (
        "direction: mean score against neutral genes walked down the recorded pedigree, in standard deviations of "
        "drift; drift_low and drift_high are its bounds by the spread of drift itself, as p takes it. distance and "
        "held: root mean square score, 1 under drift, with the chance of a larger one (distance) or of a smaller one "
        "(held). A weight that cannot change has no test. recorded: how much further the weight moved than the neutral "
        "genes of its founders and mutations, if there are any. p_holm is corrected for all reward weights and tests "
        "of one control; neutral genes are there as a check."
    )
    return [
        make_table("drift", "Weights of those alive at the end against drift", with_roles(rows, conditions), note),
        make_table("drift_world", "Weights against drift, world by world", world_rows, shown=False),
    ]


def reversion_topic(conditions: Conditions) -> list[ResultTable]:
    """Mean reversion of each weight, over the worlds of a condition and in each of them."""
    rows, world_rows = [], []
    for condition, worlds in conditions.items():
        pairs = zip(worlds, standard_courses(worlds), strict=True)
        courses = {world: course for world, course in pairs if course is not None}
        estimates_by_world = {world: _rows([course], world.weight_names) for world, course in courses.items()}
        world_rows += [labels(world) | row for world, estimates in estimates_by_world.items() for row in estimates]
        pooled = (
            next(iter(estimates_by_world.values()))
            if len(estimates_by_world) == 1
            else _rows([*courses.values()], worlds[0].weight_names)
        )
        neutral = worlds[0].neutral_names
        corrected = holm([float("nan") if row["weight"] in neutral else row["p"] for row in pooled])
        rows += [{"condition": condition} | row | {"p_holm": p} for row, p in zip(pooled, corrected, strict=True)]
    note = (
        "An Ornstein-Uhlenbeck process with one optimum and one strength for all worlds, fitted to the mean weight of "
        "the living at equal intervals. strength: share of the distance to the optimum that is gone after a "
        "generation, for small numbers; 0 is Brownian motion. p: chance of a pull this strong among neutral genes "
        "walked down the same pedigrees; p_holm is corrected for all reward weights. The optimum is given if p is "
        "at most 0.05 and the strength is above 0. Neutral genes are there as a check."
    )
    return [
        make_table("reversion", "Is a weight held near a value?", rows, note),
        make_table("reversion_world", "Mean reversion, world by world", world_rows, shown=False),
    ]


def mode(conditions: Conditions) -> list[ResultTable]:
    """Test for one mode or two, over worlds."""
    rows = []
    for condition, worlds in conditions.items():
        for name in worlds[0].weight_names:
            means = [end_mean(name, world) for world in worlds if world.extinct_step is None]
            result = modes(np.array([mean for mean in means if mean is not None], np.float64))
            rows.append({"condition": condition, "weight": name} | asdict(result))
    note = (
        "Dip test over worlds that live. power: chance to find two modes six standard deviations apart with as many "
        f"worlds, 0.8 with {FOR_VERDICT}. That no second mode is found does not show that there is one."
    )
    return [make_table("mode", "Modes of the worlds' mean weights", rows, note)]


def _rows(courses: Sequence[WorldCourse], weights: Sequence[str]) -> list[dict[str, Any]]:
    """One row per weight, with strengths per generation."""
    rows = []
    for weight in weights:
        usable = [course for course in courses if is_usable(course.mean[weight])]
        generations = sum(course.generations for course in usable)
        estimate = reversion([c.mean[weight] for c in usable], [c.neutral[weight] for c in usable])
        if estimate is not None and generations > 0:
            rows.append({"weight": weight} | _per_generation(estimate, generations))
    return rows


def _per_generation(estimate: Reversion, generations: float) -> dict[str, Any]:
    factor = estimate.intervals / generations
    strengths = {name: getattr(estimate, name) * factor for name in ("strength", "strength_low", "strength_high")}
    return {
        "worlds": estimate.worlds,
        "generations": generations / estimate.worlds,
        "optimum": estimate.optimum,
        "optimum_low": estimate.optimum_low,
        "optimum_high": estimate.optimum_high,
        **strengths,
        "p": estimate.p,
    }
