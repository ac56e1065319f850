"""The population: its largest size and its size at the start."""

import math
from dataclasses import dataclass
from typing import Annotated

from hedon.config.field import EITHER, OURS, Doc, Range


@dataclass(frozen=True, slots=True)
class PopulationConfig:
    """Numbers of agents."""

    capacity: Annotated[
        int,
        Doc("most agents alive at the same time; further births fail", "agent", EITHER, Range(ge=1, le=100_000)),
    ] = 200
    initial_count: Annotated[
        int,
        Doc("number of founders, placed uniformly without overlap", "agent", EITHER, Range(ge=0, le=100_000)),
    ] = 50
    heading_range: Annotated[
        float,
        Doc(
            "founders' headings are uniform from 0 to this",
            "rad",
            OURS + "; the code has 1",
            Range(ge=0, le=6.2832),
        ),
    ] = math.tau
