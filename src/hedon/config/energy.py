"""The energy of an agent: what it starts with, what it pays and what a child costs."""

from dataclasses import dataclass
from typing import Annotated, Literal

from hedon.config.field import CODE, EITHER, PAPER, Doc, Range


@dataclass(frozen=True, slots=True)
class EnergyConfig:
    """Metabolism: energy ← clip(energy + food − action_cost·|force| − basic_cost, 0, capacity)."""

    initial: Annotated[
        float,
        Doc("of each founder", "energy", CODE + "; the paper prints 20", Range(ge=0, le=1e6)),
    ] = 40.0
    capacity: Annotated[
        float,
        Doc("most that an agent can hold; what is eaten beyond is lost", "energy", CODE, Range(gt=0, le=1e6)),
    ] = 400.0
    basic_cost: Annotated[
        float,
        Doc("of living", "energy/step", PAPER, Range(ge=0, le=1e4)),
    ] = 1e-3
    action_cost: Annotated[
        float,
        Doc("of the norm of the two motor forces", "energy/(step·force)", PAPER, Range(ge=0, le=1e4)),
    ] = 2e-5
    birth_share: Annotated[
        float,
        Doc("share of the parent's energy that a child gets", "", EITHER, Range(ge=0, le=1)),
    ] = 0.4
    starvation: Annotated[
        Literal["floor", "death"],
        Doc(
            "below zero: energy stays at 0 and the rest is forgiven, or the agent dies",
            "",
            CODE + '; "death" is ours',
        ),
    ] = "floor"
