"""Topics on single lives: lifetime, food, reproduction, generation, energy."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hedon.analysis.agent.cohort import COMPLETE
from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.agent.lifetime import durations
from hedon.analysis.agent.reproduction import reproduction
from hedon.analysis.descent.generation import generation_time
from hedon.analysis.result import ResultTable, make_table, over_worlds
from hedon.analysis.topic.cohort import cohort_rows, complete_cohorts, incomplete_note, world_means
from hedon.analysis.world.budget import energy_budget
from hedon.analysis.world.population import run_tail
from hedon.analysis.world.record import Conditions, WorldRecord, labels
from hedon.statistic.interval import AMOUNT, ANY, SHARE, Interval, mean_interval
from hedon.statistic.survival import SurvivalCurve, exposure_mean, restricted_mean, survival_curve

_AGES = 200  # points of a survival curve in the written tables


def lifetime(conditions: Conditions) -> list[ResultTable]:
    """Lifetimes; agents still alive count as censored."""
    rows, curves, medians = [], [], []
    for condition, worlds in conditions.items():
        lives = [durations(world.born, world.last_step) for world in worlds]
        fitted = [survival_curve(*life) for life in lives]
        until = _common_age(worlds, fitted)
        for world, life, curve in zip(worlds, lives, fitted, strict=True):
            rows.append(labels(world) | _life_row(*life, curve, until))
            curves += [labels(world) | point for point in _points(curve)]
        medians += _median_rows(condition, lives, fitted)
    worlds_table = make_table("lifetime_world", "Lifetimes, world by world [step]", rows, shown=False)
    quantities = {
        "mean_of_dead": "mean of the dead",
        "restricted_mean": "restricted mean, censored lives counted",
        "restricted_bias": "error of the dead's restricted mean",
        "exposure_mean": "steps lived per death",
    }
    within = {name: AMOUNT for name in quantities if name != "restricted_bias"}
    summary = over_worlds(worlds_table.rows, (), quantities, within) + medians
    note = (
        "The restricted mean is that of lifetimes cut off at an age that 20 agents of each living world reached; the "
        "error is what the dead alone give instead, minus it. Steps per death are the mean life if age did not matter. "
        "Of a branch only those count that were born in it."
    )
    return [
        make_table("lifetime", "Lifetimes, means over worlds [step]", summary, note),
        worlds_table,
        make_table(
            "survival", "Survival curves (Kaplan and Meier, with pointwise 95 % intervals)", curves, shown=False
        ),
    ]


def food(conditions: Conditions) -> list[ResultTable]:
    """Foods and agents eaten, by both rules of averaging, for everything that a world's agents may eat."""
    rows = [
        labels(world)
        | {
            "kind": kind,
            "per_agent": food_per_step(world.agents, [kind]),
            "per_step": food_per_agent_step(world.population, [kind]),
        }
        for worlds in conditions.values()
        for world in worlds
        for kind in (*world.food_kinds, *world.prey)
    ]
    worlds_table = make_table("food_world", "Food, world by world [1/step]", rows, shown=False)
    quantities = {"per_agent": "mean over the dead of foods / lifetime", "per_step": "all foods / all steps lived"}
    note = (
        "The first rule, the paper's as we read it, counts a short life as much as a long one; the second is what is "
        "eaten in a step."
    )
    summary = over_worlds(worlds_table.rows, ("kind",), quantities, AMOUNT)
    return [make_table("food", "Food, means over worlds [1/step]", summary, note), worlds_table]


def reproductive_success(conditions: Conditions) -> list[ResultTable]:
    """Children per life, by birth cohort."""
    rows = cohort_rows(conditions, lambda _world, cohort: [reproduction(cohort)])
    worlds_table = make_table("reproduction_world", "Children per life, by world and birth cohort", rows, shown=False)
    quantities = {
        "mean": "children per life",
        "opportunity": "opportunity for selection",
        "childless": "share without children",
        "top_tenth": "share of children of the top tenth",
    }
    within = dict.fromkeys(quantities, AMOUNT) | dict.fromkeys(("childless", "top_tenth"), SHARE)
    by_world = world_means(complete_cohorts(worlds_table.rows), (), tuple(quantities))
    summary = over_worlds(by_world, (), quantities, within)
    note = (
        f"Over cohorts of which at least {100 * COMPLETE:.0f} % have died. If children came by chance alone, in "
        "lives of exponential length, the opportunity would be 1 + 1 / mean."
    ) + incomplete_note(worlds_table.rows)
    return [
        make_table("reproduction", "Children per life, means over worlds", summary, note),
        worlds_table,
    ]


