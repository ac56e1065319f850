"""Reads a run's folder, even while the run is in progress."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal, overload

import polars as pl

from hedon.config import Config
from hedon.config.load import load_config_text
from hedon.record.column import Table
from hedon.record.error import RecordError
from hedon.record.folder import (
    CONFIG,
    LIVING,
    MANIFEST,
    holds_run,
    part_paths,
    require_plain,
    require_unicode,
)
from hedon.record.labelled import to_xarray
from hedon.record.manifest import Manifest, load_manifest
from hedon.record.part import read_living, read_part
from hedon.record.schema import Columns, run_tables
from hedon.record.sketch import run_html, status_line
from hedon.record.tool_frame import FrameName, require_frame, to_pandas

if TYPE_CHECKING:
    import pandas as pd
    import xarray


@dataclass(frozen=True, repr=False)
class Run:
    """A run on disk. Every call reads the tables again, so a run in progress shows its newest rows.

    In a notebook it is displayed as a table of its worlds, with a plot of the number of agents alive.

    Attributes:
        path: Folder of the run.
        manifest: The manifest, as it was when the run was opened.
        config_text: The resolved config, as TOML.
    """

    path: Path
    manifest: Manifest
    config_text: str

    def load(self) -> "LoadedRun":
        """The run with its files as they are now, each read only once.

        Raises:
            RecordError: The folder's files cannot be listed.
        """
        return LoadedRun(self.path, self.manifest, self.config_text)

    @property
    def config(self) -> Config:
        """The resolved settings.

        Raises:
            ConfigError: The config does not fit this version of hedon.
        """
        return load_config_text(self.config_text, self.path / CONFIG)

    @property
    def columns(self) -> Columns:
        """The properties that determine the columns of the tables."""
        return self.manifest.columns

    @property
    def food_kinds(self) -> tuple[str, ...]:
        """Names of the food kinds, in the order of the config."""
        return self.manifest.food_kinds

    @property
    def weight_names(self) -> tuple[str, ...]:
        """Names of all genome columns, in order."""
        return self.columns.gene_names

    @property
    def reward_names(self) -> tuple[str, ...]:
        """Names of the genome columns that affect the reward."""
        return self.columns.reward_names

    @property
    def neutral_names(self) -> tuple[str, ...]:
        """Names of the neutral genes."""
        return self.columns.neutral_names

    def __repr__(self) -> str:
        return f"<Run {self.path}: {status_line(self.manifest)}>"

    def _repr_html_(self) -> str:
        """The display in a notebook, without damaged parts."""
        return run_html(str(self.path), self.manifest, self.population(skip_damaged=True))

    @overload
    def agents(self, *, skip_damaged: bool = False, frame: Literal["polars"] = "polars") -> pl.DataFrame: ...
    @overload
    def agents(self, *, skip_damaged: bool = False, frame: Literal["pandas"]) -> "pd.DataFrame": ...
    def agents(self, *, skip_damaged: bool = False, frame: FrameName = "polars") -> "pl.DataFrame | pd.DataFrame":
        """All agents of one moment: the dead, in the order in which they were written, then the living.

        While a run is in progress, this is the moment when the living were last written; agents that died later count
        as alive.

        Args:
            skip_damaged: Whether to leave out parts that cannot be read, instead of raising an error.
            frame: "polars", or "pandas" for a copy in which integers with missing values are floats.

        Raises:
            RecordError: A part is damaged, and `skip_damaged` is false.
            ArgumentError: `frame` is not one of these, or pandas is not installed.
        """
        require_frame(frame)
        rows = self._agents().sound(skip_damaged)
        return to_pandas(rows) if frame == "pandas" else rows

    @overload
    def population(self, *, skip_damaged: bool = False, frame: Literal["polars"] = "polars") -> pl.DataFrame: ...
    @overload
    def population(self, *, skip_damaged: bool = False, frame: Literal["pandas"]) -> "pd.DataFrame": ...
    def population(self, *, skip_damaged: bool = False, frame: FrameName = "polars") -> "pl.DataFrame | pd.DataFrame":
        """One row per world and interval, sorted by world and step.

        Args:
            skip_damaged: As for `agents`.
            frame: As for `agents`.

        Raises:
            RecordError: A part is damaged, and `skip_damaged` is false.
            ArgumentError: `frame` is neither "polars" nor "pandas", or pandas is not installed.
        """
        require_frame(frame)
        rows = self._population().sound(skip_damaged)
        return to_pandas(rows) if frame == "pandas" else rows

    def to_xarray(self) -> "xarray.Dataset":
        """The table `population` as labelled arrays over seed, species (if there are several) and step.

        Each variable has its unit and its meaning as attributes.

        Raises:
            RecordError: A part is damaged.
            ArgumentError: xarray is not installed.
        """
        species_dims = ["species"] if self.columns.several else []
        attributes = {
            column.name: {"units": column.unit, "long_name": column.meaning}
            for column in self._tables["population"].columns
        }
        return to_xarray(self.population().drop("world"), ["seed", *species_dims, "step"], attributes)

    def frames(self) -> pl.LazyFrame:
        """The frames, as a lazy frame, since they can be larger than memory. Empty if none were recorded.

        If a part is damaged, collecting it raises a Polars error; `frame_parts` names the part.
        """
        table = self._tables["frames"]
        paths = part_paths(self.path, "frames")
        return pl.scan_parquet(paths, glob=False) if paths else pl.LazyFrame(schema=table.polars_schema)

    def frame_parts(self, *names: str) -> Iterator[pl.DataFrame]:
        """The frames part by part, in the order in which they were written.

        Args:
            names: Columns to read; all by default.

        Raises:
            RecordError: A part is damaged.
        """
        table = self._tables["frames"]
        if names:
            table = replace(table, columns=tuple(column for column in table.columns if column.name in names))
        for path in part_paths(self.path, "frames"):
            yield read_part(path, table, self.manifest)

    def damaged_parts(self) -> list[Path]:
        """The files of the tables agents and population that cannot be used."""
        return [*self._agents().faults, *self._population().faults]

    def _agents(self) -> "_Rows":
        table, path = self._tables["agents"], self.path / LIVING
        living, parts = pl.DataFrame(schema=table.polars_schema), None
        faults: dict[Path, RecordError] = {}
        if path.exists():
            try:
                living, parts = read_living(path, table, self.manifest)
            except RecordError as error:
                faults[path] = error
        dead = self._read("agents", part_paths(self.path, "agents"), parts)
        rows = pl.concat([dead.rows, living.join(dead.rows, on=["world", "agent_id"], how="anti")])
        return _Rows(rows, {**dead.faults, **faults})

    def _population(self) -> "_Rows":
        read = self._read("population", part_paths(self.path, "population"))
        return replace(read, rows=read.rows.sort("world", "step", maintain_order=True))

    def _read(self, name: str, paths: Sequence[Path], part_count: int | None = None) -> "_Rows":
        """All valid rows of the first parts of a table, and the faults of damaged files.

        Args:
            name: Name of the table.
            paths: Paths of all its parts.
            part_count: Number of parts to use; later ones have deaths after the living were written; None for all.
        """
        table = self._tables[name]
        frames, faults = [pl.DataFrame(schema=table.polars_schema)], dict[Path, RecordError]()
        for i, path in enumerate(paths):
            try:
                rows = read_part(path, table, self.manifest)
            except RecordError as error:
                faults[path] = error
            else:
                frames += [rows] if part_count is None or i < part_count else []
        return _Rows(pl.concat(frames), faults)

    @property
    def _tables(self) -> dict[str, Table]:
        return run_tables(self.columns)


@dataclass(frozen=True)
class _Rows:
    """The rows of a table's files, and the faults of files that cannot be used."""

    rows: pl.DataFrame
    faults: Mapping[Path, RecordError]

    def sound(self, skip_damaged: bool) -> pl.DataFrame:
        """The rows; raises an error that lists all faults unless they are skipped."""
        if self.faults and not skip_damaged:
            fault_list = "; ".join(map(str, self.faults.values()))
            raise RecordError(f"{fault_list}: read the others with skip_damaged=True, or remove the file")
        return self.rows


