"""Defines an item of a study: figures and tables for one question, the worlds that they need, and how to make them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache

import polars as pl

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord
from hedon.config import Config, digest, load_config
from hedon.config.layout import choose_species
from hedon.figure.named import NamedFigure
from hedon.record.founder import Founders
from hedon.record.founder_source import read_founders
from hedon.record.snapshot import Snapshot


@dataclass(frozen=True)
class Condition:
    """A condition that an item shows or compares.

    Attributes:
        label: Its name in the item, unique among the item's conditions.
        preset: Preset on which it is based, or the path of a config file.
        overrides: Settings that it changes, as for `--set`.
        fidelity: Its own fidelity; None for the requested one.
        species: Species whose records are used, if there are several; the first by default.
        founders: Genomes of founders, as for `hedon run --founders`: "food=5:0.1,food=0:0.9"; or a function that makes
            their table for the settings. By default they are drawn from the config's distributions.
    """

    label: str
    preset: str = "baseline"
    overrides: tuple[str, ...] = ()
    fidelity: str | None = None
    species: str = ""
    founders: str | Callable[[Config], Founders] = ""

    def config(self, fidelity: str) -> Config:
        """The settings, given the requested fidelity."""
        config, table = _begin(self, self.fidelity or fidelity)
        return config if table is None else config.with_("world.founders", table.digest)

    def table(self, fidelity: str) -> Founders | None:
        """The table of founders, given the requested fidelity; None if they are drawn from distributions."""
        return _begin(self, self.fidelity or fidelity)[1]

    def is_of(self, world: WorldRecord) -> bool:
        """Whether a world has exactly these settings, and its records are of this species."""
        species = choose_species(self.species or None, self.config(world.config.fidelity))
        return world.species == species and world.settings == _digest(self, world.config.fidelity)


@cache
def _begin(condition: Condition, fidelity: str) -> tuple[Config, Founders | None]:
    config = load_config(condition.preset, fidelity, condition.overrides)
    if callable(condition.founders):
        return config, condition.founders(config)
    return config, read_founders(condition.founders, config) if condition.founders else None


@cache
def _digest(condition: Condition, fidelity: str) -> str:
    return digest(condition.config(fidelity))


@dataclass(frozen=True)
class Scale:
    """The number and length of the worlds of each condition.

    Attributes:
        seeds: Seeds of the worlds.
        steps: Length of each world [step].
    """

    seeds: tuple[int, ...]
    steps: int


@dataclass(frozen=True)
class ItemInputs:
    """The data from which an item is made.

    Attributes:
        fidelity: The requested fidelity.
        worlds: Available worlds by label of their condition, cut at the requested steps; conditions without
            worlds are missing.
        snapshots: The last state of a world of each condition, by label, if available.
        frames: Positions of all species by label of the condition, one table `frames` per world, as far as they
            were recorded.
    """

    fidelity: str
    worlds: Mapping[str, Sequence[WorldRecord]] = field(default_factory=dict)
    snapshots: Mapping[str, Snapshot] = field(default_factory=dict)
    frames: Mapping[str, Sequence[pl.LazyFrame]] = field(default_factory=dict)


@dataclass(frozen=True)
class Item:
    """Figures and tables that answer one question of a study.

    Attributes:
        name: Its name on the command line.
        title: Its heading.
        says: What the study's source shows or states at this point, or the question.
        make: Makes its figures and tables, in the order in which they are shown.
        conditions: Conditions of the worlds that it needs; none if it needs only settings.
        scale: Number and length of worlds per condition, unless the request sets another scale.
        pictures: Whether it only shows the last state of a world of each condition, for which any run is long enough.
        frames: Steps between two records of all positions; 0 if it needs no positions.
    """

    name: str
    title: str
    says: str
    make: Callable[[ItemInputs], Iterable[NamedFigure | ResultTable]]
    conditions: tuple[Condition, ...] = ()
    scale: Scale = Scale((), 0)
    pictures: bool = False
    frames: int = 0
