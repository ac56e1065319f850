"""The further runs of `hedon view A B`: the page adds their curves to the plots of the first run, nothing else."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hedon.record.folder import part_paths
from hedon.record.reader import open_run
from hedon.view.page import ViewError

MOST = 3
"""The most further runs, since the page has three ways to dash a line."""


class Overlay:
    """Describes further runs, repeatedly while they are in progress.

    Args:
        first: Folder of the run that the page shows in full.
        folders: Folders of the runs whose curves it adds.

    Raises:
        RecordError: A folder is not a run, or contains a symbolic link.
        ViewError: There are too many runs, or one of them twice.
    """

    def __init__(self, first: Path, folders: Sequence[Path]) -> None:
        if len(folders) > MOST:
            raise ViewError(f"{1 + len(folders)} runs: the page tells at most {1 + MOST} apart")
        for folder in folders:
            open_run(folder)
        resolved = [folder.resolve() for folder in (first, *folders)]
        for folder, count in Counter(resolved).items():
            if count > 1:
                raise ViewError(f"{folder} is given {count} times: give each run once")
        names = Counter(path.name for path in resolved)
        self.runs = {
            (str(folder) if names[path.name] > 1 else path.name): folder
            for folder, path in zip(folders, resolved[1:], strict=True)
        }
        """Folders of the further runs, by the names that the page shows."""

    def describe(self) -> list[dict[str, Any]]:
        """For each run its `run` (a name), its `seeds` and the `files` of its table `population`, as in `files`."""
        return [
            {"run": name, "seeds": list(open_run(folder).manifest.seeds), "files": list(_files(i, folder))}
            for i, (name, folder) in enumerate(self.runs.items())
        ]

    def files(self) -> dict[str, Path]:
        """The files that the page may read, by the name that it requests."""
        return {name: path for i, folder in enumerate(self.runs.values()) for name, path in _files(i, folder).items()}


def _files(number: int, folder: Path) -> dict[str, Path]:
    run = open_run(folder)
    return {f"others/{number}/{path.name}": path for path in part_paths(run.path, "population")}
