"""The page's description of a run: its layout, and the files that contain its rows."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import polars as pl

from hedon.config import Config
from hedon.config.dump import file_leaves
from hedon.config.load import changed_settings
from hedon.config.problem import format_value
from hedon.record.error import RecordError
from hedon.record.folder import LIVING, TABLE_FOLDERS, part_paths
from hedon.record.part import read_part
from hedon.record.reader import Run, open_run
from hedon.record.schema import run_tables
from hedon.view.layout import describe
from hedon.view.overlay import Overlay

Span = tuple[int, int] | None
"""First and last step of a world in a part of the frames; None if the part has no frame of it."""


class RunIndex:
    """Describes one run, repeatedly while it is in progress. Parts that were read before are not read again.

    Args:
        folder: Folder of the run.
        others: Folders of further runs, whose curves the page adds to its plots.

    Raises:
        RecordError: A folder is not a run, or contains a symbolic link.
        ViewError: There are too many further runs, or a run is given twice.
    """

    def __init__(self, folder: Path, others: Sequence[Path] = ()) -> None:
        self.folder = folder
        self.overlay = Overlay(folder, others)
        self._spans: dict[tuple[str, int], list[Span] | None] = {}  # by name and size of a part
        open_run(folder)

    def describe(self) -> dict[str, Any]:
        """Describes the current state of the run.

        Returns:
            `name`, `status`, `seeds`, `steps` (completed, per world), `extinct` (step or None, per world), `frames`
            (steps between two), `digests`, `obstacles` (corners of each, per world), `layout`, `settings` (`base`,
            `changed` and `all`, as texts), and `files`: for each table its parts, each with `file` (relative to the
            run), `bytes` and, for frames, `worlds` (first and last step of each world in the part, or None); or
            `damaged` if the part cannot be read. Also `others`, the further runs, as in `Overlay.describe`.

        Raises:
            RecordError: The folder is not a run, or contains a symbolic link.
        """
        run = open_run(self.folder)
        manifest = run.manifest
        config = run.config
        return {
            "name": manifest.name or self.folder.name,
            "folder": self.folder.resolve().name,
            "status": manifest.status,
            "seeds": list(manifest.seeds),
            "steps": list(manifest.steps_done),
            "asked": manifest.steps_asked,
            "extinct": list(manifest.extinct_steps),
            "frames": manifest.frames,
            "digests": list(manifest.world_digests),
            "obstacles": list(manifest.obstacle_places),
            "layout": describe(config),
            "settings": _settings(config),
            "files": {table: list(self._parts(run, table)) for table in TABLE_FOLDERS},
            "others": self.overlay.describe(),
        }

    def damaged(self) -> list[str]:
        """The files of tables that cannot be used, by the names that the page requests."""
        run = open_run(self.folder)
        frames = [part["file"] for part in self._parts(run, "frames") if part.get("damaged")]
        return [*(path.relative_to(run.path).as_posix() for path in run.damaged_parts()), *frames]

    def files(self) -> dict[str, Path]:
        """The files that the page may read, by the name that it requests; no other file of the runs is served."""
        run = open_run(self.folder)
        own = {part["file"]: run.path / part["file"] for table in TABLE_FOLDERS for part in self._parts(run, table)}
        return own | self.overlay.files()

    def _parts(self, run: Run, table: str) -> list[dict[str, Any]]:
        paths = part_paths(run.path, table)
        if table == "agents" and (run.path / LIVING).is_file():
            paths.append(run.path / LIVING)
        parts = []
        for path in paths:
            part: dict[str, Any] = {"file": path.relative_to(run.path).as_posix(), "bytes": path.stat().st_size}
            if table == "frames":
                spans = self._frame_spans(run, path, part["bytes"])
                part |= {"damaged": True} if spans is None else {"worlds": spans}
            parts.append(part)
        return parts

    def _frame_spans(self, run: Run, path: Path, size: int) -> list[Span] | None:
        """The steps of each world in a part of the frames; None if the part is damaged."""
        key = (path.name, size)
        if key not in self._spans:
            try:
                self._spans[key] = _spans(read_part(path, run_tables(run.columns)["frames"], run.manifest), run)
            except RecordError:
                self._spans[key] = None
        return self._spans[key]


def _spans(rows: pl.DataFrame, run: Run) -> list[Span]:
    ends = rows.group_by("world").agg(first=pl.col("step").min(), last=pl.col("step").max())
    span_by_world = {world: (first, last) for world, first, last in ends.iter_rows()}
    return [span_by_world.get(world) for world in range(len(run.manifest.seeds))]


def _settings(config: Config) -> dict[str, Any]:
    """The settings of a run as text: its preset, the differences from it, and all settings with their meanings."""
    return {
        "base": f"{config.preset} ({config.fidelity})",
        "changed": [[path, _formatted(new), _formatted(old)] for path, old, new in changed_settings(config)],
        "all": [[path, format_value(value), setting.doc.meaning] for path, setting, value in file_leaves(config)],
    }


def _formatted(value: Any) -> str:
    return "absent" if value is None else format_value(value)
