"""Reads a run's folder, also while the run is still running."""

import difflib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, overload

import polars as pl

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
from hedon.record.manifest import Manifest, load_manifest
from hedon.record.part import read_living, read_part
from hedon.record.schema import Columns, run_tables
from hedon.record.sketch import run_html, status_line
from hedon.record.tool_frame import FrameName, require_frame, to_pandas

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, repr=False)
class Run:
    """A run on disk. Every call reads the tables again, so that a run that is still running shows its newest rows.

    In a notebook it shows itself: its worlds, and how many lived over time.

    Attributes:
        path: the folder.
        manifest: as it was when the run was opened.
        config_text: the resolved config, as TOML.
    """

    path: Path
    manifest: Manifest
    config_text: str

    @property
    def columns(self) -> Columns:
        """What the columns of the tables follow from."""
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
        """Names of the genome columns that have an effect on the reward."""
        return self.columns.reward_names

    @property
    def neutral_names(self) -> tuple[str, ...]:
        """Names of the neutral markers."""
        return self.columns.neutral_names

    def __repr__(self) -> str:
        return f"<Run {self.path}: {status_line(self.manifest)}>"

    def _repr_html_(self) -> str:
        """What a notebook shows; damaged parts are left out."""
        return run_html(str(self.path), self.manifest, self.population(skip_damaged=True))

    @overload
    def agents(self, *, skip_damaged: bool = False, frame: Literal["polars"] = "polars") -> pl.DataFrame: ...
    @overload
    def agents(self, *, skip_damaged: bool = False, frame: Literal["pandas"]) -> "pd.DataFrame": ...
    def agents(self, *, skip_damaged: bool = False, frame: FrameName = "polars") -> "pl.DataFrame | pd.DataFrame":
        """All agents of one moment: the dead, in the order in which they were written, then the living.

        Before a run has ended, this is the moment when the living were last written; agents that died later count as
        alive.

        Args:
            skip_damaged: leave out parts that cannot be read.
            frame: "polars", or "pandas" for a copy as pandas has it, where integers with missing values are floats.

        Raises:
            RecordError: a part is damaged, and `skip_damaged` is false.
            ArgumentError: `frame` is none of these, or pandas is not installed.
        """
        require_frame(frame)
        living, parts = self._living(skip_damaged)
        dead = self._read("agents", part_paths(self.path, "agents")[:parts], skip_damaged)
        rows = pl.concat([dead, living.join(dead, on=["world", "agent_id"], how="anti")])
        return to_pandas(rows) if frame == "pandas" else rows

    @overload
    def population(self, *, skip_damaged: bool = False, frame: Literal["polars"] = "polars") -> pl.DataFrame: ...
    @overload
    def population(self, *, skip_damaged: bool = False, frame: Literal["pandas"]) -> "pd.DataFrame": ...
    def population(self, *, skip_damaged: bool = False, frame: FrameName = "polars") -> "pl.DataFrame | pd.DataFrame":
        """One row per world and interval, by world and step.

        Args:
            skip_damaged: as for `agents`.
            frame: as for `agents`.

        Raises:
            RecordError: a part is damaged, and `skip_damaged` is false.
            ArgumentError: `frame` is none of these, or pandas is not installed.
        """
        require_frame(frame)
        rows = self._read("population", part_paths(self.path, "population"), skip_damaged)
        rows = rows.sort("world", "step", maintain_order=True)
        return to_pandas(rows) if frame == "pandas" else rows

    def frames(self) -> pl.LazyFrame:
        """The frames, as a lazy frame, since they can be larger than memory. Empty if none were recorded.

        Collecting it raises an error of Polars where a part is damaged; `frame_parts` names the part.
        """
        table = self._tables["frames"]
        paths = part_paths(self.path, "frames")
        return pl.scan_parquet(paths, glob=False) if paths else pl.LazyFrame(schema=table.polars_schema)

    def frame_parts(self, *names: str) -> Iterator[pl.DataFrame]:
        """The frames part by part, in the order in which they were written.

        Args:
            names: only these columns; by default all.

        Raises:
            RecordError: a part is damaged.
        """
        table = self._tables["frames"]
        if names:
            table = replace(table, columns=tuple(column for column in table.columns if column.name in names))
        for path in part_paths(self.path, "frames"):
            yield read_part(path, table, self.manifest)

    def damaged_parts(self) -> list[Path]:
        """The files of the tables agents and population that cannot be used."""
        living = [self.path / LIVING] if (self.path / LIVING).exists() else []
        paths = {"agents": [*part_paths(self.path, "agents"), *living]}
        paths["population"] = part_paths(self.path, "population")
        return [path for name, each in paths.items() for path in each if self._fault(name, path) is not None]

    def _living(self, skip_damaged: bool) -> tuple[pl.DataFrame, int | None]:
        """The living, and how many parts hold the deaths before that moment; None for all existing parts."""
        table, path = self._tables["agents"], self.path / LIVING
        if path.exists():
            try:
                return read_living(path, table, self.manifest)
            except RecordError as error:
                if not skip_damaged:
                    raise _remedied([error]) from error
        return pl.DataFrame(schema=table.polars_schema), None

    def _read(self, name: str, paths: list[Path], skip_damaged: bool) -> pl.DataFrame:
        table = self._tables[name]
        frames, faults = [pl.DataFrame(schema=table.polars_schema)], []
        for path in paths:
            try:
                frames.append(read_part(path, table, self.manifest))
            except RecordError as error:
                faults.append(error)
        if faults and not skip_damaged:
            raise _remedied(faults) from faults[0]
        return pl.concat(frames)

    def _fault(self, name: str, path: Path) -> RecordError | None:
        try:
            read_part(path, self._tables[name], self.manifest)
        except RecordError as error:
            return error
        return None

    @property
    def _tables(self) -> dict[str, Table]:
        return run_tables(self.columns)


def open_run(path: Path | str) -> Run:
    """Opens a run's folder.

    Raises:
        RecordError: it is not a run folder, its manifest or config cannot be read, or it holds a symbolic link.
    """
    folder = Path(path)
    require_unicode(folder)
    require_plain(folder)
    if not (folder / MANIFEST).is_file():
        raise RecordError(f"{folder} is not a run folder: it has no {MANIFEST}{_nearest(folder)}")
    try:
        config_text = (folder / CONFIG).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"cannot read {folder / CONFIG}: {error}") from error
    return Run(folder, load_manifest(folder), config_text)


def _remedied(faults: Sequence[RecordError]) -> RecordError:
    listed = "; ".join(map(str, faults))
    return RecordError(f"{listed}: read the others with skip_damaged=True, or remove the file")


def _nearest(folder: Path) -> str:
    """A hint at runs that the user may mean: above the folder, inside it, or with a similar name."""
    if folder.is_dir():
        around = [parent for parent in folder.resolve().parents[:2] if holds_run(parent)]
        inside = sorted(child for child in folder.iterdir() if child.is_dir() and holds_run(child))
        found = around or inside[-1:]
    else:
        siblings = [c for c in folder.parent.iterdir() if holds_run(c)] if folder.parent.is_dir() else []
        close = difflib.get_close_matches(folder.name, [child.name for child in siblings], n=1)
        found = [folder.parent / name for name in close]
    return f"; did you mean {found[0]}?" if found else ""
