"""Queries: what rules in Python may ask about the agents near an agent."""

from dataclasses import dataclass

from hedon.config.field import OURS, setting

NUMBERS = ("count", "kin", "distance", "bearing")
"""The numbers of a query, in order; `KIN_count` is one of the query `KIN`."""


@dataclass(frozen=True, slots=True)
class NeighborConfig:
    """A query of the rules of a species: which agents are near each of its own?

    `[neighbor.NAME]` adds to what rules read: NAME_count, living agents within the range, without itself; NAME_kin,
    those of them that are its parents or children or share a parent with it; NAME_distance [u] of the nearest, the
    range where there is none; NAME_bearing [rad] of the nearest, from −π to π: 0 ahead, positive to the left, 0 where
    there is none.
    """

    of: tuple[str, ...] = setting(("*",), 'the species that count; "*" for all', "", OURS, max_items=12, derived=True)
    range: float = setting(
        50.0, "largest distance between the centers of two bodies", "u", OURS, gt=0, le=1e4, derived=True
    )
