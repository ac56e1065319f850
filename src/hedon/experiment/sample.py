"""Rows of the records, and data for the final picture, from a world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.schema.arena import walls
from hedon.config.type import types
from hedon.experiment.world import World
from hedon.record.checkpoint import Sampled
from hedon.record.schema import CAUSES, Columns
from hedon.record.snapshot import Snapshot, own_bodies

Rows = dict[str, Any]


def agent_rows(world: World, lives: dict[str, NDArray[Any]]) -> Rows:
    """Rows of the table `agents`.

    Args:
        world: World of the agents.
        lives: A value per agent by name, (agents,), with `genome` (agents, genes) and `eaten` (agents, meals), as from
            `World.agents` and `World.deaths`.
    """
    columns = world.columns
    end = np.where(lives["death_step"] < 0, world.step, lives["death_step"])
    steps = np.maximum(end - lives["birth_step"], 1)
    direct = ("agent_id", "parent_id", "generation", "birth_step", "death_step", "birth_energy", "energy")
    direct += ("energy_gained", "energy_spent", "children", "distance", *(("mate_id",) if columns.mating else ()))
    rows = {
        "world": world.row,
        "seed": world.seed,
        **{name: lives[name] for name in direct},
        **_held_rows(world, lives),
        **{f"eaten_{name}": lives["eaten"][:, k] for name, k in _meals(columns).items()},
        "mean_force_left": lives["force_left"] / steps,
        "mean_force_right": lives["force_right"] / steps,
        "reward_sum": lives["reward"],
        **_gene_rows(world, lives),
    }
    if columns.several:
        rows["species"] = np.array(columns.species)[lives["species"]]
    if columns.has_causes:
        rows["cause"] = np.array([*CAUSES, None])[lives["cause"]]  # -1 while it lives
    return rows


def _gene_rows(world: World, agents: dict[str, NDArray[Any]]) -> Rows:
    """Genes of agents by column; NaN if a species lacks a gene."""
    rows: Rows = {}
    for name in world.columns.gene_names:
        values = np.full(len(agents["species"]), np.nan, np.float32)
        for species, layout in enumerate(world.layouts):
            if name in layout.gene_names:
                in_species = agents["species"] == species
                values[in_species] = agents["genome"][in_species, layout.gene_names.index(name)]
        rows[name] = values
    return rows


def _held_rows(world: World, agents: dict[str, NDArray[Any]]) -> Rows:
    """Levels of agents' stores other than energy, by column; NaN if a species lacks one."""
    rows: Rows = {}
    for name in world.columns.held_names:
        has_store = np.array([name in species.store for species in world.config.species.values()])
        rows[name] = np.where(has_store[agents["species"]], agents[name], np.nan).astype(np.float32)
    return rows


class PopulationSampler:
    """Makes rows of the table `population` of one species of a world: its state now, and counts since the last row.

    Args:
        world: The world to sample.
        species: Index of the species in the config.
        since: Counts from which the next row starts; None for the world's present state.
    """

    def __init__(self, world: World, species: int = 0, since: Sampled | None = None) -> None:
        self.world = world
        self.species = species
        self.columns = world.columns
        self.since = since or self._now()

    def advance(self) -> None:
        """Makes the next row count from now."""
        self.since = self._now()

    def row(self) -> Rows:
        """Row of the interval that ends now."""
        world, since = self.world, self.since
        agents = world.agents()
        agents = {name: values[agents["species"] == self.species] for name, values in agents.items()}
        current = self._now()
        food_counts = world.view("food_stock.present")
        row: Rows = {
            "world": world.row,
            "seed": world.seed,
            "step": world.step,
            "steps": world.step - since.step,
        }
        if self.columns.several:
            row["species"] = self.columns.species[self.species]
        row["alive"] = len(agents["energy"])
        counter_names = [name for name in current.counters if name != "energy_initial"]
        row |= {name: current.counters[name] - since.counters[name] for name in counter_names}
        row |= _spread("energy", agents["energy"]) | _spread("age", agents["age"])
        generation = agents["generation"]
        row["generation_mean"] = generation.mean() if len(generation) else np.nan
        row["generation_max"] = generation.max() if len(generation) else -1
        for name, weight in _gene_rows(world, agents).items():
            row[f"{name}_mean"] = weight.mean() if len(weight) else np.nan
            row[f"{name}_sd"] = weight.std() if len(weight) else np.nan
        for k, kind in enumerate(world.config.food):
            row[f"food_{kind}"] = int(food_counts[k])
        for name, k in _meals(self.columns).items():
            row[f"eaten_{name}"] = current.eaten[k] - since.eaten[k]
        row["energy_total"] = agents["energy"].sum()
        stores = list(world.config.species.values())[self.species].store
        for name in self.columns.stores:
            row[f"{name}_mean"] = agents[name].mean() if name in stores and len(agents[name]) else np.nan
        return row

    def _now(self) -> Sampled:
        world = self.world
        counters = world.counters_of(self.species)
        if self.columns.obstacles:
            for name in ("obstacles_touched", "energy_damage"):
                counters[name] = world.view(f"obstacle_counters.{name}")[self.species].item()
        hunt_counters = ("deaths_eaten", "energy_hunted", "energy_prey") if self.columns.has_hunts else ()
        for name in (*(("deaths_starved",) if self.columns.has_causes else ()), *hunt_counters):
            counters[name] = world.view(f"hunt_counters.{name}")[self.species].item()
        by_species = world.view("eaten_by")
        eaten = by_species[self.species] if len(by_species) else world.view("food_stock.eaten")
        return Sampled(world.step, counters, tuple(eaten.tolist()))


