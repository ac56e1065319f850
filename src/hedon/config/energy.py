"""The energy of an agent: its amount at birth, its costs, and what a child costs."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import CODE, EITHER, PAPER, setting


@dataclass(frozen=True, slots=True)
class EnergyConfig:
    """Metabolism: energy ← clip(energy + food − action_cost·|force| − basic_cost, 0, capacity)."""

    initial: float = setting(
        40.0, "energy of each founder at the start", "energy", CODE + "; the paper prints 20", ge=0, le=1e6
    )
    capacity: float = setting(
        400.0, "most energy that an agent can hold; energy eaten above it is lost", "energy", CODE, gt=0, le=1e6
    )
    basic_cost: float = setting(1e-3, "cost of living", "energy/step", PAPER, ge=0, le=1e4)
    action_cost: float = setting(
        2e-5, "cost of motor force, per norm of the two forces", "energy/(step·force)", PAPER, ge=0, le=1e4
    )
    birth_share: float = setting(0.4, "share of the parent's energy that a child gets", "", EITHER, ge=0, le=1)
    starvation: Literal["floor", "death"] = setting(
        "floor",
        "if costs exceed the energy: it stays at 0 and the rest is forgiven, or the agent dies",
        "",
        CODE + '; "death" is ours',
    )
