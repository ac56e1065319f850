"""Configs of earlier versions: what was renamed or moved since, and how such a config is read and rewritten."""

import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from copy import deepcopy
from typing import Any

from hedon.config.field import value_at
from hedon.config.layer import Table, has
from hedon.config.problem import Problem, format_value
from hedon.config.schema.species import EVERYTHING, ONLY, PER_SPECIES

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
"""Settings of a file that have another path now."""
GIVEN = ("energy", "nutrient", "toxin")
"""What a kind of food gave by settings of its own, before it had `gives`."""
STORES: dict[str, dict[str, Any]] = {
    "nutrient": {
        **{"initial": 40.0, "capacity": 400.0, "basic_cost": 1e-4, "action_cost": 2e-6, "hazard_weight": 0.2},
        "set_point": {"initial_mean": 0.5, "initial_sd": 0.1},
    },
    "toxin": {
        **{"capacity": 1e6, "basic_cost": 0.01, "motor_threshold": 5.0, "scale": 10.0},
        "set_point": {"initial_mean": 0.0, "initial_sd": 0.1},
    },
}
"""What the stores of earlier versions did where a file did not say it."""
VALUES = {
    "learning.policy": {"still": "idle", "frozen": "fixed"},
    "world.mutation_noise": {"frozen": "tabulated"},
    "world.parents": {"old_slots": "resident_slots"},
    "reward.family": {"fed": "above", "hungry": "below", "by_age": "between"},
}
"""Choices of settings that have other names now, by the paths of today."""
FIDELITY_NOW = {"text": "as_printed"}
"""Fidelities that have other names now."""
GATES = {"by_age": "age"}
"""Families of rewards whose gate a file must name now, by their names before."""
SENSES = ("see", "smell")
"""Sections of `reward` whose terms are among those of `reward.pay` now."""
SENSE_COEF = 0.1
"""The factor of their terms where a file did not say it."""
_MEANT = {"learning": {"acting_weights": "float32"}}
"""What complete files of the first versions mean by settings that they lack, where the default is another value."""
_LAWS = ("initial_mean_food", "initial_mean_action", "initial_sd")
"""Settings of `genome` that stood for the law of every gene before 0.4."""


def _owners(tables: Table) -> dict[str, Table]:
    """What has settings of a species, by how paths in it begin: the file itself, and each species."""
    return {"": tables} | {f"species.{name}.": own for name, own in _tables(tables.get("species")).items()}


def _moves(tables: Table) -> Iterator[tuple[str, str]]:
    """Each path of the tables that is another one now, and that one."""
    for place, own in _owners(tables).items():
        for old, new in MOVED.items():
            if has(own, old.split(".")):
                yield place + old, new if new.startswith("world.") else place + new
        for sense in SENSES:
            for name in _tables(_tables(own.get("reward")).get(sense)):
                yield f"{place}reward.{sense}.{name}", f"{place}reward.pay.{sense}_{name}"
    for kind, food in _tables(tables.get("food")).items():
        yield from ((f"food.{kind}.{name}", f"food.{kind}.gives.{name}") for name in GIVEN if name in food)


def clashes(tables: Table) -> Iterator[Problem]:
    """Yields each setting whose place now has another value: its own, or that of another species."""
    told: dict[str, Any] = {}
    for old, new in _moves(tables):
        value = value_at(tables, old)
        there = value_at(tables, new) if has(tables, new.split(".")) else told.setdefault(new, value)
        if there != value:
            yield Problem(old, f"is called {new} now, which is {format_value(there)}", format_value(value))
    for place, own in _owners(tables).items():
        family = own["reward"]["family"] if has(own, ["reward", "family"]) else None
        gate = GATES.get(family) if isinstance(family, str) else None
        if gate and own["reward"].get("gate", gate) != gate:
            meant = f'means reward.gate = "{gate}"; it has another one'
            yield Problem(f"{place}reward.family", meant, format_value(family))


