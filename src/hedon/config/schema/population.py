"""The population: its maximum size and its initial size."""

import math
from dataclasses import dataclass

from hedon.config.field import EITHER, OURS, setting


@dataclass(frozen=True, slots=True)
class PopulationConfig:
    """Numbers of agents."""

    capacity: int = setting(
        200, "most agents alive at the same time; further births fail", "agent", EITHER, ge=1, le=100_000
    )
    initial_count: int = setting(
        50, "number of founders, placed uniformly without overlap", "agent", EITHER, ge=0, le=100_000
    )
    heading_range: float = setting(
        math.tau, "founders' headings are uniform from 0 to this", "rad", OURS + "; the code has 1", ge=0, le=6.2832
    )
