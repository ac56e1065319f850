"""Food: one section per kind. The order of the kinds is the order of sensor channels and genome weights."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, section, setting
from hedon.config.room import MAX_FACTOR, MAX_STORES
from hedon.config.schema.evolution import GeneConfig
from hedon.config.schema.schedule import ScheduleConfig


@dataclass(frozen=True, slots=True)
class PlacementConfig:
    """Where new food of a kind appears."""

    form: Literal["uniform", "gaussian", "switching", "mixture", "rectangle"] = setting(
        "uniform",
        "everywhere; around one center; around one of several centers in turn, or of any by a draw; in a rectangle "
        "around one center",
        "",
        PAPER + "; mixture and rectangle are ours",
    )
    centers: tuple[tuple[float, float], ...] = setting(
        (),
        "centers: one for gaussian and rectangle, at least two for switching and mixture",
        "u",
        CODE,
        max_items=16,
        each=(0, 1e5),
    )
    sd: tuple[float, float] = setting(
        (0.0, 0.0),
        "standard deviations of the Gaussians, or half sides of the rectangle, along x and y",
        "u",
        CODE,
        each=(0, 1e5),
    )
    switch_after: int = setting(
        1000, "food of this kind eaten before the next center is used", "food", PAPER, ge=1, le=1_000_000_000
    )
    drift: tuple[float, float] = setting(
        (0.0, 0.0), "how the centers move; at the end of the arena they stop", "u/step", OURS, each=(-1e4, 1e4)
    )
    spacing: float = setting(0.0, "least distance between two foods of the kind", "u", OURS, ge=0, le=1e4)


@dataclass(frozen=True, slots=True)
class FoodConfig:
    """A kind of food. `[food.<kind>.schedule.growth_rate]` and `.capacity` make these settings vary with time."""

    gives: dict[str, float] = setting(
        {"energy": 1.0},
        "by store, what one piece adds to it, or takes if negative; a factor of `diet.eats` is on energy alone",
        "amount",
        PAPER + " for energy",
        max_items=MAX_STORES,
        each=(-1e4, 1e4),
    )
    needs: dict[str, float] = setting(
        {},
        "by store, how much an agent must hold to eat a piece; it is not used up, and who lacks it leaves the food",
        "amount",
        OURS,
        max_items=MAX_STORES,
        each=(0, 1e6),
    )
    growth_rate: float = setting(
        0.2,
        "growth of the supply",
        "food/step",
        CODE + "; the paper prints 0.02, the code's rounding amounts to 1",
        ge=0,
        le=1000,
    )
    capacity: int = setting(100, "size of the supply at which growth stops", "food", PAPER, ge=0, le=100_000)
    initial_count: int = setting(
        20, "size of the supply, and food present, at the start", "food", EITHER, ge=0, le=100_000
    )
    candidates: int = setting(
        10,
        "random places tried for new food in each step; if none is free, the food waits",
        "",
        EITHER,
        ge=1,
        le=10_000,
    )
    looks_like: str = setting(
        "",
        "another kind that agents see where this one is, by rays alone; empty: it looks like itself",
        "",
        OURS,
        derived=True,
    )
    color: str = setting("#3f8f4f", "color in figures; agents do not see it", "", OURS, form="#rrggbb")
    placement: PlacementConfig = section(PlacementConfig)
    gene: GeneConfig = section(GeneConfig, derived=True)
    schedule: dict[str, ScheduleConfig] = section(names={"growth_rate": MAX_FACTOR, "capacity": 1.0})