def renamed(tables: Table, hint: str = "") -> Iterator[Problem]:
    """Yields each setting that has another path now, and each choice that has another name.

    Args:
        tables: of a layer.
        hint: what helps, in brackets, at the end of each message.
    """
    for old, new in _moves(tables):
        yield Problem(old, f"is called {new} now{hint}")
    for place, own in _owners(tables).items():
        for path, names in VALUES.items():
            section, name = path.split(".")
            value = own[section][name] if has(own, [section, name]) else None
            if isinstance(value, str) and value in names:
                more = f', with reward.gate = "{GATES[value]}"' if value in GATES else ""
                yield Problem(place + path, f'is called "{names[value]}" now{more}{hint}', f'"{value}"')


def new_path(path: str) -> str | None:
    """What a setting is called now that another version had at this path; None if none had it.

    Args:
        path: as in a file of one species.
    """
    names = path.split(".")
    if len(names) == 3 and names[0] == "food" and names[2] in GIVEN:
        return f"food.{names[1]}.gives.{names[2]}"
    if len(names) > 2 and names[0] == "reward" and names[1] in SENSES:
        rest = ["channel"] if names[3:] in (["over_rays"], ["reads"]) else names[3:]
        return ".".join(["reward.pay", f"{names[1]}_{names[2]}", *rest])
    return MOVED.get(path)


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
    _name_terms(made, {})
    _name_stores(made, {}, whole=True)
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


def migrate_text(text: str, below: Table) -> str:
    """A short file of an earlier version with the names of this one.

    Comments and order stay, but where dotted keys leave no place for what is moved: there terms of the reward become
    tables of one line, or else the whole file is written anew.

    Args:
        text: of the file.
        below: the tables of its preset.
    """
    import tomlkit
    from tomlkit.exceptions import TOMLKitError

    meant = tomlkit.parse(text).unwrap()
    _rewrite(meant, below)
    inline = tomlkit.inline_table
    for table, row in ((tomlkit.table, tomlkit.table), (tomlkit.table, inline), (inline, inline)):
        document: Any = tomlkit.parse(text)
        with suppress(TOMLKitError, LookupError, ValueError):  # tables that stand at several places
            _rewrite(document, below, table, row, in_line=table is inline)
            if _told(tomllib.loads(tomlkit.dumps(document))) == _told(meant):
                return tomlkit.dumps(document)
    return tomlkit.dumps(meant)


def _rewrite(
    root: Any, below: Table, table: Callable[[], Any] = dict, row: Callable[[], Any] = dict, in_line: bool = False
) -> None:
    """Gives the tables of a short file the names of this version, in place; `row` makes an empty table of one line."""
    _rename(root, [root, *_tables(root.get("species")).values()], table, row)
    _name_terms(root, below, table, in_line)
    _name_stores(root, below, False, table)


def _told(table: Table, kept: bool = False) -> Table:
    """A table without the empty ones in it, which say nothing, unless they name a species beside the usual one."""
    within = {n: _told(value, n == "species") if isinstance(value, dict) else value for n, value in table.items()}
    return {name: value for name, value in within.items() if value != {} or (kept and name != ONLY)}


def _tables(value: Any) -> dict[str, Any]:
    """The tables in a table; none where there is none."""
    return {name: each for name, each in value.items() if isinstance(each, dict)} if isinstance(value, dict) else {}


def _law(genome: Table, mean: str = "") -> Table:
    return {"initial_mean": genome.get(mean, 0.0), "initial_sd": genome["initial_sd"]}


def _rename(root: Any, owners: Sequence[Any], table: Callable[[], Any] = dict, row: Callable[[], Any] = dict) -> None:
    """Gives settings and choices the names of this version, in place."""
    if root.get("fidelity") in FIDELITY_NOW:
        root["fidelity"] = FIDELITY_NOW[root["fidelity"]]
    for old, new in MOVED.items():
        (section, name), (target, *between, now) = old.split("."), new.split(".")
        for owner in owners:
            if not has(owner, [section, name]):
                continue
            value = owner[section].pop(name)
            home = root if target == "world" else owner
            if not owner[section] and (home is owner or len(owner) > 1):  # else its table is what names a species
                owner.pop(section)
            for place in (target, *between):
                home = home.setdefault(place, table())
            home[now] = value
    for food in _tables(root.get("food")).values():
        for name in GIVEN:
            if name in food:
                value = food.pop(name)
                food.setdefault("gives", row())[name] = value
    for path, names in VALUES.items():
        section, name = path.split(".")
        for owner in owners:
            if has(owner, [section, name]) and isinstance(owner[section][name], str):
                before = owner[section][name]
                owner[section][name] = names.get(before, before)
                if path == "reward.family" and before in GATES:
                    owner[section].setdefault("gate", GATES[before])


