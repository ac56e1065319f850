"""The engine's worlds as Python objects: create them from a config, run, save and continue them."""

import copy
import json
import os
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from importlib.metadata import version
from typing import Any, Self

import numpy as np

from hedon import _engine
from hedon.config.config import Config
from hedon.config.dump import digest
from hedon.config.engine import EngineInput, engine_input
from hedon.config.layout import layouts
from hedon.copied import Cloned
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_THREADS, integer, seed_list
from hedon.experiment.device import device_library
from hedon.experiment.rule import Rule
from hedon.experiment.rule import rules as find_rules
from hedon.experiment.world import World
from hedon.record.founder import Founders
from hedon.record.manifest import RuleSource
from hedon.record.network import NetworkError, Networks, fixed_species
from hedon.shown import table_html
from hedon.text import brief, count

BACKEND_VARIABLE = "HEDON_BACKEND"
"""Environment variable that forces an instruction set; see `hedon run --help`."""
SCRATCH_VARIABLE = "HEDON_SCRATCH"
"""Environment variable that names a folder for the learners' moments and observations, which then use no memory; see
the guide on large worlds. It changes no result."""
MAX_WORLD_SEED = 2**64 - 1
"""Largest seed of a world; records of a run hold only the lower half of these."""
MAX_RUN_STEPS = 2**62
MARKS = {"hedon": "by another version of hedon", "config": "with another config", "rules": "with other rules"}
"""What saved worlds and their continuations must share, with the message if they differ."""


