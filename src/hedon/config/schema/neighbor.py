"""Queries about agents and foods near an agent."""

from dataclasses import dataclass

from hedon.config.field import OURS, setting


@dataclass(frozen=True, slots=True)
class NeighborConfig:
    """A query about agents and foods near each agent of a species.

    `[neighbor.NAME]` adds channels. At the start of a step: NAME_count, the number of other living agents and foods
    within the range; NAME_kin, how many of them are its parents, children or siblings (agents that share a parent with
    it); NAME_distance [u] of the nearest, or the range if there is none; NAME_bearing [rad] of the nearest, from −π to
    π: 0 ahead, positive to the left, 0 if there is none. At the end of the step: NAME_meals, the meals in that step of
    the agents then within the range. A query for foods only has neither kin nor meals.
    """

    of: tuple[str, ...] = setting(
        ("*",), 'species and kinds of food that count; "*" for all species', "", OURS, max_items=12, derived=True
    )
    range: float = setting(50.0, "largest distance between two centers", "u", OURS, gt=0, le=1e4, derived=True)
