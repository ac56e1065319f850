"""Retired names of settings and choices; the error that refuses one gives its replacement."""

from collections.abc import Iterator
from typing import Any

from hedon.config.layer import Table, has
from hedon.config.problem import Problem

MOVED = {
    "body.food_radius": "world.food_radius",
    "sensor.eaten_food": "world.eaten_food",
    "sensor.mouths": "world.mouths",
    "diet.prey_sharing": "world.prey_sharing",
    "birth.delay": "birth.logit_offset",
    "birth.order": "world.birth_order",
    "birth.inheritance": "world.inheritance",
    "birth.parents": "world.parents",
    "birth.heading": "world.child_heading",
    "genome.founders": "world.founders",
    "genome.mutation_noise": "world.mutation_noise",
    "learning.rollout_steps": "world.rollout_steps",
    "learning.networks": "world.networks",
    "reward.relief_coef": "reward.drive_reduction_coef",
    "energy.birth_share": "energy.child_share",
    "energy.starvation": "energy.at_zero",
    "genome.set_point": "energy.set_point",
    **{f"nutrient.{name}": f"store.nutrient.{name}" for name in ("initial", "capacity", "basic_cost", "action_cost")},
    "nutrient.hazard_share": "store.nutrient.hazard_weight",
    "nutrient.observed": "store.nutrient.observed",
    "genome.set_point_nutrient": "store.nutrient.set_point",
    "toxin.decay": "store.toxin.basic_cost",
    "toxin.threshold": "store.toxin.motor_threshold",
    "toxin.observed": "store.toxin.observed",
    "genome.set_point_toxin": "store.toxin.set_point",
}
"""New paths of settings of a file, by their old paths."""
GIVEN = ("energy", "nutrient", "toxin")
"""Stores for which a kind of food had settings of its own before `gives` existed."""
VALUES = {
    "learning.policy": {"still": "idle", "frozen": "fixed"},
    "world.mutation_noise": {"frozen": "tabulated"},
    "world.parents": {"old_slots": "resident_slots"},
    "reward.family": {"fed": "above", "hungry": "below", "by_age": "between"},
}
"""New names of choices, by the settings' current paths and the old names."""
FIDELITY_NOW = {"text": "as_printed"}
"""New names of fidelities."""
GATES = {"by_age": "age"}
"""Gates that a file must now name, by the old names of reward families."""
SENSES = ("see", "smell")
"""Former sections of `reward`, whose terms are now in `reward.pay`."""


def _owners(tables: Table) -> dict[str, Table]:
    """Tables that can hold settings of a species, by path prefix: the file itself and each species."""
    return {"": tables} | {f"species.{name}.": table for name, table in _tables(tables.get("species")).items()}


def _moves(tables: Table) -> Iterator[tuple[str, str]]:
    """Yields each old path in the tables with its new path."""
    for place, table in _owners(tables).items():
        for old, new in MOVED.items():
            if has(table, old.split(".")):
                yield place + old, new if new.startswith("world.") else place + new
        for sense in SENSES:
            for name in _tables(_tables(table.get("reward")).get(sense)):
                yield f"{place}reward.{sense}.{name}", f"{place}reward.pay.{sense}_{name}"
    for kind, food in _tables(tables.get("food")).items():
        yield from ((f"food.{kind}.{name}", f"food.{kind}.gives.{name}") for name in GIVEN if name in food)


def renamed(tables: Table) -> Iterator[Problem]:
    """Yields a problem for each setting with an old path and each choice with an old name."""
    for old, new in _moves(tables):
        yield Problem(old, f"is called {new} now")
    for place, table in _owners(tables).items():
        for path, names in VALUES.items():
            section, name = path.split(".")
            value = table[section][name] if has(table, [section, name]) else None
            if isinstance(value, str) and value in names:
                addition = f', with reward.gate = "{GATES[value]}"' if value in GATES else ""
                yield Problem(place + path, f'is called "{names[value]}" now{addition}', f'"{value}"')


def new_path(path: str) -> str | None:
    """Current path of a setting that another version had at this path; None if no version had it."""
    names = path.split(".")
    if len(names) == 3 and names[0] == "food" and names[2] in GIVEN:
        return f"food.{names[1]}.gives.{names[2]}"
    if len(names) > 2 and names[0] == "reward" and names[1] in SENSES:
        tail = ["channel"] if names[3:] in (["over_rays"], ["reads"]) else names[3:]
        return ".".join(["reward.pay", f"{names[1]}_{names[2]}", *tail])
    return MOVED.get(path)


def _tables(value: Any) -> dict[str, Any]:
    """Entries of a table that are tables; empty for anything else."""
    return {name: entry for name, entry in value.items() if isinstance(entry, dict)} if isinstance(value, dict) else {}