class Simulation(Cloned):
    """Worlds of one config, advanced together. A seed gives the same world, whatever other worlds run with it.

    Example:
        >>> from hedon.config.load import load_config
        >>> from hedon.experiment.simulation import Simulation
        >>> simulation = Simulation(load_config("baseline"), seeds=[1, 2])
        >>> simulation.run(1024)
        >>> simulation.worlds[0].agents()["energy"].mean()

    Args:
        config: Settings of the worlds.
        seeds: One seed per world, each in [0, 2^64).
        threads: Number of threads; 0 for all processors that this process may use. Changes no result.
        backend: Backend: an instruction set, one of `hedon._engine.kernel.kernel_names`, or a device, "cuda"; empty for
            the value of the environment variable HEDON_BACKEND, or else the best instruction set.
        rules: Texts of the rules that the config is pinned to, such as `RunPlan.rules`; all others are read from their
            files.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        RuleError: A rule of the config is missing, has changed, or cannot be compiled.
        EngineError: The backend is unknown or not for this processor, there is too little memory, or there is no room
            for the initial agents or foods.

    Every method, and every method of its worlds, raises EngineError while the simulation runs in another thread, and in
    a process forked from the one that created it, since the simulation's threads do not exist there.
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
            inputs = engine_input(config)
        self._begin(inputs, seed_list(seeds, MAX_WORLD_SEED), threads, backend, find_rules(inputs.config, rules))

    def _begin(
        self, inputs: EngineInput, seeds: tuple[int, ...], threads: int, backend: str, rules: tuple[Rule, ...]
    ) -> None:
        self.config = inputs.config
        self._inputs, self._backend = inputs, backend
        self._driven = False  # whether an environment drives the worlds
        self._threads = integer("threads", threads, 0, MAX_THREADS)
        if not isinstance(backend, str):
            raise ArgumentError(f"backend: must be the name of an instruction set, not {backend!r}")
        if os.environ.get("HEDON_KERNEL"):
            raise ArgumentError(f"HEDON_KERNEL: this variable is {BACKEND_VARIABLE} now")
        backend = backend or os.environ.get(BACKEND_VARIABLE, "")
        device = device_library(backend)
        host = "" if device else backend
        self.engine = _engine.Simulation(
            inputs.settings,
            inputs.walls,
            inputs.outer_walls,
            list(seeds),
            self._threads,
            host,
            device=device,
            scratch=os.environ.get(SCRATCH_VARIABLE, ""),
        )
        self.rules = rules
        for rule in self.rules:
            species = list(self.config.species).index(rule.species)
            name = f"{rule.use}.rule of {rule.species} ({rule.source.file}:{rule.source.name})"
            self.engine.set_rule(species, rule.use, rule.compiled.address, name)
        self.worlds = tuple(World(self.engine, i, self.config) for i in range(len(seeds)))
        self._keep_own("_mark")

    @property
    def seeds(self) -> tuple[int, ...]:
        """Seed of each world."""
        return tuple(world.seed for world in self.worlds)

    def __repr__(self) -> str:
        alive = sum(world.alive for world in self.worlds)
        return f"<Simulation {self._line()}, {alive:,} alive>"

    def _repr_html_(self) -> str:
        """Shown in notebooks: a row for each world."""
        rows = [[world.seed, f"{world.step:,}", f"{world.alive:,}"] for world in self.worlds]
        return table_html(self._line(), ("seed", "step", "alive"), rows)

    def _line(self) -> str:
        step = max(world.step for world in self.worlds)
        return f"{self.config.name} ({self.config.fidelity}): {count(len(self.worlds), 'world')} at step {step:,}"

    def _require_free(self, call: str) -> None:
        """Raises ArgumentError if an environment drives these worlds, since it would not know of this call."""
        if self._driven:
            raise ArgumentError(
                f"{call}: an environment drives these worlds, and nobody else may change them: call its step, reset or "
                "restore"
            )

    def run(self, steps: int) -> None:
        """Advances every world that is not extinct; agents learn at the end of each window.

        Other Python threads can run at the same time. Ctrl-C in the main thread takes effect within a fraction of a
        second, or when the learning at the end of a window is done. The worlds are then in a valid state and can
        continue.

        Args:
            steps: Number of steps, not necessarily whole windows.

        Raises:
            ArgumentError: `steps` is negative or not an integer, or an environment advances the worlds.
            EngineError: A world reports an error; the message gives the world, the step and the agent.
            KeyboardInterrupt: Ctrl-C was pressed; the worlds have done fewer steps than `steps`.
        """
        self._require_free("run")
        self.engine.run(integer("steps", steps, 0, MAX_RUN_STEPS))

    def set_founders(self, founders: Founders) -> None:
        """Gives the founders of every world the genes from a table; call it before the first step.

        Raises:
            FounderError: The table does not fit the config.
        """
        self._require_free("set_founders")
        founders.require(self.config)
        for world in self.worlds:
            agents = world.agents()
            genomes = agents["genome"].copy()
            for i, (name, layout) in enumerate(layouts(self.config).items()):
                members = np.flatnonzero(agents["species"] == i)
                founder_genomes = founders.of_species(name).genomes(world.seed, len(members), layout.gene_names)
                index = np.ix_(members, np.arange(len(layout.genes)))
                genomes[index] = np.where(np.isnan(founder_genomes), genomes[index], founder_genomes)
            self.engine.set_genomes(world.index, genomes.astype(np.float32))

    def set_networks(self, networks: Networks) -> None:
        """Gives the founders of species that never learn the networks from a file; call it before the first step.

        Raises:
            NetworkError: The networks do not fit the config.
        """
        self._require_free("set_networks")
        networks.require(self.config)
        names = list(self.config.species)
        for world in self.worlds:
            species = world.agents()["species"]
            for name in fixed_species(self.config):
                i = names.index(name)
                founder_networks = networks.draw(name, world.seed, int((species == i).sum()))
                try:
                    self.engine.set_networks(world.index, i, founder_networks)
                except ValueError as error:
                    raise NetworkError(f"networks of {name}: {error}") from None

    @property
    def extinct(self) -> bool:
        """Whether no agent is alive in any world."""
        return all(world.extinct for world in self.worlds)

    def reset(self, seeds: Sequence[int]) -> None:
        """Restarts all worlds.

        Args:
            seeds: One seed per world, each in [0, 2^64).

        Raises:
            ArgumentError: The seeds are not a list, or their number differs from that of the worlds.
            EngineError: A world has no room for its initial agents or foods.
        """
        self._require_free("reset")
        for world, seed in zip(self.worlds, self._seeds_of(seeds), strict=True):
            self.engine.reset(world.index, seed)

    def _seeds_of(self, seeds: Any) -> tuple[int, ...]:
        """Returns one seed per world. Raises ArgumentError for anything else."""
        checked_seeds = seed_list(seeds, MAX_WORLD_SEED)
        if len(checked_seeds) != len(self.worlds):
            raise ArgumentError(f"seeds: there must be {len(self.worlds)}, one per world, not {len(checked_seeds)}")
        return checked_seeds

    def reseed(self, seeds: Sequence[int]) -> None:
        """Gives all worlds other random numbers from now on: the same agents, genes, networks and food, another future.

        Unread deaths (`World.deaths`) are discarded.

        Args:
            seeds: One seed per world, each in [0, 2^64).

        Raises:
            ArgumentError: The seeds are not a list, their number differs from that of the worlds, or worlds have
                obstacles, whose places depend on the seed.
            EngineError: A world has stopped at a fault.
        """
        self._require_free("reseed")
        checked_seeds = self._seeds_of(seeds)
        if self.config.obstacle.count:
            raise ArgumentError("reseed: the places of obstacles follow from a world's seed: these worlds have some")
        for world, seed in zip(self.worlds, checked_seeds, strict=True):
            state = self.engine.save(world.index)
            self.engine.reset(world.index, seed)
            self.engine.restore(world.index, state)

    def save(self) -> bytes:
        """Saves the current state of all worlds, with their seeds; `restore` continues from it with the same bits.

        Unread deaths (`World.deaths`) are not included.

        Raises:
            EngineError: A world has stopped at a fault.
        """
        return self._pack(b"")

    def restore(self, saved: bytes) -> None:
        """Replaces these worlds and their seeds with saved ones; threads and backend may differ.

        Args:
            saved: Bytes from `save`, of as many worlds with the same config, rules and version of hedon.

        Raises:
            ArgumentError: The bytes are of something else or damaged. The worlds then stay as they are.
        """
        self._require_free("restore")
        self._unpack(saved)
        self._restore(saved)

    def clone(self) -> Self:
        """Returns a copy with its own worlds, which continues as this one would, like `copy.copy` and `deepcopy`."""
        clone = self._fresh_one()
        clone._restore(self.save())
        vars(clone).update(copy.deepcopy(self._added()))
        return clone

    def __getstate__(self) -> dict[str, Any]:
        return self._arguments() | {"saved": self.save(), "added": self._added()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        saved, added = state.pop("saved", None), state.pop("added", {})
        with _engine.FloatMode():
            inputs = engine_input(state.pop("config"))
        self._begin(inputs, **state)
        if saved is not None:
            self.restore(saved)
        vars(self).update(added)

    def _arguments(self) -> dict[str, Any]:
        """Arguments that created it; rules are without what is compiled for this process."""
        rules = tuple(replace(rule) for rule in self.rules)
        arguments = {"config": self.config, "seeds": self.seeds, "threads": self._threads, "backend": self._backend}
        return {**arguments, "rules": rules}

    def _fresh_one(self) -> Self:
        """A new simulation with the same arguments, at its start."""
        simulation = type(self).__new__(type(self))
        simulation._begin(self._inputs, self.seeds, self._threads, self._backend, self.rules)
        return simulation

    @cached_property
    def _mark(self) -> dict[str, Any]:
        """What worlds must share to continue from one another's states."""
        rules = [[rule.species, rule.use, rule.source.name, rule.source.digest] for rule in self.rules]
        return {"hedon": version("hedon"), "config": digest(self.config), "rules": rules}

    def _pack(self, payload: bytes) -> bytes:
        return self.engine.pack(json.dumps(self._mark).encode() + b"\n" + payload)

    def _unpack(self, saved: Any) -> bytes:
        """The bytes given to `_pack`. Raises ArgumentError if this simulation cannot continue from these worlds."""
        if not isinstance(saved, bytes):
            raise ArgumentError(f"saved = {brief(repr(saved))}: must be bytes, as `save` gives them")
        try:
            head, _, payload = self.engine.packed_head(saved).partition(b"\n")
            mark = json.loads(head)
        except ValueError as error:
            raise ArgumentError(f"saved: these bytes {error}") from None
        for name, description in MARKS.items():
            stored, current = mark.get(name), self._mark[name]
            if stored != current:
                detail = f" ({stored}, here {current})" if name == "hedon" else ""
                raise ArgumentError(f"saved: these worlds were saved {description}{detail}")
        return payload

    def _become(self, saved: Any) -> dict[str, Any]:
        """Turns all worlds into the only saved one, each with its own seed.

        Returns:
            The arrays of that world, for `_engine.Simulation.restore`.

        Raises:
            ArgumentError: The bytes are of something else, or these worlds have obstacles.
        """
        if self.config.obstacle.count:
            raise ArgumentError("world: the places of obstacles follow from a world's seed: these worlds have some")
        single = type(self).__new__(type(self))
        single._begin(self._inputs, (0,), 1, self._backend, self.rules)
        single._unpack(saved)
        single._restore(saved)
        arrays = single.engine.save(0)
        for world in self.worlds:
            self.engine.restore(world.index, arrays)
        return arrays

    def _restore(self, saved: bytes) -> None:
        try:
            self.engine.unpack(saved)
        except ValueError as error:
            raise ArgumentError(f"saved: {error}") from None
