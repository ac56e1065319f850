"""Stores that an agent holds: energy, which every species has, and others named in a config."""

from dataclasses import dataclass
from typing import Literal

from hedon.config.field import CODE, EITHER, OURS, PAPER, section, setting
from hedon.config.schema.evolution import GeneConfig

ENERGY = "energy"
"""The store of every species, with its own section and ledger."""


@dataclass(frozen=True, slots=True)
class StoreConfig:
    """A store: held ← clip(held + Σ gives·eaten − action_cost·|force| − basic_cost − decay·held, 0, capacity).

    `[store.NAME]` gives every species a store of this name, `[species.SPECIES.store.NAME]` gives it to one species, and
    `store.NAME = false` removes it from one. A new store must set its capacity; it has no effect beyond the settings in
    its section. `[food.<kind>]` sets how much of each store a kind of food gives and needs. `set_point` is the law of
    the gene for the set point, if the reward has drive reduction.
    """

    initial: float = setting(0.0, "held by each founder at the start", "amount", OURS, ge=0, le=1e6)
    capacity: float = setting(
        100.0, "most that an agent can hold; what is eaten above it is lost", "amount", OURS, gt=0, le=1e6
    )
    basic_cost: float = setting(0.0, "used up by living", "amount/step", OURS, ge=0, le=1e4)
    action_cost: float = setting(
        0.0, "used up by motor force, per norm of the two forces", "amount/(step·force)", OURS, ge=0, le=1e4
    )
    decay: float = setting(0.0, "share of what is held that goes", "1/step", OURS, ge=0, le=1)
    child_share: float = setting(0.0, "share of what the parent holds that a child gets", "", OURS, ge=0, le=1)
    at_zero: Literal["floor", "death"] = setting(
        "floor", "if costs exceed what is held: it stays at 0 and the rest is forgiven, or the agent dies", "", OURS
    )
    hazard_weight: float = setting(
        0.0, "weight of the hazard's part by energy, with this store in place of energy", "", OURS, ge=0, le=1e4
    )
    birth_weight: float = setting(
        0.0,
        "the chance of a child follows the sum over the stores of this times what is held, in place of energy alone",
        "",
        OURS,
        ge=-1e4,
        le=1e4,
    )
    motor_threshold: float = setting(
        0.0, "amount that takes about half of both motors' force; 0: it takes none", "amount", OURS, ge=0, le=1e3
    )
    observed: bool = setting(True, "whether agents observe it", "", OURS, derived=True)
    scale: float = setting(
        100.0,
        'what its observation is divided by with sensor.scaling = "unit"',
        "amount",
        OURS,
        ge=1e-3,
        le=1e6,
        derived=True,
    )
    set_point: GeneConfig = section(lambda: GeneConfig(initial_mean=0.5), derived=True)


@dataclass(frozen=True, slots=True)
class EnergyConfig(StoreConfig):
    """The store `energy`: energy ← clip(energy + food − action_cost·|force| − basic_cost − decay·energy, 0, capacity).

    Births and the hazard depend on it, obstacles and hunters take it, and only energy has a ledger in the records. It
    has the same settings as every store (`[store.<kind>]`), with other defaults.
    """

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
    child_share: float = setting(0.4, "share of the parent's energy that a child gets", "", EITHER, ge=0, le=1)
    at_zero: Literal["floor", "death"] = setting(
        "floor",
        "if costs exceed the energy: it stays at 0 and the rest is forgiven, or the agent dies",
        "",
        CODE + '; "death" is ours',
    )
    hazard_weight: float = setting(1.0, "weight of the hazard's part by energy", "", EITHER, ge=0, le=1e4)
    birth_weight: float = setting(1.0, "weight of energy in what births follow", "", EITHER, ge=-1e4, le=1e4)
