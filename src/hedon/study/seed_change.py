"""Differences between conditions, seed by seed, and the measures of each world on which they are based."""

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
        inputs: Data with the available worlds.
        conditions: Conditions of the study.
        measures: Measures to compute for each world.

    Returns:
        Columns condition (its label), seed, steps, died_out, one per measure, and until, the age up to which
        lifetimes are averaged if the living are counted [step].
    """
    labelled_worlds = [
        (condition.label, world) for condition in conditions for world in inputs.worlds.get(condition.label, ())
    ]
    until = common_age(world for _, world in labelled_worlds)
    adjusted = at_common_age(measures, until)
    return [
        {"condition": label, "seed": world.seed, "steps": world.last_step, "died_out": world.extinct_step is not None}
        | measured(world, adjusted)
        | {"until": until}
        for label, world in labelled_worlds
    ]


def shown_interval(values: Sequence[float | None], measure: Measure | None = None) -> Interval:
    """The mean and interval over worlds, without bounds for fewer than five worlds.

    Args:
        values: Value of each world; None is ignored.
        measure: Measure of the values, whose mean is geometric if it is compared as a ratio; None for the arithmetic
            mean.
    """
    recorded = [value for value in values if value is not None]
    if measure is None or not measure.ratio:
        interval = mean_interval(recorded)
    else:
        logs = mean_interval([measure.scaled(value) for value in recorded])
        mean, low, high = (measure.unscaled(number) for number in (logs.mean, logs.low, logs.high))
        interval = Interval(mean, low, high, logs.worlds)
    return interval if interval.worlds >= FOR_INTERVAL else Interval(interval.mean, None, None, interval.worlds)


def read_change(before: str, after: str) -> str:
    """A caption that explains the rows of `change`.

    Args:
        before: Label of the reference condition.
        after: Label of the changed condition.
    """
    return (
        f"Means over worlds; change: {after} against {before}, seed by seed, as a difference or, for lifetimes and "
        "rates of food, a ratio (then all means are geometric); its 95 % interval is Student's t over seeds, from "
        "three on. change_low and change_high are the least and the largest of single seeds."
    )


def change(rows: Sequence[dict[str, Any]], measure: Measure, before: str, after: str) -> Iterator[dict[str, Any]]:
    """One measure in two conditions, and its change seed by seed; no rows if neither condition has it.

    Args:
        rows: Rows from `world_rows`.
        measure: One of the measures in the rows.
        before: Label of the reference condition.
        after: Label of the changed condition.
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
    interval = shown_interval(changes)
    low, high = (None, None) if measure.binary else (interval.low, interval.high)
    values = {"change": interval.mean, "low": low, "high": high}
    values |= {"change_low": min(changes, default=None), "change_high": max(changes, default=None)}
    head = {"measure": measure.name} | means | {"scale": "ratio" if measure.ratio else "difference"}
    yield head | {name: measure.unscaled(value) for name, value in values.items()} | {"seeds": len(changes)}


def missing_note(inputs: ItemInputs, conditions: Sequence[Condition], scale: Scale) -> str:
    """A note on conditions without worlds, on worlds shorter than the study's scale, and on worlds that died out.

    Args:
        inputs: Data with the available worlds.
        conditions: Conditions of the study.
        scale: Number and length of the worlds that the study needs.
    """
    parts = [missing(conditions, inputs)]
    worlds = [(condition.label, world) for condition in conditions for world in inputs.worlds.get(condition.label, ())]
    short = [world.last_step for _, world in worlds if world.extinct_step is None and world.last_step < scale.steps]
    if short:
        length = f"{min(short):,} to {max(short):,}" if min(short) < max(short) else f"{min(short):,}"
        parts.append(f"{len(short)} of {len(worlds)} worlds reach only {length} of {scale.steps:,} steps.")
    if extinct_labels := [f"{label} (seed {world.seed})" for label, world in worlds if world.extinct_step is not None]:
        parts.append(f"Died out, and counted: {', '.join(extinct_labels)}.")
    return sentences(*parts)