def frame_rows(world: World) -> list[Rows]:
    """Rows of the table `frames`: the current state of every agent and food of a world."""
    living, foods = world.agents(), world.foods()
    keys = {"world": world.row, "step": world.step}
    columns = {column: living[column] for column in ("x", "y", "angle", "energy")}
    rows = []
    for species, name in enumerate(world.config.species):
        selected = living["species"] == species
        agents = {column: values[selected] for column, values in (_held_rows(world, living) | columns).items()}
        rows.append({**keys, "kind": name, "id": living["agent_id"][selected], **agents})
    for k, kind in enumerate(world.config.food):
        selected = foods["kind"] == k
        rows.append({**keys, "kind": kind, "x": foods["x"][selected], "y": foods["y"][selected]})
    return rows


def snapshot(world: World) -> Snapshot:
    """The present state of a world, for a picture."""
    agents, foods, config = world.agents(), world.foods(), world.config
    kinds = list(config.species.values())
    return Snapshot(
        world=world.row,
        seed=world.seed,
        step=world.step,
        **{name: agents[name] for name in ("agent_id", "x", "y", "angle", "energy", "species")},
        rays=_rays(world, agents["species"]),
        food_kind=foods["kind"],
        food_x=foods["x"],
        food_y=foods["y"],
        walls=walls(config.arena),
        obstacles=world.obstacles,
        food_kinds=tuple(config.food),
        species_names=tuple(config.species),
        food_radius=config.world.food_radius,
        radius=np.array([kind.body.radius for kind in kinds]),
        ray_count=np.array([kind.sensor.ray_count for kind in kinds]),
        ray_length=np.array([kind.sensor.ray_length for kind in kinds]),
        ray_spread=np.array([kind.sensor.ray_spread for kind in kinds]),
        mouth_spread=np.array([kind.sensor.mouth_spread for kind in kinds]),
        mouth_center=np.array([kind.sensor.mouth_center for kind in kinds]),
        own=own_bodies(config, agents["species"], _gene_rows(world, agents)),
    )


def _rays(world: World, species: NDArray[np.int32]) -> NDArray[np.float32]:
    """Rays of all agents, by the types of the world."""
    type_names = types(world.config)
    most_rays = max(kind.sensor.ray_count for kind in world.config.species.values())
    rays = np.full((len(species), most_rays, len(type_names)), -1.0, np.float32)
    for i, layout in enumerate(world.layouts):
        members = np.flatnonzero(species == i)
        if len(members):
            observed = world.rays(i)
            channels = np.array([type_names.index(name) for name in layout.sees])
            rays[np.ix_(members, np.arange(observed.shape[1]), channels)] = observed
    return rays


def _meals(columns: Columns) -> dict[str, int]:
    """What agents eat, with its index in the engine's arrays: kinds of food, then species."""
    kinds = {kind: k for k, kind in enumerate(columns.food_kinds)}
    return kinds | {name: len(kinds) + columns.species.index(name) for name in columns.prey}


def _spread(name: str, values: NDArray[Any]) -> Rows:
    statistics = ("mean", "sd", "min", "q25", "median", "q75", "max")
    if len(values) == 0:
        return {f"{name}_{statistic}": np.nan for statistic in statistics}
    numbers = (values.mean(), values.std(), *np.quantile(values, (0.0, 0.25, 0.5, 0.75, 1.0)))
    return {f"{name}_{statistic}": number for statistic, number in zip(statistics, numbers, strict=True)}
