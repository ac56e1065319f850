"""What an item of a study is: figures and tables for one question, the worlds that they need, how they are made."""

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
    """A setting that an item shows or compares.

    Attributes:
        label: what the item calls it; no other condition of the item has it.
        preset: that it starts from, or the path of a config's file.
        overrides: what it changes, as for `--set`.
        fidelity: its own; None for the one that is asked for.
        species: whose records are meant, where the setting has several; by default the first.
        founders: genomes to begin with, as for `hedon run --founders`: "food=5:0.1,food=0:0.9"; by default those of the
            setting's laws.
    """

    label: str
    preset: str = "baseline"
    overrides: tuple[str, ...] = ()
    fidelity: str | None = None
    species: str = ""
    founders: str = ""

    def config(self, fidelity: str) -> Config:
        """The settings, where some fidelity is asked for."""
        config, table = _begin(self, self.fidelity or fidelity)
        return config if table is None else config.with_("world.founders", table.digest)

    def table(self, fidelity: str) -> Founders | None:
        """The genomes to begin with, where some fidelity is asked for; None where they are drawn from the laws."""
        return _begin(self, self.fidelity or fidelity)[1]

    def is_of(self, world: WorldRecord) -> bool:
        """Whether a world has these settings and nothing else is changed, and is of the species that is meant."""
        own = choose_species(self.species or None, self.config(world.config.fidelity))
        return world.species == own and world.settings == _digest(self, world.config.fidelity)


@cache
def _begin(condition: Condition, fidelity: str) -> tuple[Config, Founders | None]:
    config = load_config(condition.preset, fidelity, condition.overrides)
    return config, read_founders(condition.founders, config) if condition.founders else None


@cache
def _digest(condition: Condition, fidelity: str) -> str:
    return digest(condition.config(fidelity))


@dataclass(frozen=True)
class Scale:
    """How much is run of each condition.

    Attributes:
        seeds: one world each.
        steps: of each world [step].
    """

    seeds: tuple[int, ...]
    steps: int


@dataclass(frozen=True)
class ItemInputs:
    """What an item is made from.

    Attributes:
        fidelity: that the request has.
        worlds: per label of a condition the worlds that there are, up to the steps asked for; none where
            there are none.
        snapshots: per label the last state of a world of that condition, where there is one.
        frames: per label the positions of all species in each world, a table `frames` of one world each, as far as they
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
        name: what the command line calls it.
        title: its heading.
        says: what the study's source shows or says there, or what is asked.
        make: makes its figures and tables, in the order in which they are shown.
        conditions: the settings that it needs worlds of; none where settings alone are enough.
        scale: how much is run of each condition unless the request has another scale.
        pictures: whether it only shows the last state of a world of each condition, for which any run is long enough.
        frames: steps between two records of all positions that it needs; 0 if it needs none.
    """

    name: str
    title: str
    says: str
    make: Callable[[ItemInputs], Iterable[NamedFigure | ResultTable]]
    conditions: tuple[Condition, ...] = ()
    scale: Scale = Scale((), 0)
    pictures: bool = False
    frames: int = 0
