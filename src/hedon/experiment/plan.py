"""The plan of a run: what to compute, where its records go, and what callbacks get."""

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hedon.config.config import Config, validated
from hedon.error import ArgumentError
from hedon.experiment.argument import (
    MAX_SECONDS,
    MAX_STEPS,
    MAX_THREADS,
    different,
    folder,
    integer,
    number,
    seed_list,
)
from hedon.experiment.rule import pinned
from hedon.experiment.rule import rules as find_rules
from hedon.experiment.sample import Rows
from hedon.record.folder import CHECKPOINT_SECONDS
from hedon.record.founder import Founders
from hedon.record.manifest import RuleSource
from hedon.record.network import Networks
from hedon.text import brief


@dataclass(frozen=True, slots=True, init=False)
class RunPlan:
    """The plan of a run. Everything is checked when a plan is made.

    Attributes:
        config: Settings of the worlds.
        seeds: One seed per world, given as any sequence of different integers from 0 to 2^63 − 1.
        steps: Total steps of each world.
        out: Folder of the run, given as a path or a string. It must not hold a run already.
        threads: Number of threads; 0 for all processors.
        frames: Steps between two frames; 0 for none.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window. There is always one
            at the start and one at the end.
        founders: Initial genomes of the worlds; None to draw them from the config's laws. The plan's config gets the
            table's digest.
        networks: Initial networks of agents that never learn; None for new networks. The config gets their digest.
        backend: Backend, as in `Simulation`: an instruction set or a device; empty for the best instruction set.
        rules: Texts of all rules in Python. Pass those that the config is pinned to, such as a manifest's; all others
            are read from their files.

    Raises:
        ConfigError: A setting is wrong, or a measure that the config adds.
        FounderError: The founders do not fit the config.
        NetworkError: The networks do not fit the config.
        RuleError: A rule is missing, or is not the one that the config is pinned to.
        ArgumentError: Another value is wrong.
    """

    config: Config
    seeds: tuple[int, ...]
    steps: int
    out: Path
    threads: int
    frames: int
    checkpoint_seconds: float
    founders: Founders | None
    networks: Networks | None
    backend: str
    rules: tuple[RuleSource, ...]

    def __init__(
        self,
        config: Config,
        seeds: Sequence[int],
        steps: int,
        out: Path | str,
        threads: int = 0,
        frames: int = 0,
        checkpoint_seconds: float = CHECKPOINT_SECONDS,
        founders: Founders | None = None,
        networks: Networks | None = None,
        backend: str = "",
        rules: Sequence[RuleSource] = (),
    ) -> None:
        config = _without_caller(validated(config))
        require_measures(config)
        loaded_rules = find_rules(config, rules)
        checked = {
            "config": _with_networks(_with_founders(pinned(config, loaded_rules), founders), networks),
            "seeds": different(seed_list(seeds)),
            "steps": integer("steps", steps, 1, MAX_STEPS),
            "out": folder("out", out),
            "threads": integer("threads", threads, 0, MAX_THREADS),
            "frames": integer("frames", frames, 0, MAX_STEPS),
            "checkpoint_seconds": number("checkpoint_seconds", checkpoint_seconds, 0.0, MAX_SECONDS),
            "founders": founders,
            "networks": networks,
            "backend": backend,
            "rules": tuple(rule.source for rule in loaded_rules),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)


@dataclass(frozen=True, slots=True)
class Moment:
    """The state of a run at one moment, passed to callbacks about five times a second and at the end.

    Attributes:
        first: Step at which the run started or was last continued.
        step: Steps completed.
        steps: Total steps of each world.
        seconds: Time since the first step after `first` [s].
        rows: Last row of the table `population` of each world and species, world by world: numbers by column, for the
            interval that ends at the row's own `step`.
        extinct: For each of these rows, the step at which the species died out there; None while it lives, and if it
            was gone before `first`, as its row shows.
        window: Steps of a window; agents learn at its end.
    """

    first: int
    step: int
    steps: int
    seconds: float
    rows: tuple[Rows, ...]
    extinct: tuple[int | None, ...]
    window: int


Callback = Callable[[Moment], object]
"""A function that gets the progress of a run; an exception that it raises ends the run."""


def together(callbacks: Iterable[Callback]) -> Callback | None:
    """Combines several callbacks, in order; None for none.

    Raises:
        ArgumentError: One is not a function of a moment.
    """
    if not isinstance(callbacks, Iterable):
        raise ArgumentError(f"callbacks: must be a list of functions of a moment, not {brief(repr(callbacks))}")
    callback_list = list(callbacks)
    for callback in callback_list:
        if not callable(callback):
            raise ArgumentError(f"callbacks: must be functions of a moment, not {brief(repr(callback))}")
    if len(callback_list) < 2:
        return callback_list[0] if callback_list else None

    def call(moment: Moment) -> None:
        for callback in callback_list:
            callback(moment)

    return call


def _without_caller(config: Config) -> Config:
    """Returns the config. Raises ArgumentError if a species waits for actions, since no program gives them in a run."""
    for name in config.driven:
        place = f"species.{name}.learning.policy" if len(config.species) > 1 else "learning.policy"
        raise ArgumentError(
            f'{place}: "external" takes actions from a program, so a run cannot have it: drive the worlds with '
            'hedon.make (docs/guide/environment.md), or choose "ppo", "fixed", "random" or "idle"'
        )
    return config


def _with_founders(config: Config, founders: Founders | None) -> Config:
    """The config with the digest of its founders' table."""
    if founders is not None:
        founders.require(config)
        return config.with_("world.founders", founders.digest)
    if config.world.founders:
        raise ArgumentError(
            "founders: the config names a table of founders, so give it, as in --founders RUN/founders.csv, or leave "
            'it out: world.founders=""'
        )
    return config


def _with_networks(config: Config, networks: Networks | None) -> Config:
    """The config with the digest of its agents' initial networks."""
    if networks is not None:
        networks.require(config)
        return config.with_("world.networks", networks.digest)
    if config.world.networks:
        raise ArgumentError(
            "networks: the config names a file of networks, so give it, as in --networks RUN/networks.npz, or leave it "
            'out: world.networks=""'
        )
    return config


def default_folder(config: Config, seeds: Sequence[int]) -> Path:
    """Default folder of a run: runs/NAME-FIDELITY-sSEEDS, with a number if that exists already."""
    return free_folder(Path("runs") / "-".join((config.name, config.fidelity, seed_span(seeds))))


def seed_span(seeds: Sequence[int]) -> str:
    """Seeds as part of a folder's name: "s3", "s1-5", or their number if they are not consecutive."""
    if len(seeds) == 1:
        return f"s{seeds[0]}"
    if tuple(seeds) == tuple(range(seeds[0], seeds[-1] + 1)):
        return f"s{seeds[0]}-{seeds[-1]}"
    return f"{len(seeds)}seeds"


def require_measures(config: Config) -> None:
    """Refuses a config whose own measures cannot be computed, before anything is run.

    Raises:
        ConfigError: An expression is wrong, or a name is taken.
    """
    if config.measure:
        from hedon.measure.world_measure import own_measures  # imported late: it loads the record readers

        own_measures(config)


def free_folder(path: Path, taken: Collection[Path] = ()) -> Path:
    """A path that neither exists nor is in `taken`: this one, or this one with a number after it."""
    folder, number = path, 2
    while folder.exists() or folder in taken:
        folder, number = path.with_name(f"{path.name}-run{number}"), number + 1
    return folder
