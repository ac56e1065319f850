"""Reads a run's folder, also while the run is still running."""

import difflib
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Literal, overload

import polars as pl

from hedon.record.column import Table
from hedon.record.error import RecordError
from hedon.record.folder import (
    CONFIG,
    LIVING,
    MANIFEST,
    PARTS_BEFORE,
    holds_run,
    part_paths,
    require_plain,
    require_unicode,
)
from hedon.record.manifest import Manifest, load_manifest
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
        dead = _read(part_paths(self.path, "agents")[:parts], self._tables["agents"], skip_damaged)
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
        rows = _read(part_paths(self.path, "population"), self._tables["population"], skip_damaged)
        rows = rows.sort("world", "step", maintain_order=True)
        return to_pandas(rows) if frame == "pandas" else rows

    def frames(self) -> pl.LazyFrame:
        """The frames, as a lazy frame, since they can be larger than memory. Empty if none were recorded."""
        table = self._tables["frames"]
        paths = part_paths(self.path, "frames")
        return pl.scan_parquet(paths, glob=False) if paths else pl.LazyFrame(schema=table.polars_schema)

    def damaged_parts(self) -> list[Path]:
        """The files of the tables agents and population that cannot be read."""
        paths = [*part_paths(self.path, "agents"), *part_paths(self.path, "population")]
        paths += [self.path / LIVING] if (self.path / LIVING).exists() else []
        return [path for path in paths if _fault(path) is not None]

    def _living(self, skip_damaged: bool) -> tuple[pl.DataFrame, int | None]:
        """The living, and how many parts hold the deaths before that moment; None for all existing parts."""
        table, path = self._tables["agents"], self.path / LIVING
        if path.exists():
            try:
                content = BytesIO(path.read_bytes())  # in one read, because the file can be replaced at any time
                rows = pl.read_parquet(content, columns=[column.name for column in table.columns])
                parts = pl.read_parquet_metadata(content).get(PARTS_BEFORE)
                return rows, None if parts is None else int(parts)
            except (pl.exceptions.PolarsError, OSError, ValueError) as error:
                if not skip_damaged:
                    raise _damaged([f"{path} ({error})"]) from error
        return pl.DataFrame(schema=table.polars_schema), None

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


def _read(paths: list[Path], table: Table, skip_damaged: bool) -> pl.DataFrame:
    frames, faults = [pl.DataFrame(schema=table.polars_schema)], []
    for path in paths:
        try:
            frames.append(pl.read_parquet(path, columns=[column.name for column in table.columns], glob=False))
        except (pl.exceptions.PolarsError, OSError) as error:
            faults.append(f"{path} ({error})")
    if faults and not skip_damaged:
        raise _damaged(faults)
    return pl.concat(frames)


def _damaged(faults: list[str]) -> RecordError:
    return RecordError(f"damaged part {'; '.join(faults)}: read the others with skip_damaged=True, or remove the file")


def _fault(path: Path) -> str | None:
    try:
        pl.read_parquet(path, glob=False)
    except (pl.exceptions.PolarsError, OSError) as error:
        return str(error)
    return None


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
