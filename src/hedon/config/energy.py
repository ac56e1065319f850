"""The energy of an agent: its amount at birth, its costs, and what a child costs."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import CODE, EITHER, PAPER, Doc, Range


@dataclass(frozen=True, slots=True)
class EnergyConfig:
    """Metabolism: energy ← clip(energy + food − action_cost·|force| − basic_cost, 0, capacity)."""

    initial: Annotated[
        float,
        Doc("energy of each founder at the start", "energy", CODE + "; the paper prints 20", Range(ge=0, le=1e6)),
    ] = 40.0
    capacity: Annotated[
        float,
        Doc("most energy that an agent can hold; energy eaten above it is lost", "energy", CODE, Range(gt=0, le=1e6)),
    ] = 400.0
    basic_cost: Annotated[
        float,
        Doc("cost of living", "energy/step", PAPER, Range(ge=0, le=1e4)),
    ] = 1e-3
    action_cost: Annotated[
        float,
        Doc("cost of motor force, per norm of the two forces", "energy/(step·force)", PAPER, Range(ge=0, le=1e4)),
    ] = 2e-5
    birth_share: Annotated[
        float,
        Doc("share of the parent's energy that a child gets", "", EITHER, Range(ge=0, le=1)),
    ] = 0.4
    starvation: Annotated[
        Literal["floor", "death"],
        Doc(
            "if costs exceed the energy: it stays at 0 and the rest is forgiven, or the agent dies",
            "",
            CODE + '; "death" is ours',
        ),
    ] = "floor"