def _name_terms(root: Any, below: Table, table: Callable[[], Any] = dict, in_line: bool = False) -> None:
    """Moves rewards for sights and smells to the other terms, in place; arguments as those of `_name_stores`."""

    def moved(told: Any) -> Any:
        if not (in_line and isinstance(told, dict)):
            return told
        row = table()
        for name, value in told.items():
            row[name] = moved(value)
        return row

    for species, owner in {"": root, **_tables(root.get("species"))}.items():
        reward, under = owner.get("reward"), _tables(below.get("species")).get(species, {})
        for sense in SENSES if isinstance(reward, dict) else ():
            for name, told in reward.pop(sense, {}).items():
                term = f"{sense}_{name}"
                known = (each["reward"]["pay"][term] for each in (under, below) if has(each, ["reward", "pay", term]))
                before = next(known, {})
                if isinstance(told, dict):
                    _name_channel(told, term, before.get("channel", term))
                    if not before:
                        told.setdefault("coef", SENSE_COEF)
                reward.setdefault("pay", table())[term] = moved(told)


def _name_channel(told: Any, term: str, before: str) -> None:
    """Gives a term the channel that it reads, in place, where that is not the one of its preset, or of its name."""
    over, reads = told.pop("over_rays", ""), told.pop("reads", None)
    largest = over == "max" or (not over and before.endswith("_max"))
    read = before.removesuffix("_max") if reads is None else f"see_{reads}" if reads else term
    channel = read + "_max" * largest
    if channel != before:
        told["channel"] = channel
        comment = "".join(getattr(getattr(each, "trivia", None), "comment", "") for each in (over, reads))
        if comment:
            told["channel"].comment(comment)


def _name_stores(root: Any, below: Table, whole: bool, table: Callable[[], Any] = dict) -> None:
    """Names the stores of earlier versions, in place. Who ate nothing of what a store is filled by did not have it.

    Args:
        root: the tables of a file.
        below: those of its preset.
        whole: each species has all its settings, and those at the top mean nothing.
        table: makes an empty table.
    """
    foods, above, under = _tables(root.get("food")), _tables(root.get("species")), _tables(below.get("species"))
    for name, before in STORES.items():
        for food in foods.values():
            if food.get("gives", {}).get(name) == 0:
                del food["gives"][name]
        kinds = {kind for kind, food in foods.items() if name in food.get("gives", {})}
        for own in above.values() if whole and above else [root]:
            if kinds:
                share = {"child_share": own.get("energy", {}).get("child_share", 0.4)} if name == "nutrient" else {}
                _fill(own.setdefault("store", table()).setdefault(name, table()), before | share)
            else:
                own.get("store", {}).pop(name, None)
        for each in dict.fromkeys((*above, *under)) if kinds else ():
            own, layers = above.get(each, {}), (above.get(each), under.get(each), root, below)
            if not _eats(kinds, layers):
                place = root.setdefault("species", table()).setdefault(each, table())
                place.setdefault("store", table())[name] = False
            elif name == "nutrient" and has(own, ["energy", "child_share"]):
                store = own.setdefault("store", table()).setdefault(name, table())
                store["child_share"] = own["energy"]["child_share"]
    for own in (root, *above.values()):
        if own.get("store") == {}:
            own.pop("store")


def _fill(store: Any, before: Table) -> None:
    """Gives a table what it lacks of another one, in place."""
    for name, value in before.items():
        if isinstance(value, dict) and name in store:
            _fill(store[name], value)
        elif name not in store:
            store[name] = value


def _eats(kinds: set[str], layers: Sequence[Any]) -> bool:
    """Whether who has these tables, of which the first that says it counts, eats any of some kinds of food."""
    told = (each["diet"]["eats"] for each in layers if has(each, ["diet", "eats"]))
    return any(
        factor and (name in kinds or EVERYTHING in (name, *kinds)) for name, factor in next(told, [[EVERYTHING, 1.0]])
    )
