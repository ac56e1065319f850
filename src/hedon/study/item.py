"""What an item of the reproduction is: a figure, a table or a study, the worlds that it needs, and how it is made."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Literal

import polars as pl

from hedon.analysis.table import ResultTable
from hedon.analysis.world.record import WorldRecord
from hedon.config import Config, load_config
from hedon.figure.named import NamedFigure
from hedon.record.snapshot import Snapshot


@dataclass(frozen=True)
class Arm:
    """A setting that an item shows or compares.

    Attributes:
        label: what the item calls it; no other arm of the item has it.
        preset: that it starts from.
        overrides: what it changes, as for `--set`.
        fidelity: its own; None for that of the reproduction.
        species: whose records are shown, where the setting has several; by default the first.
    """

    label: str
    preset: str = "baseline"
    overrides: tuple[str, ...] = ()
    fidelity: str | None = None
    species: str = ""

    def config(self, fidelity: str) -> Config:
        """The settings, in a reproduction of some fidelity."""
        return _config(self.preset, self.fidelity or fidelity, self.overrides)


@cache
def _config(preset: str, fidelity: str, overrides: tuple[str, ...]) -> Config:
    return load_config(preset, fidelity, overrides)


@dataclass(frozen=True)
class Scale:
    """How much is run of each arm.

    Attributes:
        seeds: one world each.
        steps: of each world [step].
    """

    seeds: tuple[int, ...]
    steps: int


@dataclass(frozen=True)
class Material:
    """What an item is made from.

    Attributes:
        fidelity: of the reproduction.
        worlds: per label of an arm the worlds that there are, up to the steps asked for; none for an arm without.
        snapshots: per label the last state of a world of that arm, where there is one.
        frames: per label the positions of all species in each world, a table `frames` of one world each, as far as they
            were recorded.
    """

    fidelity: str
    worlds: Mapping[str, Sequence[WorldRecord]] = field(default_factory=dict)
    snapshots: Mapping[str, Snapshot] = field(default_factory=dict)
    frames: Mapping[str, Sequence[pl.LazyFrame]] = field(default_factory=dict)


@dataclass(frozen=True)
class Item:
    """One item of the reproduction.

    Attributes:
        name: what the command line calls it.
        title: its heading.
        kind: "figure" or "table" of the paper; "study", of a question that the paper leaves open; or "sequel", of the
            paper's sequel on predators and prey.
        paper: what the paper, or its sequel, shows or says there; for a study, what it asks.
        make: makes its figures and tables, in the order in which they are shown.
        arms: the settings that it needs worlds of; none where settings alone are enough.
        scale: how much is run of each arm unless asked otherwise; for an item of the paper, the paper's.
        pictures: whether it only shows the last state of a world of each arm, for which any run is long enough.
        frames: steps between two records of all positions that it needs; 0 if it needs none.
    """

    name: str
    title: str
    kind: Literal["figure", "table", "study", "sequel"]
    paper: str
    make: Callable[[Material], Iterable[NamedFigure | ResultTable]]
    arms: tuple[Arm, ...] = ()
    scale: Scale = Scale((), 0)
    pictures: bool = False
    frames: int = 0
