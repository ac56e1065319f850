"""The engine's worlds as Python objects: make them from a config, run them, read them."""

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_input
from hedon.config.layout import layouts, store_columns
from hedon.error import ArgumentError, EngineError
from hedon.experiment.argument import MAX_THREADS, integer, seed_list
from hedon.experiment.device import device_library
from hedon.experiment.rule import rules as find_rules
from hedon.record.founder import Founders
from hedon.record.manifest import RuleSource
from hedon.record.network import NetworkError, Networks, fixed_species

BACKEND_VARIABLE = "HEDON_BACKEND"
"""Environment variable that forces an instruction set; see `hedon run --help`."""
MAX_WORLD_SEED = 2**64 - 1
"""Largest seed of a world; records of a run hold only the lower half of these."""
MAX_RUN_STEPS = 2**62


class Simulation:
    """Worlds of one config, advanced together. A seed gives the same world, whatever other worlds run with it.

    Example:
        >>> from hedon.config.load import load_config
        >>> from hedon.experiment.simulation import Simulation
        >>> simulation = Simulation(load_config("baseline"), seeds=[1, 2])
        >>> simulation.run(1024)
        >>> simulation.worlds[0].agents()["energy"].mean()

    Args:
        config: Settings of the worlds.
        seeds: One world per seed, each in [0, 2^64).
        threads: Threads to use; 0 for all processors that this process may use. Changes no result.
        backend: What computes: an instruction set, one of `hedon._engine.kernel.kernel_names`, or a device, "cuda";
            empty for what the environment variable HEDON_BACKEND names, otherwise the best instruction set.
        rules: Texts of the rules that the config is pinned to, such as `RunPlan.rules`; all others are read from their
            files.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        RuleError: A rule of the config is not there, has changed, or cannot be compiled.
        EngineError: The backend is unknown or not for this processor, there is too little memory, or there is no room
            for the initial agents or foods.

    Every method, and every method of its worlds, raises EngineError while the simulation runs in another thread, and
    in a process that was forked from the one that made it: the simulation's threads do not exist there.
    """

    def __init__(
        self,
        config: Config,
        seeds: Sequence[int],
        threads: int = 0,
        backend: str = "",
        rules: Sequence[RuleSource] = (),
    ) -> None:
        with _engine.FloatMode():  # the walls must not depend on the caller's rounding mode
            given = engine_input(config)
        self.config = given.config
        self.seeds = seed_list(seeds, MAX_WORLD_SEED)
        threads = integer("threads", threads, 0, MAX_THREADS)
        if not isinstance(backend, str):
            raise ArgumentError(f"backend: must be the name of an instruction set, not {backend!r}")
        if os.environ.get("HEDON_KERNEL"):
            raise ArgumentError(f"HEDON_KERNEL: this variable is {BACKEND_VARIABLE} now")
        backend = backend or os.environ.get(BACKEND_VARIABLE, "")
        device = device_library(backend)
        host = "" if device else backend
        self.engine = _engine.Simulation(
            given.settings, given.walls, given.outer_walls, list(self.seeds), threads, host, device=device
        )
        self.rules = find_rules(self.config, rules)
        for rule in self.rules:
            species = list(self.config.species).index(rule.species)
            self.engine.set_rule(species, rule.use, rule.compiled.address)
        self.worlds = tuple(World(self.engine, i, self.config, seed) for i, seed in enumerate(self.seeds))

    def run(self, steps: int) -> None:
        """Advances every world that is not extinct; agents learn at the end of each window.

        Other Python threads can run at the same time. Ctrl-C in the main thread takes effect within a fraction of a
        second, or when the learning at the end of a window is done. The worlds are then in a valid state and can
        continue.

        Args:
            steps: How many steps; any number, not only whole windows.

        Raises:
            ArgumentError: `steps` is negative or not a whole number.
            EngineError: A world reports an error; it names the world, the step and the agent.
            KeyboardInterrupt: Ctrl-C was pressed; the worlds have done fewer steps than `steps`.
        """
        self.engine.run(integer("steps", steps, 0, MAX_RUN_STEPS))

    def set_founders(self, founders: Founders) -> None:
        """Gives the founders of every world the genes of a table; call it before the first step.

        Raises:
            FounderError: The table does not fit the config.
        """
        founders.require(self.config)
        for world in self.worlds:
            agents = world.agents()
            genomes = agents["genome"].copy()
            for i, (name, layout) in enumerate(layouts(self.config).items()):
                mine = np.flatnonzero(agents["species"] == i)
                given = founders.of_species(name).genomes(world.seed, len(mine), layout.gene_names)
                at = np.ix_(mine, np.arange(len(layout.genes)))
                genomes[at] = np.where(np.isnan(given), genomes[at], given)
            self.engine.set_genomes(world.index, genomes.astype(np.float32))

    def set_networks(self, networks: Networks) -> None:
        """Gives the founders of the species that never learn the networks of a file; call it before the first step.

        Raises:
            NetworkError: The networks do not fit the config.
        """
        networks.require(self.config)
        names = list(self.config.species)
        for world in self.worlds:
            species = world.agents()["species"]
            for name in fixed_species(self.config):
                i = names.index(name)
                given = networks.draw(name, world.seed, int((species == i).sum()))
                try:
                    self.engine.set_networks(world.index, i, given)
                except ValueError as error:
                    raise NetworkError(f"networks of {name}: {error}") from None

    @property
    def extinct(self) -> bool:
        """Whether no agent is alive in any world."""
        return all(world.extinct for world in self.worlds)


