"""Differences between conditions, seed by seed, and the measures of each world that they are made of."""

from collections.abc import Iterator, Sequence
from typing import Any

from hedon.measure.measure import Measure
from hedon.measure.response import at_common_age, common_age, measured
from hedon.statistic.interval import Interval, mean_interval
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.study.census import missing, sentences
from hedon.study.item import Condition, ItemInputs, Scale


def world_rows(
    inputs: ItemInputs, conditions: Sequence[Condition], measures: Sequence[Measure]
) -> list[dict[str, Any]]:
    """One row per world, in the order of the conditions.

    Args:
        inputs: with the worlds that there are.
        conditions: of the study.
        measures: what is measured of each world.

    Returns:
        Columns condition (its label), seed, steps, died_out, one per measure, and until, the age up to which
        lifetimes are averaged where the living are counted [step].
    """
    there = [(each.label, world) for each in conditions for world in inputs.worlds.get(each.label, ())]
    until = common_age(world for _, world in there)
    asked = at_common_age(measures, until)
    return [
        {"condition": label, "seed": world.seed, "steps": world.last_step, "died_out": world.extinct_step is not None}
        | measured(world, asked)
        | {"until": until}
        for label, world in there
    ]


def shown_interval(values: Sequence[float | None], measure: Measure | None = None) -> Interval:
    """Mean and interval over worlds, without bounds below five worlds.

    Args:
        values: one per world; None is left out.
        measure: that they are of, so that the mean of what is compared as a ratio is geometric; None for the plain
            mean.
    """
    known = [value for value in values if value is not None]
    if measure is None or not measure.ratio:
        found = mean_interval(known)
    else:
        logs = mean_interval([measure.scaled(value) for value in known])
        mean, low, high = (measure.unscaled(number) for number in (logs.mean, logs.low, logs.high))
        found = Interval(mean, low, high, logs.worlds)
    return found if found.worlds >= FOR_INTERVAL else Interval(found.mean, None, None, found.worlds)


def read_change(before: str, after: str) -> str:
    """How the rows of `change` are to be read.

    Args:
        before: label of the condition that the change is against.
        after: label of the condition that is changed.
    """
    return (
        f"Means over worlds; change: {after} against {before}, seed by seed, as a difference or, for lifetimes and "
        "rates of food, a ratio (then all means are geometric); its 95 % interval is Student's t over seeds, from "
        "three on. change_low and change_high are the least and the largest of single seeds."
    )


def change(rows: Sequence[dict[str, Any]], measure: Measure, before: str, after: str) -> Iterator[dict[str, Any]]:
    """One measure in two conditions, and its change seed by seed; nothing if neither condition has it.

    Args:
        rows: of `world_rows`.
        measure: one of those that the rows hold.
        before: label of the condition that the change is against.
        after: label of the condition that is changed.
    """
    by_condition = {
        label: {row["seed"]: row[measure.name] for row in rows if row["condition"] == label}
        for label in (before, after)
    }
    means = {label: shown_interval(list(values.values()), measure).mean for label, values in by_condition.items()}
    if all(mean is None for mean in means.values()):
        return
    changes = [
        measure.scaled(value) - measure.scaled(old)
        for seed, value in by_condition[after].items()
        if value is not None and (old := by_condition[before].get(seed)) is not None
    ]
    found = shown_interval(changes)
    low, high = (None, None) if measure.binary else (found.low, found.high)
    values = {"change": found.mean, "low": low, "high": high}
    values |= {"change_low": min(changes, default=None), "change_high": max(changes, default=None)}
    head = {"measure": measure.name} | means | {"scale": "ratio" if measure.ratio else "difference"}
    yield head | {name: measure.unscaled(value) for name, value in values.items()} | {"seeds": len(changes)}


def missing_note(inputs: ItemInputs, conditions: Sequence[Condition], scale: Scale) -> str:
    """Names conditions without worlds, worlds that reach less far than the study's scale, and those that died out.

    Args:
        inputs: with the worlds that there are.
        conditions: of the study.
        scale: how many worlds it wants, and how long.
    """
    parts = [missing(conditions, inputs)]
    worlds = [(condition.label, world) for condition in conditions for world in inputs.worlds.get(condition.label, ())]
    short = [world.last_step for _, world in worlds if world.extinct_step is None and world.last_step < scale.steps]
    if short:
        reach = f"{min(short):,} to {max(short):,}" if min(short) < max(short) else f"{min(short):,}"
        parts.append(f"{len(short)} of {len(worlds)} worlds reach only {reach} of {scale.steps:,} steps.")
    if gone := [f"{label} (seed {world.seed})" for label, world in worlds if world.extinct_step is not None]:
        parts.append(f"Died out, and counted: {', '.join(gone)}.")
    return sentences(*parts)
