"""Food: one section per kind. The order of the kinds is the order of sensor channels and genome weights."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from hedon.config.evolution import GeneConfig
from hedon.config.field import CODE, DERIVED, EITHER, OURS, PAPER, Doc, Range, Table
from hedon.config.room import MAX_FACTOR
from hedon.config.schedule import ScheduleConfig


@dataclass(frozen=True, slots=True)
class PlacementConfig:
    """Where new food of a kind appears."""

    form: Annotated[
        Literal["uniform", "gaussian", "switching", "mixture", "rectangle"],
        Doc(
            "everywhere; around one center; around one of several centers in turn, or of any by a draw; in a rectangle "
            "around one center",
            "",
            PAPER + "; mixture and rectangle are ours",
        ),
    ] = "uniform"
    centers: Annotated[
        tuple[tuple[float, float], ...],
        Doc(
            "centers: one for gaussian and rectangle, at least two for switching and mixture",
            "u",
            CODE,
            Range(max_items=16, each=(0, 1e5)),
        ),
    ] = ()
    sd: Annotated[
        tuple[float, float],
        Doc(
            "standard deviations of the Gaussians, or half sides of the rectangle, along x and y",
            "u",
            CODE,
            Range(each=(0, 1e5)),
        ),
    ] = (0.0, 0.0)
    switch_after: Annotated[
        int,
        Doc(
            "food of this kind eaten before the next center is used",
            "food",
            PAPER,
            Range(ge=1, le=1_000_000_000),
        ),
    ] = 1000
    drift: Annotated[
        tuple[float, float],
        Doc("how the centers move; at the end of the arena they stop", "u/step", OURS, Range(each=(-1e4, 1e4))),
    ] = (0.0, 0.0)
    spacing: Annotated[
        float,
        Doc("least distance between two foods of the kind", "u", OURS, Range(ge=0, le=1e4)),
    ] = 0.0


@dataclass(frozen=True, slots=True)
class FoodConfig:
    """One kind of food. `[food.<kind>.schedule.growth_rate]` and `.capacity` make these follow time."""

    energy: Annotated[
        float,
        Doc("energy gained by eating one piece", "energy", PAPER, Range(ge=-1e4, le=1e4)),
    ] = 1.0
    nutrient: Annotated[
        float,
        Doc("nutrient gained by eating one piece", "nutrient", OURS, Range(ge=0, le=1e4), shapes=True),
    ] = 0.0
    toxin: Annotated[
        float,
        Doc(
            "toxin that one piece leaves", "toxin", OURS + "; the paper's code has 10", Range(ge=0, le=1e4), shapes=True
        ),
    ] = 0.0
    growth_rate: Annotated[
        float,
        Doc(
            "growth of the supply",
            "food/step",
            CODE + "; the paper prints 0.02, the code's rounding amounts to 1",
            Range(ge=0, le=1000),
        ),
    ] = 0.2
    capacity: Annotated[
        int,
        Doc("size of the supply at which growth stops", "food", PAPER, Range(ge=0, le=100_000)),
    ] = 100
    initial_count: Annotated[
        int,
        Doc("size of the supply, and food present, at the start", "food", EITHER, Range(ge=0, le=100_000)),
    ] = 20
    candidates: Annotated[
        int,
        Doc(
            "random places tried for new food in each step; if none is free, the food waits",
            "",
            EITHER,
            Range(ge=1, le=10_000),
        ),
    ] = 10
    color: Annotated[
        str,
        Doc("color in figures; agents do not see it", "", OURS, Range(form="#rrggbb")),
    ] = "#3f8f4f"
    placement: PlacementConfig = field(default_factory=PlacementConfig)
    gene: Annotated[GeneConfig, DERIVED] = field(default_factory=GeneConfig)
    schedule: Annotated[dict[str, ScheduleConfig], Table(names={"growth_rate": MAX_FACTOR, "capacity": 1.0})] = field(
        default_factory=dict
    )
