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
}
"""Settings of a file that have another path now."""
VALUES = {
    "learning.policy": {"still": "idle", "frozen": "fixed"},
    "world.mutation_noise": {"frozen": "tabulated"},
    "world.parents": {"old_slots": "resident_slots"},
}
"""Choices of settings that have other names now, by the paths of today."""
_MEANT = {"learning": {"acting_weights": "float32"}}
"""What complete files of the first versions mean by settings that they lack, where the default is another value."""
_HINT = "`hedon config migrate FILE` rewrites a file"
_GENES = ("initial_mean_food", "initial_mean_action", "initial_sd")
"""Settings of `genome` that stood for the law of every gene before 0.4."""


def renamed(tables: Table) -> Iterator[Problem]:
    """Yields each setting that has another path now, and each choice that has another name."""
    species = tables.get("species")
    owners = {"": tables} | {f"species.{name}.": own for name, own in _tables(species).items()}
    for place, own in owners.items():
        for old, new in MOVED.items():
            if has(own, old.split(".")):
                now = new if new.startswith("world.") else place + new
                yield Problem(place + old, f"is called {now} now ({_HINT})")
        for path, names in VALUES.items():
            section, name = path.split(".")
            value = own[section][name] if has(own, [section, name]) else None
            if isinstance(value, str) and value in names:
                yield Problem(place + path, f'is called "{names[value]}" now ({_HINT})', f'"{value}"')


def is_earlier(tables: Mapping[str, Any]) -> bool:
    """Whether tables are those of a complete file of an earlier version, as the folders of its runs have."""
    return tables.get("complete") is True and "schema" not in tables


def migrated(tables: Table) -> Table:
    """The tables of an earlier version's complete file as this version has them; what they lack has its default.

    Where such a file has species, each has all its settings, and those at the top mean nothing.
    """
    species = _tables(tables.get("species"))
    made = {name: value for name, value in tables.items() if name not in (*PER_SPECIES, "complete", "species")}
    tops = {name: tables[name] for name in PER_SPECIES if name in tables}
    world = {}
    for own in (*species.values(), tops):
        for old, new in MOVED.items():
            if has(own, old.split(".")) and new.startswith("world."):
                world[new.removeprefix("world.")] = _value(new, _at(own, old))
    made["food"] = {kind: _food(tops, food) for kind, food in _tables(tables.get("food")).items()}
    every = {name: _species(own) for name, own in species.items()}
    return made | {"world": world} | ({"species": every} if species else _species(tops))


def _tables(value: Any) -> dict[str, Table]:
    """The tables in a table; none where there is none."""
    return {name: each for name, each in value.items() if isinstance(each, dict)} if isinstance(value, dict) else {}


def _at(tables: Table, path: str) -> Any:
    section, name = path.split(".")
    return tables[section][name]


def _species(sections: Table) -> Table:
    made = {
        section: {
            name: _value(f"{section}.{name}", value)
            for name, value in settings.items()
            if f"{section}.{name}" not in MOVED
        }
        for section, settings in _tables(sections).items()
    }
    for old, new in MOVED.items():
        section, name = new.split(".")
        if section in made and has(sections, old.split(".")):
            made[section][name] = _at(sections, old)
    for section, settings in _MEANT.items():
        made[section] = settings | made.get(section, {})
    genome = made.get("genome", {})
    if genome.keys() >= {*_GENES}:
        laws = {"action": _law(genome, _GENES[1]), "neutral": {"initial_mean": 0.0, "initial_sd": genome[_GENES[2]]}}
        made["genome"] = {name: value for name, value in genome.items() if name not in _GENES} | laws
    return made


def _value(path: str, value: Any) -> Any:
    """A setting's value by its name of today."""
    return VALUES[path].get(value, value) if path in VALUES and isinstance(value, str) else value


def _food(sections: Table, food: Table) -> Table:
    genome = _tables(sections).get("genome", {})
    return food | ({"gene": _law(genome, _GENES[0])} if genome.keys() >= {*_GENES} else {})


def _law(genome: Table, mean: str) -> Table:
    return {"initial_mean": genome[mean], "initial_sd": genome[_GENES[2]]}


def migrate_text(text: str) -> str:
    """A short file of an earlier version with the names of this one; comments and order stay."""
    import tomlkit

    document: Any = tomlkit.parse(text)
    species = document.get("species")
    owners: list[Any] = [document, *(species.values() if isinstance(species, dict) else ())]
    for old, new in MOVED.items():
        (section, name), (target, now) = old.split("."), new.split(".")
        for owner in owners:
            if not has(owner, [section, name]):
                continue
            value = owner[section].pop(name)
            if not owner[section]:
                owner.pop(section)
            root = document if target == "world" else owner
            if target not in root:
                root[target] = tomlkit.table()
            root[target][now] = value
    for path, names in VALUES.items():
        section, name = path.split(".")
        for owner in owners:
            if has(owner, [section, name]) and owner[section][name] in names:
                owner[section][name] = names[owner[section][name]]
    return tomlkit.dumps(document)
