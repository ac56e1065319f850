"""Contradictions in what follows time."""

from collections.abc import Iterator, Mapping
from itertools import pairwise

from hedon.config.problem import Problem, format_value, nearest
from hedon.config.schedule import ScheduleConfig


def schedule_problems(
    schedules: Mapping[str, ScheduleConfig], path: str, most: Mapping[str, float]
) -> Iterator[Problem]:
    """Yields what is wrong with the schedules of a section.

    Args:
        schedules: by the name of the setting.
        path: of the section.
        most: the settings that may have a schedule, with the largest factor of each.
    """
    for name, schedule in schedules.items():
        if name not in most:
            rule = "this cannot follow a schedule here: there are " + ", ".join(most)
            yield Problem(f"{path}.{name}", rule, nearest=nearest(name, tuple(most)))
            continue
        points = f"{path}.{name}.points"
        if not schedule.points:
            yield Problem(points, "must have at least one point")
        steps = [step for step, _ in schedule.points]
        if any(second <= first for first, second in pairwise(steps)) or any(step < 0 for step in steps):
            yield Problem(points, "steps must rise, from 0 on", format_value(schedule.points))
        elif schedule.period and steps and steps[-1] >= schedule.period:
            yield Problem(points, f"steps must lie below period = {schedule.period}", format_value(schedule.points))
        for _, factor in schedule.points:
            if not 0 <= factor <= most[name]:
                yield Problem(points, f"factors must be from 0 to {most[name]:g}", format_value(factor))
