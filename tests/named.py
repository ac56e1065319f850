"""The named quantities of a world, which do not change if only memory layout, slots or the form of settings change.

Each quantity is read by its public name, in a canonical order: agents by id, genes and inputs by name, foods by
position. Numbers keep every bit.
"""

import hashlib
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from ppo_reference import split

from hedon.config.layout import layouts, observation_columns, store_columns
from hedon.experiment.world import World
from hedon.record.schema import columns_of

LIFE = {
    *("agent_id", "parent_id", "mate_id", "generation", "birth_step", "death_step", "cause", "children"),
    *("energy", "birth_energy", "energy_gained", "energy_spent", "distance", "reward"),
}
"""Recorded of every agent, dead or alive, in addition to its genes and meals."""
FORCE, VELOCITY = ("force_left", "force_right"), ("velocity_x", "velocity_y", "angular_velocity")
MORE_COUNTERS = (
    *(f"hunt_counters.{name}" for name in ("deaths_starved", "deaths_eaten", "energy_hunted", "energy_prey")),
    *(f"obstacle_counters.{name}" for name in ("obstacles_touched", "energy_damage")),
)
LAYERS = {"hidden_1": ("w1", "b1"), "hidden_2": ("w2", "b2"), "output": ("w3", "b3", "log_sd")}

Quantities = dict[str, dict[str, str]]


def quantities(world: World) -> Quantities:
    """A short digest of each quantity by species and name, for a world whose deaths have not been taken.

    Quantities that belong to no species are listed under "world".
    """
    found = {"world": dict(_of_world(world))}
    dead, living = world.deaths(), world.agents()
    for i, name in enumerate(world.config.species):
        here, gone = ({key: of[key][of["species"] == i] for key in of} for of in (living, dead))
        found[name] = {
            **dict(_of_lives(world, name, gone, here)),
            **dict(_of_living(world, i, here)),
            **dict(_counted(world, i)),
        }
    return found


def short(*values: ArrayLike) -> str:
    """A digest of numbers of any type: 8 hexadecimal digits."""
    content = hashlib.sha256()
    for each in values:
        numbers = np.ascontiguousarray(each, np.float64)
        content.update(np.where(np.isnan(numbers), np.nan, numbers).tobytes())
    return content.hexdigest()[:8]


def _of_world(world: World) -> Iterator[tuple[str, str]]:
    yield "step", short(world.step)
    foods = world.foods()
    for k, kind in enumerate(world.config.food):
        places = np.stack([foods[axis][foods["kind"] == k] for axis in ("x", "y")])
        yield f"food.{kind}", short(places[:, np.lexsort(places)])
    if world.config.obstacle.count:
        yield "obstacles", short(world.obstacles)


def _of_lives(
    world: World, name: str, dead: dict[str, NDArray[Any]], living: dict[str, NDArray[Any]]
) -> Iterator[tuple[str, str]]:
    """Quantities of all agents that ever lived, in order of id."""
    every = {key: np.concatenate([dead[key], living[key]]) for key in dead}
    every = {key: values[np.argsort(every["agent_id"])] for key, values in every.items()}
    for key in sorted(LIFE & set(every)):
        yield key, short(every[key])
    yield "force", short(*(every[key] for key in FORCE))
    for i, gene in enumerate(layouts(world.config)[name].gene_names):
        yield f"gene.{gene}", short(every["genome"][:, i])
    columns = columns_of(world.config)
    for i, meal in enumerate((*columns.food_kinds, *columns.species)[: every["eaten"].shape[1]]):
        yield f"eaten.{meal}", short(every["eaten"][:, i])


def _of_living(world: World, index: int, living: dict[str, NDArray[Any]]) -> Iterator[tuple[str, str]]:
    """Quantities of living agents, in order of id: places, senses and networks."""
    yield "place", short(living["x"], living["y"])
    yield "angle", short(living["angle"])
    yield "velocity", short(*(living[key] for key in VELOCITY))
    for key in store_columns(world.config):
        if key in living:
            yield key, short(living[key])
    name = list(world.config.species)[index]
    inputs = observation_columns(world.config, name)
    seen = dict(zip(inputs, world.observations(index).T, strict=True))
    groups = sorted({_group(column) for column in inputs})
    for group in groups:
        yield f"senses.{group}", short(*(seen[column] for column in sorted(inputs) if _group(column) == group))
    if world.config.species[name].learning.policy in ("ppo", "fixed"):
        yield from _networks(world, inputs, living["species"], index)


def _networks(world: World, inputs: Sequence[str], species: NDArray[np.int32], index: int) -> Iterator[tuple[str, str]]:
    slots = world.living[world.agents()["species"] == index]
    parts = [split(params, len(inputs)) for params in world.view("params")[slots]]
    order = np.argsort(inputs)
    for name, layers in LAYERS.items():
        rows = [part[layer][order] if layer == "w1" else part[layer] for layer in layers for part in parts]
        yield f"network.{name}", short(*rows)


def _group(column: str) -> str:
    """The channel of an entry: `ray_wall` for `ray_wall_3`, `self` for what an agent senses of itself."""
    head, _, tail = column.rpartition("_")
    return head if tail.isdigit() else "self"


def _counted(world: World, index: int) -> Iterator[tuple[str, str]]:
    """Counters of one species since the start of the world."""
    counters = dict(world.counters_of(index))
    for name in MORE_COUNTERS:
        values = world.view(name)
        if len(values):
            counters[name.rpartition(".")[2]] = values[index]
    for name, value in counters.items():
        yield f"count.{name}", short(value)


def short_of(quantities: Quantities) -> str:
    """One digest of all quantities."""
    told = sorted((owner, name, digest) for owner, each in quantities.items() for name, digest in each.items())
    return hashlib.sha256(repr(told).encode()).hexdigest()[:16]
