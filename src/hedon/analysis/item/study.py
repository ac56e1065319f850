"""What the studies share: figures of all worlds of their arms, and a note of what is missing."""

from collections.abc import Sequence
from typing import Any

from hedon.analysis.interval import SHOWN_FROM, Interval, mean_interval
from hedon.analysis.item.census import missing, sentences
from hedon.analysis.item.item import Arm, Material, Scale
from hedon.analysis.response import Response, common_to, figures


def world_rows(material: Material, arms: Sequence[Arm], responses: Sequence[Response]) -> list[dict[str, Any]]:
    """One row per world, in the order of the arms.

    Columns: arm, seed, steps, died_out, one per response, and until, the age up to which lifetimes are averaged where
    the living are counted [step].
    """
    common = common_to(world for arm in arms for world in material.worlds.get(arm.label, ()))
    return [
        {"arm": arm.label, "seed": world.seed, "steps": world.last_step, "died_out": world.extinct_step is not None}
        | figures(world, common, responses)
        | {"until": common.until}
        for arm in arms
        for world in material.worlds.get(arm.label, ())
    ]


def shown_interval(values: Sequence[float | None], response: Response | None = None) -> Interval:
    """Mean and interval over worlds, without bounds below three worlds.

    Args:
        values: one per world; None is left out.
        response: that they are of, so that the mean of what is compared as a ratio is geometric; None for the plain
            mean.
    """
    known = [value for value in values if value is not None]
    if response is None or not response.ratio:
        found = mean_interval(known)
    else:
        logs = mean_interval([response.scaled(value) for value in known])
        mean, low, high = (response.unscaled(number) for number in (logs.mean, logs.low, logs.high))
        found = Interval(mean, low, high, logs.worlds)
    return found if found.worlds >= SHOWN_FROM else Interval(found.mean, None, None, found.worlds)


def missing_note(material: Material, arms: Sequence[Arm], scale: Scale) -> str:
    """Names the arms without worlds, the worlds that reach less far than the study's scale, and those that died out."""
    parts = [missing(arms, material)]
    worlds = [(arm.label, world) for arm in arms for world in material.worlds.get(arm.label, ())]
    short = [world.last_step for _, world in worlds if world.extinct_step is None and world.last_step < scale.steps]
    if short:
        reach = f"{min(short):,} to {max(short):,}" if min(short) < max(short) else f"{min(short):,}"
        parts.append(f"{len(short)} of {len(worlds)} worlds reach only {reach} of {scale.steps:,} steps.")
    if gone := [f"{label} (seed {world.seed})" for label, world in worlds if world.extinct_step is not None]:
        parts.append(f"Died out, and counted: {', '.join(gone)}.")
    return sentences(*parts)
