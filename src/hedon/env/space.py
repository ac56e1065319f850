"""Ranges of observations and actions as Gymnasium spaces."""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.expression import expressed, gene_column
from hedon.config.field import value_at
from hedon.config.layout import SpeciesLayout, layouts
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import ENERGY
from hedon.env.group import ACTIONS, Group
from hedon.error import HedonError


def bounds(config: Config, name: str) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Lower and upper bound of each entry of an observation, (entries,) each.

    Limits of channels are divided as in the engine, in 32 bits. A store's level is at most its capacity, or the largest
    capacity that a gene allows.
    """
    species, layout = config.species[name], layouts(config)[name]
    capacities = [_capacity(species, layout, store) for store in species.stores]
    low = [-1.0] * (len(layout.sees) * species.sensor.ray_count)
    low += [0.0] * (len(layout.touches) * species.sensor.touch_sectors)
    high = [1.0] * len(low)
    for channel in layout.observed:
        lowest, highest = channel.limits
        if channel.source == "store":
            highest = capacities[channel.index]
        low.append(float(np.float32(lowest) / np.float32(channel.scale)))
        high.append(float(np.float32(highest) / np.float32(channel.scale)))
    return np.array(low, np.float32), np.array(high, np.float32)


def _capacity(species: SpeciesConfig, layout: SpeciesLayout, store: str) -> float:
    path = f"{store if store == ENERGY else f'store.{store}'}.capacity"
    genes = {gene.name: gene.mutation.limit for gene in layout.genes}
    if path not in species.genome.set:
        return value_at(species, path)
    return expressed(species, path, genes[gene_column(path)])


class Spaces:
    """Spaces of the agents of driven species: a Box for one species, a Dict by name for several.

    Args:
        config: Settings that define the species.
        groups: Agents of each species, by its name.

    Raises:
        HedonError: Gymnasium is not installed.
    """

    def __init__(self, config: Config, groups: Mapping[str, Group]) -> None:
        try:
            from gymnasium import spaces
        except ModuleNotFoundError as error:
            raise HedonError(f'spaces need {error.name}: pip install "hedon[env]"') from error
        self._spaces, self._groups = spaces, groups
        self._observed = {name: bounds(config, name) for name in groups}

    @cached_property
    def observation(self) -> Any:
        """Space of one agent's observation."""
        return self._of({name: self.box_of(name) for name in self._groups})

    @cached_property
    def action(self) -> Any:
        """Space of one agent's action."""
        return self._of({name: self.action_box(name) for name in self._groups})

    @cached_property
    def observations(self) -> Any:
        """Space of all agents' observations, (worlds, slots, entries)."""
        return self._of({name: self.box_of(name, group.ids.shape) for name, group in self._groups.items()})

    @cached_property
    def actions(self) -> Any:
        """Space of all agents' actions, (worlds, slots, 2)."""
        return self._of({name: self.action_box(name, group.ids.shape) for name, group in self._groups.items()})

    def box_of(self, name: str, rows: tuple[int, ...] = ()) -> Any:
        """Box of the observations of a species."""
        low, high = (np.broadcast_to(bound, (*rows, len(bound))) for bound in self._observed[name])
        return self._spaces.Box(low, high, dtype=np.float32)

    def action_box(self, name: str, rows: tuple[int, ...] = (), seed: int | None = None) -> Any:
        """Box of the actions of a species; unbounded if any number is an action."""
        group = self._groups[name]
        low, high = (-np.inf, np.inf) if group.open else (group.low, group.high)
        return self._spaces.Box(low, high, (*rows, len(ACTIONS)), np.float32, seed=seed)

    def _of(self, boxes: dict[str, Any]) -> Any:
        return self._spaces.Dict(boxes) if len(boxes) > 1 else next(iter(boxes.values()))
