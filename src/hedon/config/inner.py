"""Inner states beside energy: a second nutrient, and a toxin."""

from dataclasses import dataclass
from typing import Annotated

from hedon.config.field import OURS, Doc, Range

CODE = OURS + "; the paper's code has this value"


@dataclass(frozen=True, slots=True)
class NutrientConfig:
    """A second store: store ← clip(store + Σ nutrient·eaten − action_cost·|force| − basic_cost, 0, capacity).

    A species has it if it eats a kind of food with `nutrient` above 0. A child gets `energy.birth_share` of it.
    """

    initial: Annotated[
        float,
        Doc("nutrient of each founder at the start", "nutrient", CODE, Range(ge=0, le=1e6)),
    ] = 40.0
    capacity: Annotated[
        float,
        Doc("most that an agent can hold", "nutrient", OURS, Range(gt=0, le=1e6)),
    ] = 400.0
    basic_cost: Annotated[
        float,
        Doc("used up by living", "nutrient/step", CODE, Range(ge=0, le=1e4)),
    ] = 1e-4
    action_cost: Annotated[
        float,
        Doc("used up by motor force, per norm of the two forces", "nutrient/(step·force)", CODE, Range(ge=0, le=1e4)),
    ] = 2e-6
    hazard_share: Annotated[
        float,
        Doc(
            "weight of the hazard's part by energy, with this store in place of energy",
            "",
            CODE,
            Range(ge=0, le=1e4),
        ),
    ] = 0.2
    observed: Annotated[
        bool,
        Doc("whether agents observe it", "", OURS),
    ] = True


@dataclass(frozen=True, slots=True)
class ToxinConfig:
    """What some foods leave: toxin ← max(0, toxin + Σ toxin·eaten − decay). It weakens both motors.

    They keep the share (1 − σ(toxin − threshold))/(1 − σ(−threshold)) of their force: all of it without toxin.
    A species has it if it eats a kind of food with `toxin` above 0. A child is born without any.
    """

    decay: Annotated[
        float,
        Doc("how much goes in a step", "toxin/step", CODE, Range(ge=0, le=1e4)),
    ] = 0.01
    threshold: Annotated[
        float,
        Doc("toxin that takes about half of the force", "toxin", CODE, Range(gt=0, le=1e3)),
    ] = 5.0
    observed: Annotated[
        bool,
        Doc("whether agents observe it", "", OURS),
    ] = True
