"""The population: how many agents there may be and how many there are at first."""

from dataclasses import dataclass
from typing import Annotated

from hedon.config.field import EITHER, Doc, Range


@dataclass(frozen=True, slots=True)
class PopulationConfig:
    """Numbers of agents."""

    capacity: Annotated[
        int,
        Doc("agents that can live at a time; births beyond fail", "agent", EITHER, Range(ge=1, le=100_000)),
    ] = 200
    initial_count: Annotated[
        int,
        Doc("founders, placed uniformly without overlap", "agent", EITHER, Range(ge=1, le=100_000)),
    ] = 50
