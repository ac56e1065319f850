"""One world of a simulation, read between runs."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.layout import SpeciesLayout, choose_species, layouts, store_columns
from hedon.config.problem import did_you_mean
from hedon.error import ArgumentError, EngineError
from hedon.experiment.world_arrays import WorldArrays
from hedon.record.schema import Columns, columns_of
from hedon.text import brief


class World:
    """One world of a simulation, read between runs."""

    def __init__(self, engine: Any, index: int, config: Config) -> None:
        """Called by a simulation for each of its worlds.

        Args:
            engine: The compiled simulation, with all worlds.
            index: Index of the world in it.
            config: Settings of the world.
        """
        self._engine = engine
        self.index = index
        self.config = config
        self._row: int | None = None

    def __repr__(self) -> str:
        return f"<World of seed {self.seed} at step {self.step:,}, {self.alive:,} alive>"

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise ArgumentError("a world is a view of its simulation: copy or pickle the simulation")

    @cached_property
    def layouts(self) -> tuple[SpeciesLayout, ...]:
        """Layouts of the agents' numbers of each species, in the order of the config."""
        return tuple(layouts(self.config).values())

    @cached_property
    def columns(self) -> Columns:
        """Description of the columns of its records."""
        return columns_of(self.config)

    @property
    def row(self) -> int:
        """Its number among the worlds of its run: its index, unless a program drives it and records it with others."""
        return self.index if self._row is None else self._row

    @property
    def seed(self) -> int:
        """Its seed."""
        return self._engine.seed(self.index)

    @property
    def step(self) -> int:
        """Steps completed; it does not change after extinction."""
        return self._engine.head(self.index)["step"]

    @property
    def alive(self) -> int:
        """Number of agents alive."""
        return self._engine.head(self.index)["living_count"]

    @property
    def extinct_step(self) -> int | None:
        """Steps completed when the last agent died, or None."""
        step = self._engine.head(self.index)["extinct_step"]
        return None if step < 0 else step

    @property
    def extinct(self) -> bool:
        """Whether no agent is alive."""
        return self.extinct_step is not None

    @property
    def waiting_deaths(self) -> float:
        """Unread deaths as a share of the engine's space for them; above 1 if some were lost."""
        head = self._engine.head(self.index)
        return (head["death_log_count"] + head["death_log_lost"]) / len(self.view("death_log.birth_step"))

    @property
    def lost_deaths(self) -> int:
        """Deaths since the last call of `deaths` that can no longer be read, as newer ones have overwritten them."""
        return self._engine.head(self.index)["death_log_lost"]

    @property
    def counters(self) -> dict[str, Any]:
        """Births, deaths, failures and the energy ledger since the start of the world, over all species."""
        per_species = [self.counters_of(species) for species in range(len(self.config.species))]
        return {name: sum(counters[name] for counters in per_species) for name in per_species[0]}

    def counters_of(self, species: int | str) -> dict[str, Any]:
        """The same counters for one species.

        Args:
            species: Name of the species, or its index in the config; this holds for all methods.

        Raises:
            ArgumentError: There is no species of this name.
        """
        return self._engine.counters(self.index, self._species(species))

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent in each part of a step by the world's first thread [s]."""
        return self._engine.seconds(self.index)

    @property
    def living(self) -> NDArray[np.int32]:
        """Slots of living agents in the order of their ids, (alive,): their rows in the views."""
        return self.view("living")[: self.alive]

    @cached_property
    def state(self) -> WorldArrays:
        """The arrays as attributes: `world.state.energy` is `world.view("life.energy")`; see `WorldArrays`."""
        return WorldArrays(self.view, tuple(self._engine.view_names()))

    def view(self, path: str) -> NDArray[Any]:
        """A read-only view of one array of the state, of any shape, mostly by slot; valid until the next `run`.

        Args:
            path: Path of the array, such as `genome` (slots, genes), `physics.bodies.x` (slots), `life.energy` (slots),
                `params` (slots, parameters of a network). `hedon._engine.Simulation.view_names` lists all paths.

        Raises:
            ArgumentError: There is no such array.
        """
        try:
            return self._engine.view(self.index, path)
        except KeyError:
            hint = did_you_mean(str(path), self._engine.view_names())
            raise ArgumentError(f"view: the state has no array {brief(repr(path))}{hint}") from None

    def agents(self) -> dict[str, NDArray[Any]]:
        """Copies of the data of each living agent, (alive,) each, with `genome` (alive, genes).

        Each store besides energy appears under its name, with 0 for agents of species that do not have it.
        """
        rows = self._engine.living_rows(self.index)
        living = self.living
        rows["age"] = self.step - rows["birth_step"]
        for name in ("x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity"):
            rows[name] = self.view(f"physics.bodies.{name}")[living]
        return rows | self._held(rows.pop("store"), rows["species"])

    def _held(self, held: NDArray[np.float64], species: NDArray[np.int32]) -> dict[str, NDArray[np.float64]]:
        """Levels of agents' stores besides energy, by name; 0 if a species lacks the store."""
        levels = {name: np.zeros(len(species)) for name in store_columns(self.config)}
        for i, species_config in enumerate(self.config.species.values()):
            in_species = species == i
            for column, name in enumerate(species_config.store):
                levels[name][in_species] = held[in_species, column]
        return levels

    def deaths(self, *, partial: bool = False) -> dict[str, NDArray[Any]]:
        """Takes the data of each agent that died since the last call, (deaths,) each, with `genome` and stores.

        The engine stores the newest 16 deaths per slot. To get all deaths of a long simulation, call this between runs;
        if you do not need them, there is no need to call it.

        Args:
            partial: Take the remaining deaths even if older ones are lost; `lost_deaths` is the number of lost ones.

        Raises:
            EngineError: Some deaths are lost, and `partial` is false. Nothing is taken then.
            ArgumentError: The world is recorded (`hedon.make(record=…)`), and its records take the deaths.
        """
        if self._row is not None:
            raise ArgumentError("deaths: the world is recorded, and its records take them: read them there, at the end")
        return self._take_deaths(partial=partial)

    def _take_deaths(self, *, partial: bool) -> dict[str, NDArray[Any]]:
        lost = self.lost_deaths
        if lost and not partial:
            slots = len(self.view("death_log.birth_step"))
            raise EngineError(
                f"world {self.index}: {lost:,} deaths are lost, since more than {slots:,} came before they were read: "
                "call World.deaths more often, or take those that are left with World.deaths(partial=True)"
            )
        rows = self._engine.take_rows(self.index)
        return rows | self._held(rows.pop("store"), rows["species"])

    def foods(self) -> dict[str, NDArray[Any]]:
        """Kind (index in the config's order) and place [u] of each food present, (foods,) each."""
        present = self.view("physics.circles.present").astype(bool)
        capacities = [food.capacity for food in self.config.food.values()]
        kind = np.repeat(np.arange(len(capacities), dtype=np.int32), capacities)
        circles = {name: self.view(f"physics.circles.{name}")[present] for name in ("x", "y")}
        return {"kind": kind[present], **circles}

    @property
    def obstacles(self) -> NDArray[np.float32]:
        """Corners of each obstacle [u], (obstacles, corners, 2)."""
        count, corners = self.config.obstacle.count, self.config.obstacle.corners
        return self.view("obstacle").reshape(count, corners, 2).copy()

    def observations(self, species: int | str = 0) -> NDArray[np.float32]:
        """Current observation of each living agent of a species, (alive, observation size).

        Args:
            species: Name or index of the species.

        Raises:
            ArgumentError: There is no species of this name.
        """
        return self._engine.observations(self.index, self._species(species))

    def rays(self, species: int | str = 0) -> NDArray[np.float32]:
        """Rays in the observations of a species: (alive, rays, types that it sees).

        Args:
            species: Name or index of the species.

        Raises:
            ArgumentError: There is no species of this name.
        """
        i = self._species(species)
        rays, type_count = list(self.config.species.values())[i].sensor.ray_count, len(self.layouts[i].sees)
        return self.observations(species)[:, : type_count * rays].reshape(-1, type_count, rays).swapaxes(1, 2)

    def digest(self) -> str:
        """Hash of the world's whole state, equal for equal bits."""
        return f"{self._engine.digest(self.index):016x}"

    def _species(self, species: int | str) -> int:
        names = list(self.config.species)
        return names.index(choose_species(species, self.config)) if isinstance(species, str) else species
