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
    defaults = food.pop(EVERY, {})
    if not isinstance(defaults, dict):
        yield Problem(f'food."{EVERY}"', "must be a table", format_value(defaults))
    kinds = [name for name, table in food.items() if isinstance(table, dict) and "gives" in table]
    for kind, value in list(food.items()):
        if value is False:
            del food[kind]
        elif isinstance(value, dict) and "gives" not in value:
            listing = ", ".join(kinds) or "none"
            message = f"there is no such kind of food (known: {listing}); a new kind must say what it gives"
            yield Problem(f"food.{kind}", message, nearest=nearest(kind, kinds))
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
    owners = {name: table for name, table in species.items() if isinstance(table, dict)}
    yield from _unreached(owners, layers)
    for name, table in list(species.items()):
        if table is False:
            del species[name]
        elif not isinstance(table, dict):
            yield Problem(f"species.{name}", "must be a table", format_value(table))
        else:
            species[name] = _lay(common, table)
    if not species:
        species[ONLY] = common


def _unreached(owners: dict[str, Table], layers: Sequence[Table]) -> Iterator[Problem]:
    for i, layer in enumerate(layers) if owners else ():
        upper_species = stack(layers[i:]).get("species", {})
        for path, value in _flat({name: layer[name] for name in PER_SPECIES if name in layer}):
            if all(has(table, path) for table in owners.values()) and not all(
                has(upper_species, (owner, *path)) for owner in owners
            ):
                name = ".".join(path)
                alternatives = " and ".join(f"species.{owner}.{name}" for owner in owners)
                yield Problem(
                    name, f"changes nothing, since each species has its own: set {alternatives}", format_value(value)
                )


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
    name, species_table = next(iter(species.items()))
    return complete | species_table | {"species": {name: {}}} if isinstance(species_table, dict) else complete


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
        common = {name: genome[default_name] for name, default_name in OF_ALL_GENES.items() if default_name in genome}
        genome["mutation"] = {
            gene: _lay(common, mutation) if isinstance(mutation, dict) else mutation
            for gene, mutation in genome["mutation"].items()
            if mutation is not False
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
    for name, species_table in species.items() if isinstance(species, dict) else ():
        if not isinstance(species_table, dict):
            continue
        for section in ("neighbor", "store"):
            if isinstance(species_table.get(section), dict):
                species_table[section] = {
                    entry: value for entry, value in species_table[section].items() if value is not False
                }
        stores = species_table.get("store")
        if not isinstance(stores, dict):
            continue
        if ENERGY in stores:
            message = "is every species' own store: set it in the section energy, and give another name to a new one"
            yield Problem(f"species.{name}.store.{ENERGY}", message)
            del stores[ENERGY]
        names = [store for store, value in stores.items() if isinstance(value, dict) and "capacity" in value]
        for store, value in list(stores.items()):
            if isinstance(value, dict) and store not in names:
                message = (
                    f"there is no such store (known: {', '.join(names) or 'none'}); a new one must say its capacity"
                )
                yield Problem(f"species.{name}.store.{store}", message, nearest=nearest(store, names))
                del stores[store]


def _lay(base: Any, overlay: Any) -> Any:
    """Merges two values: tables merge recursively; otherwise the later value wins."""
    if not isinstance(base, dict) or not isinstance(overlay, dict):
        return overlay
    return base | {name: _lay(base.get(name), value) for name, value in overlay.items()}


def _lay_food(base: Table, overlay: Table) -> Table:
    defaults = overlay.get(EVERY, {})
    is_table = isinstance(defaults, dict)  # otherwise it is refused later
    merged = {
        name: _lay(kind_table, defaults) if is_table and isinstance(kind_table, dict) else kind_table
        for name, kind_table in base.items()
    }
    merged[EVERY] = _lay(base.get(EVERY, {}), defaults)
    for kind, value in overlay.items():
        if kind != EVERY:
            kind_table = merged.get(kind)
            merged[kind] = _lay(kind_table if isinstance(kind_table, dict) else merged[EVERY], value)
    return merged