def generation(conditions: Conditions) -> list[ResultTable]:
    """Generations and generation time."""
    rows = [
        labels(world) | generation_time(world.agents, world.last_step)
        for worlds in conditions.values()
        for world in worlds
    ]
    worlds_table = make_table("generation_world", "Generations, world by world", rows, shown=False)
    quantities = {
        "reached": "mean generation of the living",
        "parent_age": "age of parents at a birth [step]",
        "line_time": "steps per generation reached",
    }
    summary = over_worlds(worlds_table.rows, (), quantities, AMOUNT)
    return [make_table("generation", "Generations, means over worlds", summary), worlds_table]


def energy(conditions: Conditions) -> list[ResultTable]:
    """Energy budgets, over the whole run and over its last tenth."""
    rows = []
    for worlds in conditions.values():
        for world in worlds:
            for part, population in (("whole run", world.population), ("last tenth", run_tail(world.population))):
                budget = energy_budget(population)
                if budget is not None:
                    rows.append(labels(world) | {"part": part} | budget)
    worlds_table = make_table("energy_world", "Energy budgets, world by world", rows, shown=False)
    names = ["eaten", "basic", "action", "forgiven", "capped", "lost", "shared"]
    names += [name for name in ("hunted", "damage") if name in worlds_table.rows.columns]
    quantities = {name: name for name in names} | {"forgiven_share": "share forgiven"}
    within = dict.fromkeys(quantities, AMOUNT) | {"eaten": ANY, "forgiven_share": SHARE}
    summary = over_worlds(worlds_table.rows, ("part",), quantities, within)
    note = (
        "Eaten: taken up with food; poison counts negative. Basic and action: charged for living and for acting. "
        "Forgiven: charged but not paid, because energy cannot fall below 0; its share is that of all charges. Capped: "
        "eaten, but destroyed because the agent was full. Lost: held by those who died. Shared: given by parents to "
        "their children, so that it stays in the world."
    )
    explanations = {
        "hunted": " Hunted: gained by eating agents, whose own energy is among what their species lost.",
        "damage": " Damage: charged for touching obstacles.",
    }
    note += "".join(sentence for name, sentence in explanations.items() if name in quantities)
    title = "Energy budget per 1000 steps lived by an agent, means over worlds"
    return [make_table("energy", title, summary, note), worlds_table]


def _median_rows(
    condition: str, lives: Sequence[tuple[np.ndarray, np.ndarray]], curves: Sequence[SurvivalCurve]
) -> list[dict[str, Any]]:
    """Median lifetime over worlds, or of all worlds pooled if some have none yet; no row if that is unknown too.

    A mean over only the worlds with a median would leave out those with long lives.
    """
    medians = [curve.quantile()[0] for curve in curves]
    head = {"condition": condition}
    if all(median is not None for median in medians):
        return [head | {"quantity": "median"} | vars(mean_interval(medians, within=AMOUNT))]
    duration, died = (np.concatenate(arrays) for arrays in zip(*lives, strict=True))
    pooled = survival_curve(duration, died).quantile()[0]
    if pooled is None:
        return []
    return [head | {"quantity": "median of all worlds together"} | vars(Interval(pooled, None, None, len(curves)))]


def _common_age(worlds: Sequence[WorldRecord], curves: Sequence[SurvivalCurve]) -> float:
    """Age up to which all these curves are used [step]; 0 if no agent died.

    In an extinct world no life is censored, so it sets no limit while others are alive.
    """
    ages = {world.seed: curve.trusted_age() for world, curve in zip(worlds, curves, strict=True)}
    living = [ages[world.seed] for world in worlds if world.extinct_step is None]
    return min(filter(None, living), default=0.0) or min(filter(None, ages.values()), default=0.0)


def _life_row(duration: np.ndarray, died: np.ndarray, curve: SurvivalCurve, until: float) -> dict:
    dead = duration[died]
    area = restricted_mean(curve, until)
    median, low, high = curve.quantile()
    restricted_dead = float(np.minimum(dead, until).mean()) if len(dead) else None
    return {
        "agents": len(duration),
        "died": len(dead),
        "mean_of_dead": float(dead.mean()) if len(dead) else None,
        "restricted_mean": area.mean if until else None,
        "restricted_error": area.error if until else None,
        "until": until,
        "restricted_bias": restricted_dead - area.mean if restricted_dead is not None and until else None,
        "exposure_mean": exposure_mean(duration, died),
        "median": median,
        "median_low": low,
        "median_high": high,
    }


def _points(curve: SurvivalCurve) -> list[dict]:
    """The curve from birth on, thinned to equal steps of age."""
    if not len(curve.age):
        return []
    ages = np.linspace(0.0, curve.age[-1], _AGES)
    indices = np.searchsorted(curve.age, ages, side="right") - 1
    return [
        {
            "age": float(age),
            "share": float(curve.share[i]) if i >= 0 else 1.0,
            "low": float(curve.low[i]) if i >= 0 else 1.0,
            "high": float(curve.high[i]) if i >= 0 else 1.0,
        }
        for age, i in zip(ages, indices, strict=True)
    ]
