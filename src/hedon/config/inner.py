"""Inner states beside energy: a second nutrient, and a toxin."""

from dataclasses import dataclass

from hedon.config.field import OURS, setting

CODE = OURS + "; the paper's code has this value"


@dataclass(frozen=True, slots=True)
class NutrientConfig:
    """A second store: store ← clip(store + Σ nutrient·eaten − action_cost·|force| − basic_cost, 0, capacity).

    A species has it if it eats a kind of food with `nutrient` above 0. A child gets `energy.birth_share` of it.
    """

    initial: float = setting(40.0, "nutrient of each founder at the start", "nutrient", CODE, ge=0, le=1e6)
    capacity: float = setting(400.0, "most that an agent can hold", "nutrient", OURS, gt=0, le=1e6)
    basic_cost: float = setting(1e-4, "used up by living", "nutrient/step", CODE, ge=0, le=1e4)
    action_cost: float = setting(
        2e-6, "used up by motor force, per norm of the two forces", "nutrient/(step·force)", CODE, ge=0, le=1e4
    )
    hazard_share: float = setting(
        0.2, "weight of the hazard's part by energy, with this store in place of energy", "", CODE, ge=0, le=1e4
    )
    observed: bool = setting(True, "whether agents observe it", "", OURS)


@dataclass(frozen=True, slots=True)
class ToxinConfig:
    """What some foods leave: toxin ← max(0, toxin + Σ toxin·eaten − decay). It weakens both motors.

    They keep the share (1 − σ(toxin − threshold))/(1 − σ(−threshold)) of their force: all of it without toxin.
    A species has it if it eats a kind of food with `toxin` above 0. A child is born without any.
    """

    decay: float = setting(0.01, "how much goes in a step", "toxin/step", CODE, ge=0, le=1e4)
    threshold: float = setting(5.0, "toxin that takes about half of the force", "toxin", CODE, gt=0, le=1e3)
    observed: bool = setting(True, "whether agents observe it", "", OURS)
