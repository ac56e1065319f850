"""Configs of earlier versions: what was renamed or moved since, and how such a config is read and rewritten."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import deepcopy
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
_LAWS = ("initial_mean_food", "initial_mean_action", "initial_sd")
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
    made = deepcopy({name: value for name, value in tables.items() if name != "complete"})
    species, genome = _tables(made.get("species")), made.get("genome", {})
    for food in _tables(made.get("food")).values():
        food |= {"gene": _law(genome, "initial_mean_food")} if has(genome, ["initial_mean_food"]) else {}
    _rename(made, [*species.values(), made])
    for name in PER_SPECIES if species else ():
        made.pop(name, None)
    for own in species.values() or [made]:
        for section, settings in _MEANT.items():
            own[section] = settings | own.get(section, {})
        genome = own.get("genome", {})
        if has(genome, ["initial_mean_action"]):
            laws = {"action": _law(genome, "initial_mean_action"), "neutral": _law(genome)}
            own["genome"] = {name: value for name, value in genome.items() if name not in _LAWS} | laws
    return made


def migrate_text(text: str) -> str:
    """A short file of an earlier version with the names of this one; comments and order stay."""
    import tomlkit

    document: Any = tomlkit.parse(text)
    _rename(document, [document, *_tables(document.get("species")).values()], tomlkit.table)
    return tomlkit.dumps(document)


def _tables(value: Any) -> dict[str, Any]:
    """The tables in a table; none where there is none."""
    return {name: each for name, each in value.items() if isinstance(each, dict)} if isinstance(value, dict) else {}


def _law(genome: Table, mean: str = "") -> Table:
    return {"initial_mean": genome.get(mean, 0.0), "initial_sd": genome["initial_sd"]}


def _rename(root: Any, owners: Sequence[Any], table: Callable[[], Any] = dict) -> None:
    """Gives settings and choices the names of this version, in place."""
    for old, new in MOVED.items():
        (section, name), (target, now) = old.split("."), new.split(".")
        for owner in owners:
            if not has(owner, [section, name]):
                continue
            value = owner[section].pop(name)
            if not owner[section]:
                owner.pop(section)
            home = root if target == "world" else owner
            home.setdefault(target, table())[now] = value
    for path, names in VALUES.items():
        section, name = path.split(".")
        for owner in owners:
            if has(owner, [section, name]) and isinstance(owner[section][name], str):
                owner[section][name] = names.get(owner[section][name], owner[section][name])
