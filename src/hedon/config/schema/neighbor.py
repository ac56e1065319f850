"""Queries: who and what is near an agent."""

from dataclasses import dataclass

from hedon.config.field import OURS, setting


@dataclass(frozen=True, slots=True)
class NeighborConfig:
    """A query: who and what is near each agent of a species?

    `[neighbor.NAME]` makes channels. As a step begins: NAME_count, living agents and foods within the range, without
    itself; NAME_kin, those of them that are its parents or children or share a parent with it; NAME_distance [u] of the
    nearest, the range where there is none; NAME_bearing [rad] of the nearest, from −π to π: 0 ahead, positive to the
    left, 0 where there is none. When the step is done: NAME_meals, what the agents that are within the range then ate
    in it. A query of foods alone has neither kin nor meals.
    """

    of: tuple[str, ...] = setting(
        ("*",), 'species and kinds of food that count; "*" for all species', "", OURS, max_items=12, derived=True
    )
    range: float = setting(50.0, "largest distance between two centers", "u", OURS, gt=0, le=1e4, derived=True)
