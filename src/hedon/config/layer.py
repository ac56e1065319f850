"""Merges layers of nested tables: each layer replaces single settings of earlier ones."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from hedon.config.expression import kind_of, settable
from hedon.config.field import settings
from hedon.config.problem import Problem, format_value, nearest
from hedon.config.schema.evolution import OF_ALL_GENES, GeneConfig
from hedon.config.schema.species import ONLY, PER_SPECIES
from hedon.config.schema.store import ENERGY

Table = dict[str, Any]
EVERY = "*"
"""Key in a layer that stands for every kind of food: `[food."*"]`."""


def stack(layers: Iterable[Table]) -> Table:
    """Merges tables. If several define a setting, the last one wins.

    In `food`, a layer's `*` applies to every kind, including kinds added by later layers; `kind = false` removes a
    kind. Kinds keep the order in which they first appear.
    """
    result: Table = {}
    for layer in layers:
        food, added = result.get("food", {}), layer.get("food", {})
        result = _lay(result, layer)
        if isinstance(food, dict) and isinstance(added, dict) and (food or added):
            result["food"] = _lay_food(food, added)
    return result


def settle_food(tables: Table) -> Iterator[Problem]:
    """Removes `*` and kinds that are false or unknown from `food`, in place; yields problems with the kinds."""
    food = tables.get("food")
    if not isinstance(food, dict):
        return
    if list(food) == [EVERY]:  # it applies to no kind
        del tables["food"]
        return
    every = food.pop(EVERY, {})
    if not isinstance(every, dict):
        yield Problem(f'food."{EVERY}"', "must be a table", format_value(every))
    others = [name for name, other in food.items() if isinstance(other, dict) and "gives" in other]
    for kind, value in list(food.items()):
        if value is False:
            del food[kind]
        elif isinstance(value, dict) and "gives" not in value:
            known = ", ".join(others) or "none"
            message = f"there is no such kind of food (known: {known}); a new kind must say what it gives"
            yield Problem(f"food.{kind}", message, nearest=nearest(kind, others))
            del food[kind]


def settle_species(tables: Table, layers: Sequence[Table]) -> Iterator[Problem]:
    """Moves top-level sections, the defaults of all species, into each species, in place.

    A species set to false is removed; if none is left, one species has the defaults. Yields problems with species, and
    each default from `layers`, the user's layers, that has no effect because every species has its own value.
    """
    common = {name: tables.pop(name) for name in PER_SPECIES if name in tables}
    species = tables.setdefault("species", {})
    if not isinstance(species, dict):
        yield Problem("species", "must be a table", format_value(species))
        return
    owners = {name: own for name, own in species.items() if isinstance(own, dict)}
    yield from _unreached(owners, layers)
    for name, own in list(species.items()):
        if own is False:
            del species[name]
        elif not isinstance(own, dict):
            yield Problem(f"species.{name}", "must be a table", format_value(own))
        else:
            species[name] = _lay(common, own)
    if not species:
        species[ONLY] = common


def _unreached(owners: dict[str, Table], layers: Sequence[Table]) -> Iterator[Problem]:
    for i, layer in enumerate(layers) if owners else ():
        over = stack(layers[i:]).get("species", {})
        for path, value in _flat({name: layer[name] for name in PER_SPECIES if name in layer}):
            if all(has(own, path) for own in owners.values()) and not all(has(over, (each, *path)) for each in owners):
                name = ".".join(path)
                said = " and ".join(f"species.{each}.{name}" for each in owners)
                yield Problem(name, f"changes nothing, since each species has its own: set {said}", format_value(value))


def _flat(table: Table, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, (*path, name))
        else:
            yield (*path, name), value


def with_defaults(complete: Table) -> Table:
    """Tables of a complete file; a single species is moved to the top level, where overrides can reach it."""
    species = complete.get("species")
    if not isinstance(species, dict) or len(species) != 1:
        return complete
    name, own = next(iter(species.items()))
    return complete | own | {"species": {name: {}}} if isinstance(own, dict) else complete


def has(table: Any, path: Sequence[str]) -> bool:
    """Whether nested tables contain a path."""
    for name in path:
        if not isinstance(table, dict) or name not in table:
            return False
        table = table[name]
    return True


def settle_genes(tables: Table) -> None:
    """Completes the genes of each species, in place.

    Values missing for a gene in `genome.mutation` come from `genome`. Keys of `genome.set` become whole paths: in a
    file, `set.sensor.ray_length` may be nested or quoted.
    """
    species = tables.get("species")
    owners = species.values() if isinstance(species, dict) else []
    for genome in (owner.get("genome") for owner in owners if isinstance(owner, dict)):
        if isinstance(genome, dict) and isinstance(genome.get("set"), dict):
            laws: Table = {}
            for path, law in _laws(genome["set"]):
                laws[path] = _lay(laws.get(path), law)
            genome["set"] = laws
        if not isinstance(genome, dict) or not isinstance(genome.get("mutation"), dict):
            continue
        common = {name: genome[whole] for name, whole in OF_ALL_GENES.items() if whole in genome}
        genome["mutation"] = {
            gene: _lay(common, own) if isinstance(own, dict) else own
            for gene, own in genome["mutation"].items()
            if own is not False
        }


def _laws(table: Table, path: str = "") -> Iterator[tuple[str, Any]]:
    """Laws of genes that set numbers, by the whole paths of the numbers."""
    for name, value in table.items():
        place = f"{path}{name}"
        is_law = not isinstance(value, dict) or kind_of(place) in settable() or {*value} <= {*settings(GeneConfig)}
        yield from [(place, value)] if is_law else _laws(value, f"{place}.")


def settle_stores_and_queries(tables: Table) -> Iterator[Problem]:
    """Removes stores and queries set to false from each species; removes and reports stores without a capacity."""
    species = tables.get("species")
    for name, own in species.items() if isinstance(species, dict) else ():
        if not isinstance(own, dict):
            continue
        for section in ("neighbor", "store"):
            if isinstance(own.get(section), dict):
                own[section] = {each: value for each, value in own[section].items() if value is not False}
        kept = own.get("store")
        if not isinstance(kept, dict):
            continue
        if ENERGY in kept:
            message = "is every species' own store: set it in the section energy, and give another name to a new one"
            yield Problem(f"species.{name}.store.{ENERGY}", message)
            del kept[ENERGY]
        known = [store for store, value in kept.items() if isinstance(value, dict) and "capacity" in value]
        for store, value in list(kept.items()):
            if isinstance(value, dict) and store not in known:
                message = (
                    f"there is no such store (known: {', '.join(known) or 'none'}); a new one must say its capacity"
                )
                yield Problem(f"species.{name}.store.{store}", message, nearest=nearest(store, known))
                del kept[store]


def _lay(base: Any, over: Any) -> Any:
    """Merges two values: tables merge recursively; otherwise the later value wins."""
    if not isinstance(base, dict) or not isinstance(over, dict):
        return over
    return base | {name: _lay(base.get(name), value) for name, value in over.items()}


def _lay_food(base: Table, over: Table) -> Table:
    every = over.get(EVERY, {})
    known = isinstance(every, dict)  # otherwise it is refused later
    merged = {name: _lay(below, every) if known and isinstance(below, dict) else below for name, below in base.items()}
    merged[EVERY] = _lay(base.get(EVERY, {}), every)
    for kind, value in over.items():
        if kind != EVERY:
            below = merged.get(kind)
            merged[kind] = _lay(below if isinstance(below, dict) else merged[EVERY], value)
    return merged
