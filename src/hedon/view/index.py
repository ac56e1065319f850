"""What the page is told about a run: its layout, and which files hold its rows."""

from pathlib import Path
from typing import Any

import polars as pl

from hedon.config.load import parse_config
from hedon.record.folder import LIVING, TABLE_FOLDERS, part_paths
from hedon.record.reader import Run, open_run
from hedon.view.layout import describe

FrameSteps = dict[tuple[str, int], tuple[int, int]]
"""First and last step of each part of the frames, by its name and its size."""


class RunIndex:
    """Describes one run, again and again while it goes on. Parts that have been looked into are not read again."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._steps: FrameSteps = {}
        open_run(folder)

    def describe(self) -> dict[str, Any]:
        """The run as it is now.

        Returns:
            `name`, `status`, `seeds`, `steps` (done, per world), `extinct` (step or None, per world), `frames` (steps
            between two), `digests`, `obstacles` (corners of each, per world), `layout`, and `files`: for each table its
            parts, each with `file` (relative to the run), `bytes` and, for frames, `first` and `last` step.

        Raises:
            RecordError: It is no run, or it holds a symbolic link.
        """
        run = open_run(self.folder)
        manifest = run.manifest
        config = parse_config(run.config_text, str(self.folder))
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
            "files": {table: list(self._parts(run, table)) for table in TABLE_FOLDERS},
        }

    def files(self) -> dict[str, Path]:
        """The files that the page may read, by the name that it asks for: nothing else of the run is served."""
        run = open_run(self.folder)
        return {part["file"]: run.path / part["file"] for table in TABLE_FOLDERS for part in self._parts(run, table)}

    def _parts(self, run: Run, table: str) -> list[dict[str, Any]]:
        paths = part_paths(run.path, table)
        if table == "agents" and (run.path / LIVING).is_file():
            paths.append(run.path / LIVING)
        parts = []
        for path in paths:
            part: dict[str, Any] = {"file": path.relative_to(run.path).as_posix(), "bytes": path.stat().st_size}
            if table == "frames":
                part["first"], part["last"] = self._frame_steps(path, part["bytes"])
            parts.append(part)
        return parts

    def _frame_steps(self, path: Path, size: int) -> tuple[int, int]:
        key = (path.name, size)
        if key not in self._steps:
            column = pl.scan_parquet(path, glob=False).select(pl.col("step").min(), last=pl.col("step").max()).collect()
            first, last = column.row(0)
            self._steps[key] = (first, last) if first is not None else (0, -1)
        return self._steps[key]
