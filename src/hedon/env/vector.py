"""Many worlds as arrays: a caller writes actions into one array and reads observations and rewards from others.

The engine reads and writes the arrays that the groups of agents hold: a step makes and copies none of them.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from hedon.config.config import Config
from hedon.config.layout import observation_columns
from hedon.config.problem import nearest
from hedon.env.group import Group
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_STEPS, integer, seed_list
from hedon.experiment.simulation import MAX_WORLD_SEED, Simulation
from hedon.text import brief


class VectorEnv:
    """Worlds whose agents, all or those of some species, are driven by the caller; the others learn by themselves.

    Args:
        config: Settings of the worlds.
        seeds: One world per seed.
        species: Whose agents the caller drives; None as for `vector_env`.
        threads: As in `hedon.Simulation`.
        backend: As in `hedon.Simulation`.

    Attributes:
        config: The config, with the policy `external` for the species that are driven.
        groups: The driven agents, by the name of their species.
        simulation: The worlds themselves, to be read between steps; `reset` makes a new one.

    Example:
        >>> import hedon, hedon.env
        >>> worlds = hedon.env.vector_env(hedon.load_config("baseline"), seeds=[1, 2])
        >>> agents = worlds.groups["agent"]
        >>> agents.actions[...] = 0.5  # or a policy of agents.observations
        >>> worlds.step()
        >>> agents.rewards[agents.alive].mean()
    """

    def __init__(
        self, config: Config, seeds: Sequence[int], species: str | Sequence[str] | None, threads: int, backend: str
    ) -> None:
        names = driven(config, species)
        self.config = _with_callers(config, names)
        self._threads, self._backend = threads, backend
        self.simulation = Simulation(self.config, seeds, threads, backend)
        every = list(config.species)
        meals = (*config.food, *every)[: self.simulation.engine.meals(0).shape[1]]
        self.groups = {
            name: Group(
                every.index(name),
                observation_columns(config, name),
                meals,
                len(self.simulation.seeds),
                config.species[name].population.capacity,
            )
            for name in names
        }
        self._look()

    def reset(self, seeds: Sequence[int] | None = None) -> None:
        """Begins again, with the same seeds or with as many others. The groups keep their arrays.

        Raises:
            ArgumentError: It is no list of seeds, there are more or fewer than worlds, or one is out of bounds.
        """
        wanted = self.simulation.seeds if seeds is None else seed_list(seeds, MAX_WORLD_SEED)
        if len(wanted) != len(self.simulation.seeds):
            raise ArgumentError(f"seeds: there must be {len(self.simulation.seeds)}, one per world, not {len(wanted)}")
        self.simulation = Simulation(self.config, wanted, self._threads, self._backend)
        for group in self.groups.values():
            group._forget()
        self._look()

    def step(self, repeat: int = 1) -> None:
        """Advances every world, with the actions that the groups hold; then the arrays are of the new step.

        Args:
            repeat: Steps with the same actions: the same as this many calls of `step` in which nobody writes an action.
                Rewards and meals are sums over all of them, and all births and deaths are there: see `Group`.

        Raises:
            ArgumentError: An action is not a finite number, or `repeat` is not a positive whole number.
            EngineError: A world reports an error.
        """
        steps = integer("repeat", repeat, 1, MAX_STEPS)
        engine, groups = self.simulation.engine, self.groups.values()
        for group in groups:
            group._tell(engine)
        if steps == 1:
            self.simulation.run(1)
            self._look()
            return
        for group in groups:
            group._begin()
        for i in range(steps):
            self.simulation.run(1)
            for group in groups:
                group._count(engine, last=i == steps - 1)

    def __getstate__(self) -> Any:
        raise TypeError("worlds that are driven cannot be copied or pickled: make a new one from its config")

    def _look(self) -> None:
        for group in self.groups.values():
            group._begin()
            group._look(self.simulation.engine)


def vector_env(
    config: Config,
    seeds: Sequence[int],
    species: str | Sequence[str] | None = None,
    threads: int = 0,
    backend: str = "",
) -> VectorEnv:
    """Makes worlds that a program drives, as arrays.

    Args:
        config: Settings of the worlds.
        seeds: One world per seed, each in [0, 2^64).
        species: Whose agents the caller drives: a name, several, or by default those whose policy is `external`, or
            all where there are none. A config without `[species]` has the species `agent`.
        threads: As in `hedon.Simulation`; changes no result.
        backend: As in `hedon.Simulation`.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        EngineError: As in `hedon.Simulation`.
    """
    return VectorEnv(config, seeds, species, threads, backend)


def driven(config: Config, species: str | Sequence[str] | None) -> tuple[str, ...]:
    """The names of the species that the caller drives.

    Args:
        config: With the species.
        species: A name, several, or None for those whose policy is `external`, or all where there are none.

    Raises:
        ArgumentError: There is no such species.
    """
    if not isinstance(config, Config):
        raise ArgumentError(f"config: must be a Config, as load_config gives it, not {brief(repr(config))}")
    known = list(config.species)
    if species is None:
        external = [name for name, each in config.species.items() if each.learning.policy == "external"]
        return tuple(external or known)
    if not isinstance(species, str | Iterable):
        raise ArgumentError(f"species: must be a name, or a list of them, not {brief(repr(species))}")
    wanted = [species] if isinstance(species, str) else list(species)
    for name in wanted:
        if name not in known:
            near = nearest(name, known) if isinstance(name, str) else None
            hint = f"; did you mean {near}?" if near else ""
            there = ", ".join(known)
            raise ArgumentError(f"species {brief(str(name))!r}: there is no such species (there are {there}){hint}")
    if not wanted:
        raise ArgumentError("species: there must be at least one")
    return tuple(name for name in known if name in wanted)


def _with_callers(config: Config, names: Sequence[str]) -> Config:
    """The config with the policy `external` for these species."""
    for name in names:
        config = config.with_(f"species.{name}.learning.policy", "external")
    return config
