"""Configs of earlier versions: what was renamed or moved since, and how such a config is read and rewritten."""

from collections.abc import Iterator, Mapping
from typing import Any

from hedon.config.layer import Table, has
from hedon.config.problem import Problem
from hedon.config.species import PER_SPECIES

MOVED = {
    "body.food_radius": "world.food_radius",
    "sensor.eaten_food": "world.eaten_food",
    "sensor.mouths": "world.mouths",
    "diet.prey_sharing": "world.prey_sharing",
    "birth.order": "world.birth_order",
    "birth.inheritance": "world.inheritance",
    "birth.parents": "world.parents",
    "birth.heading": "world.child_heading",
    "genome.founders": "world.founders",
    "genome.mutation_noise": "world.mutation_noise",
    "learning.rollout_steps": "world.rollout_steps",
    "learning.networks": "world.networks",
    "reward.relief_coef": "reward.drive_reduction_coef",
}
"""Settings of a file that have another path now."""
_MEANT = {"learning": {"acting_weights": "float32"}}
"""What complete files of the first versions mean by settings that they lack, where the default is another value."""
_GENES = ("initial_mean_food", "initial_mean_action", "initial_sd")
"""Settings of `genome` that stood for the law of every gene before 0.4."""


def renamed(tables: Table) -> Iterator[Problem]:
    """Yields each setting that has another path now."""
    species = tables.get("species")
    owners = {"": tables} | ({f"species.{n}.": own for n, own in species.items()} if isinstance(species, dict) else {})
    for place, own in owners.items():
        for old, new in MOVED.items():
            if has(own, old.split(".")):
                now = new if new.startswith("world.") else place + new
                yield Problem(place + old, f"is called {now} now (`hedon config migrate FILE` rewrites a file)")


def is_earlier(tables: Mapping[str, Any]) -> bool:
    """Whether tables are those of a complete file of an earlier version, as the folders of its runs have."""
    return tables.get("complete") is True and "schema" not in tables


def migrated(tables: Table) -> Table:
    """The tables of an earlier version's complete file as this version has them; what they lack has its default.

    Where such a file has species, each has all its settings, and those at the top mean nothing.
    """
    species = tables.get("species") or {}
    made = {name: value for name, value in tables.items() if name not in PER_SPECIES and name != "complete"}
    tops = {name: tables[name] for name in PER_SPECIES if name in tables}
    owners = list(species.values()) if species else [tops]
    world = {}
    for own in (*owners, tops):
        for old, new in MOVED.items():
            section, name = old.split(".")
            if has(own, (section, name)) and new.startswith("world."):
                world[new.removeprefix("world.")] = own[section][name]
    made["food"] = {kind: _food(tops, food) for kind, food in tables.get("food", {}).items()}
    every = {name: _species(own) for name, own in species.items()}
    return made | {"world": world} | ({"species": every} if species else _species(tops))


def _species(sections: Table) -> Table:
    gone = {tuple(old.split(".")) for old in MOVED}
    made = {
        section: {name: value for name, value in settings.items() if (section, name) not in gone}
        for section, settings in sections.items()
    }
    for old, new in MOVED.items():
        section, name = new.split(".")
        if section in made and has(sections, old.split(".")):
            made[section][name] = sections[old.split(".")[0]][old.split(".")[1]]
    for section, settings in _MEANT.items():
        made[section] = settings | made.get(section, {})
    genome = made.get("genome", {})
    if genome.keys() >= {*_GENES}:
        laws = {"action": _law(genome, _GENES[1]), "neutral": {"initial_mean": 0.0, "initial_sd": genome[_GENES[2]]}}
        made["genome"] = {name: value for name, value in genome.items() if name not in _GENES} | laws
    return made


def _food(sections: Table, food: Table) -> Table:
    genome = sections.get("genome", {})
    return food | ({"gene": _law(genome, _GENES[0])} if genome.keys() >= {*_GENES} else {})


def _law(genome: Table, mean: str) -> Table:
    return {"initial_mean": genome[mean], "initial_sd": genome[_GENES[2]]}


def migrate_text(text: str) -> str:
    """A short file of an earlier version with the names of this one; comments and order stay."""
    import tomlkit

    document = tomlkit.parse(text)
    species = document.get("species")
    owners: list[Any] = [document, *(species.values() if isinstance(species, Mapping) else ())]
    for old, new in MOVED.items():
        (section, name), (target, now) = old.split("."), new.split(".")
        for owner in owners:
            table = owner.get(section) if isinstance(owner, Mapping) else None
            if not hasattr(table, "items") or name not in table:
                continue
            root: Any = document if target == "world" else owner
            value = table[name]
            del table[name]
            if target not in root:
                root[target] = tomlkit.table()
            root[target][now] = value
            if not table:
                del owner[section]
    return tomlkit.dumps(document)