class LoadedRun(Run):
    """A run whose files are read once, on first use, so that all numbers come from the same rows."""

    def load(self) -> "LoadedRun":
        """Itself."""
        return self

    @property
    def config(self) -> Config:
        """See `Run.config`."""
        return self._loaded_config

    def _agents(self) -> _Rows:
        return self._loaded_agents

    def _population(self) -> _Rows:
        return self._loaded_population

    @cached_property
    def _loaded_config(self) -> Config:
        return super().config

    @cached_property
    def _loaded_agents(self) -> _Rows:
        return super()._agents()

    @cached_property
    def _loaded_population(self) -> _Rows:
        return super()._population()


def open_run(path: Path | str) -> Run:
    """Opens a run's folder.

    Raises:
        RecordError: It does not exist or is not a run folder, its manifest or config cannot be read, or it contains a
            symbolic link.
    """
    folder = Path(path)
    require_unicode(folder)
    if not (folder / MANIFEST).is_file():
        problem = f"is not a run folder: it has no {MANIFEST}" if folder.exists() else "does not exist"
        raise RecordError(f"{folder} {problem}{_nearest(folder)}")
    require_plain(folder)
    try:
        config_text = (folder / CONFIG).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"cannot read {folder / CONFIG}: {error}") from error
    return Run(folder, load_manifest(folder), config_text)


def _nearest(folder: Path) -> str:
    """A hint to runs that the user may have meant: above the folder, inside it, or with a similar name."""
    if folder.is_dir():
        parents = [parent for parent in folder.resolve().parents[:2] if holds_run(parent)]
        children = sorted(child for child in folder.iterdir() if child.is_dir() and holds_run(child))
        candidates = parents or children[-1:]
    else:
        siblings = [c for c in folder.parent.iterdir() if holds_run(c)] if folder.parent.is_dir() else []
        matches = difflib.get_close_matches(folder.name, [child.name for child in siblings], n=1)
        candidates = [folder.parent / name for name in matches]
    return f"; did you mean {candidates[0]}?" if candidates else ""
