"""Checks what environments are made with."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.load import load_config, override_texts
from hedon.config.problem import nearest
from hedon.error import ArgumentError
from hedon.experiment.argument import integer, seed_list
from hedon.experiment.rule import pinned, rules
from hedon.experiment.simulation import MAX_WORLD_SEED, Simulation
from hedon.text import brief

_DRAWN = 2**32
"""Seeds that are drawn by chance are below."""
RESET_MASK = "reset_mask"
"""The option of `reset` that Gymnasium's vector environments have too."""


def loaded(config: Config | str | Path, overrides: Iterable[str]) -> Config:
    """The config itself, or that of a preset or a file with other settings.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: There are overrides of a config that is loaded already.
    """
    if isinstance(config, str | Path):
        return load_config(config, overrides=overrides)
    if override_texts(overrides):
        raise ArgumentError("overrides: go with the name of a preset or a file; change a Config by config.with_(…)")
    return config


def driven(config: Config, species: str | Sequence[str] | None) -> tuple[str, ...]:
    """The names of the species that the caller drives.

    Raises:
        ArgumentError: There is no such species.
    """
    if not isinstance(config, Config):
        raise ArgumentError(
            f"config: must be a Config, as load_config gives it, a preset or a file, not {brief(repr(config))}"
        )
    known = list(config.species)
    if species is None:
        return config.driven or tuple(known)
    if not isinstance(species, str | Iterable):
        raise ArgumentError(f"species: must be a name, or a list of them, not {brief(repr(species))}")
    wanted = [species] if isinstance(species, str) else list(species)
    for name in wanted:
        if name not in known:
            near = nearest(name, known) if isinstance(name, str) else None
            hint = f"; did you mean {near}?" if near else ""
            there = ", ".join(known)
            raise ArgumentError(f"species {brief(str(name))!r}: there is no such species (there are {there}){hint}")
    if not wanted or len(set(wanted)) < len(wanted):
        raise ArgumentError(f"species = {brief(repr(wanted))}: must be at least one name, and each of them once")
    return tuple(name for name in known if name in wanted)


def with_callers(config: Config, names: Sequence[str]) -> Config:
    """The config with the policy `external` for some species."""
    for name in names:
        config = config.with_(f"species.{name}.learning.policy", "external")
    return config


def options_of(options: Any) -> dict[str, Any]:
    """What a caller gave to `reset` besides the seed.

    Raises:
        ArgumentError: It is something else.
    """
    if not isinstance(options, Mapping | None):
        raise ArgumentError(f"options = {brief(repr(options))}: must be a dict, or None")
    return dict(options or {})


def world_seeds(seed: Any, worlds: int) -> tuple[int, ...]:
    """The seed of each world.

    Raises:
        ArgumentError: It is neither.
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
    """A value that is one of a few.

    Raises:
        ArgumentError: It is none of them.
    """
    if (empty and value is None) or (isinstance(value, str) and value in known):
        return value
    near = nearest(value, known) if isinstance(value, str) else None
    hint = f"; did you mean {near}?" if near else ""
    raise ArgumentError(f"{name} = {brief(repr(value))}: must be {' or '.join(known)}{hint}")


def reset_mask(options: Any, worlds: int) -> NDArray[np.bool_]:
    """The worlds that begin again, (worlds,).

    Raises:
        ArgumentError: There is no such option, or it is no such mask.
    """
    given = options_of(options)
    mask = np.asarray(given.pop(RESET_MASK, np.ones(worlds, np.bool_)))
    if given:
        unknown = next(iter(given))
        raise ArgumentError(f"options: there is no {brief(str(unknown))!r}; there is {RESET_MASK!r}")
    if mask.shape != (worlds,) or mask.dtype != np.bool_ or not mask.any():
        raise ArgumentError(f"options[{RESET_MASK!r}]: must be ({worlds},) bool, true for at least one world")
    return mask


def recordable(
    config: Config, seeds: Sequence[int], threads: int, backend: str, record: Path | str | None, frames: int
) -> Simulation:
    """The worlds of an environment; if they are recorded, their config is pinned to its rules.

    Raises:
        ArgumentError: `frames` is given without `record`.
        RuleError: A rule cannot be used.
    """
    found = rules(config) if record is not None else ()
    if record is None and frames:
        raise ArgumentError(f"frames = {brief(repr(frames))}: give record, the folder for them, too")
    texts = tuple(rule.source for rule in found)
    return Simulation(pinned(config, found) if found else config, seeds, threads, backend, texts)