class World:
    """One world of a simulation, read between runs."""

    def __init__(self, engine: Any, index: int, config: Config, seed: int) -> None:
        """A simulation makes its worlds.

        Args:
            engine: The compiled simulation, with all worlds.
            index: Of the world in it.
            config: Of the world.
            seed: Of the world.
        """
        self._engine = engine
        self.index = index
        self.config = config
        self.seed = seed

    @property
    def step(self) -> int:
        """Steps completed; it does not change after extinction."""
        return self._engine.head(self.index)["step"]

    @property
    def alive(self) -> int:
        """Agents alive."""
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
        """Deaths that have not been read, as a share of the engine's room for them; above 1 where some were lost."""
        head = self._engine.head(self.index)
        return (head["death_log_count"] + head["death_log_lost"]) / len(self.view("death_log.birth_step"))

    @property
    def lost_deaths(self) -> int:
        """Deaths since the last call of `deaths` that can no longer be read: newer ones took their room."""
        return self._engine.head(self.index)["death_log_lost"]

    @property
    def counters(self) -> dict[str, Any]:
        """Births, deaths, failures and the energy ledger since the world began, over all species."""
        each = [self.counters_of(species) for species in range(len(self.config.species))]
        return {name: sum(counters[name] for counters in each) for name in each[0]}

    def counters_of(self, species: int) -> dict[str, Any]:
        """The same of one species, by its index in the config's order."""
        return self._engine.counters(self.index, species)

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent in each part of a step by the world's first thread [s]."""
        return self._engine.seconds(self.index)

    @property
    def living(self) -> NDArray[np.int32]:
        """Slots of the living in the order of their ids, (alive,): their rows in the views."""
        return self.view("living")[: self.alive]

    def view(self, path: str) -> NDArray[Any]:
        """A read-only view of one array of the state, of any shape, mostly by slot; valid until the next `run`.

        Args:
            path: For example `genome` (slots, genes), `physics.bodies.x` (slots), `life.energy` (slots), `params`
                (slots, parameters of a network). `hedon._engine.Simulation.view_names` lists them all.

        Raises:
            KeyError: There is no such array.
        """
        return self._engine.view(self.index, path)

    def agents(self) -> dict[str, NDArray[Any]]:
        """Copies of the data of each living agent, (alive,) each, with `genome` (alive, genes).

        Each store beside energy is there by its name, with 0 for agents of species that do not have it.
        """
        rows = self._engine.living_rows(self.index)
        living = self.living
        rows["age"] = self.step - rows["birth_step"]
        for name in ("x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity"):
            rows[name] = self.view(f"physics.bodies.{name}")[living]
        return rows | self._held(rows.pop("store"), rows["species"])

    def _held(self, held: NDArray[np.float64], species: NDArray[np.int32]) -> dict[str, NDArray[np.float64]]:
        """What agents of these species hold of each store beside energy, by its name; 0 of those that they lack."""
        found = {name: np.zeros(len(species)) for name in store_columns(self.config)}
        for i, each in enumerate(self.config.species.values()):
            mine = species == i
            for column, name in enumerate(each.store):
                found[name][mine] = held[mine, column]
        return found

    def deaths(self, *, partial: bool = False) -> dict[str, NDArray[Any]]:
        """Takes the data of each agent that died since the last call, (deaths,) each, with `genome`, and its stores.

        The engine has room for the newest 16 deaths per slot: to have all of a long simulation, call this between
        runs. Without a use for them you need not call it.

        Args:
            partial: Take those that are left, where older ones are lost; `lost_deaths` is the number of the others.

        Raises:
            EngineError: Some are lost, and `partial` is false. Nothing is taken then.
        """
        lost = self.lost_deaths
        if lost and not partial:
            room = len(self.view("death_log.birth_step"))
            raise EngineError(
                f"world {self.index}: {lost:,} deaths are lost, since more than {room:,} came before they were read: "
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
        """Places of the corners of each obstacle [u], (obstacles, corners, 2)."""
        count, corners = self.config.obstacle.count, self.config.obstacle.corners
        return self.view("obstacle").reshape(count, corners, 2).copy()

    def observations(self, species: int = 0) -> NDArray[np.float32]:
        """What each living agent of a species observes now, (alive, observation size)."""
        return self._engine.observations(self.index, species)

    def rays(self, species: int = 0) -> NDArray[np.float32]:
        """The rays of the observations of a species: (alive, rays, types that it sees)."""
        name = list(self.config.species)[species]
        rays, seen = self.config.species[name].sensor.ray_count, len(layouts(self.config)[name].sees)
        return self.observations(species)[:, : seen * rays].reshape(-1, seen, rays).swapaxes(1, 2)

    def digest(self) -> str:
        """A hash of the world's whole state: equal for equal bits."""
        return f"{self._engine.digest(self.index):016x}"
