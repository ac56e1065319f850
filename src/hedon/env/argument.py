"""Checks the arguments of environments."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.load import load_config, override_texts
from hedon.config.problem import did_you_mean
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_THREADS, integer, seed_list
from hedon.experiment.rule import pinned, rules
from hedon.experiment.simulation import MAX_WORLD_SEED, Simulation
from hedon.record.provenance import usable_cpus
from hedon.text import brief

NETWORKS = ("ppo", "fixed")
"""Policies for which the engine computes networks."""
_DRAWN = 2**32
"""Random seeds are below this number."""
SLOTS_PER_THREAD = 150
"""Slots for which a thread saves more time than threads wait for one another, if the engine computes no networks.

Measured with one world of the baseline's density on two AVX-512 cores: with 100 founders in 150 slots, a step takes
86 µs on one thread and 95 µs on two; with 200 founders in 300 slots, 159 and 145 µs.
"""
RESET_MASK = "reset_mask"
"""Option of `reset` that Gymnasium's vector environments share."""


def loaded(config: Config | str | Path, overrides: Iterable[str]) -> Config:
    """Returns a config as it is, or loads a preset or file with overrides.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Overrides were given for a loaded config.
    """
    if isinstance(config, str | Path):
        return load_config(config, overrides=overrides)
    if override_texts(overrides):
        raise ArgumentError("overrides: go with the name of a preset or a file; change a Config by config.with_(…)")
    return config


def driven(config: Config, species: str | Sequence[str] | None) -> tuple[str, ...]:
    """Names of the species that the caller drives.

    Raises:
        ArgumentError: There is no such species.
    """
    if not isinstance(config, Config):
        raise ArgumentError(
            f"config: must be a Config, as load_config gives it, a preset or a file, not {brief(repr(config))}"
        )
    names = list(config.species)
    if species is None:
        return config.driven or tuple(names)
    if not isinstance(species, str | Iterable):
        raise ArgumentError(f"species: must be a name, or a list of them, not {brief(repr(species))}")
    requested = [species] if isinstance(species, str) else list(species)
    for name in requested:
        if name not in names:
            hint = did_you_mean(name, names) if isinstance(name, str) else ""
            listing = ", ".join(names)
            raise ArgumentError(f"species {brief(str(name))!r}: there is no such species (there are {listing}){hint}")
    if not requested or len(set(requested)) < len(requested):
        raise ArgumentError(f"species = {brief(repr(requested))}: must be at least one name, and each of them once")
    return tuple(name for name in names if name in requested)


def with_callers(config: Config, names: Sequence[str]) -> Config:
    """The config with the policy `external` for some species."""
    for name in names:
        config = config.with_(f"species.{name}.learning.policy", "external")
    return config


def options_of(options: Any) -> dict[str, Any]:
    """Options given to `reset`, as a dictionary.

    Raises:
        ArgumentError: They are neither a dictionary nor None.
    """
    if not isinstance(options, Mapping | None):
        raise ArgumentError(f"options = {brief(repr(options))}: must be a dict, or None")
    return dict(options or {})


def world_seeds(seed: Any, worlds: int) -> tuple[int, ...]:
    """Seed of each world.

    Raises:
        ArgumentError: It is neither a seed nor one valid seed per world.
    """
    if isinstance(seed, Iterable) and not isinstance(seed, str | bytes):
        seeds = seed_list(seed, MAX_WORLD_SEED)
        if len(seeds) != worlds:
            raise ArgumentError(f"seed: there must be {worlds}, one per world, not {len(seeds)}")
        return seeds
    if seed is None:
        seed = int(np.random.default_rng().integers(_DRAWN))
    first = integer("seed", seed, 0, MAX_WORLD_SEED - worlds + 1)
    return tuple(range(first, first + worlds))


def chosen(name: str, value: Any, known: Sequence[Any], *, empty: bool = False) -> Any:
    """Returns a value if it is one of the known ones.

    Raises:
        ArgumentError: The value is not known.
    """
    if (empty and value is None) or (isinstance(value, str) and value in known):
        return value
    hint = did_you_mean(value, known) if isinstance(value, str) else ""
    raise ArgumentError(f"{name} = {brief(repr(value))}: must be {' or '.join(known)}{hint}")


def reset_mask(options: Any, worlds: int) -> NDArray[np.bool_]:
    """Mask of the worlds to restart, (worlds,).

    Raises:
        ArgumentError: An option is unknown, or the mask is invalid.
    """
    remaining = options_of(options)
    mask = np.asarray(remaining.pop(RESET_MASK, np.ones(worlds, np.bool_)))
    if remaining:
        unknown = next(iter(remaining))
        raise ArgumentError(f"options: there is no {brief(str(unknown))!r}; there is {RESET_MASK!r}")
    if mask.shape != (worlds,) or mask.dtype != np.bool_ or not mask.any():
        raise ArgumentError(f"options[{RESET_MASK!r}]: must be ({worlds},) bool, true for at least one world")
    return mask


def recordable(
    config: Config, seeds: Sequence[int], threads: int, backend: str, record: Path | str | None, frames: int
) -> Simulation:
    """Creates an environment's worlds; if they are recorded, their config is pinned to its rules.

    Args:
        config: Settings of the worlds, in which the species that the caller drives have the policy `external`.
        seeds: Seeds of the worlds.
        threads: Number of threads; 0 to choose it by `thread_count`.
        backend: Instruction set or device, as in `Simulation`.
        record: Folder of the records; None for none.
        frames: World steps between two frames; 0 for none.

    Raises:
        ArgumentError: `frames` is given without `record`.
        RuleError: A rule cannot be used.
    """
    config_rules = rules(config) if record is not None else ()
    if record is None and frames:
        raise ArgumentError(f"frames = {brief(repr(frames))}: give record, the folder for them, too")
    texts = tuple(rule.source for rule in config_rules)
    pinned_config = pinned(config, config_rules) if config_rules else config
    count = integer("threads", threads, 0, MAX_THREADS) or thread_count(config, len(seeds))
    return Simulation(pinned_config, seeds, count, backend, texts)


def thread_count(config: Config, worlds: int) -> int:
    """The number of threads that is fastest for worlds driven by a program; 0 for all processors.

    Args:
        config: Settings of the worlds.
        worlds: Number of worlds.
    """
    if any(species.learning.policy in NETWORKS for species in config.species.values()):
        return 0
    slots = worlds * sum(species.population.capacity for species in config.species.values())
    return max(1, min(usable_cpus(), slots // SLOTS_PER_THREAD))
