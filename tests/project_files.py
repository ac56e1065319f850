"""The files of the project, as its tests of the repository see them: also in an unpacked archive, where git is not."""

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
IGNORED = {".git", *(line.rstrip("/") for line in (ROOT / ".gitignore").read_text().splitlines() if line.endswith("/"))}


def project_files(*suffixes: str) -> list[Path]:
    """The files whose names end with one of the suffixes, in the folders that `.gitignore` does not name."""
    return sorted(path for path in _walk(ROOT) if path.name.endswith(suffixes))


def _walk(folder: Path) -> Iterator[Path]:
    for entry in folder.iterdir():
        if entry.name in IGNORED:
            continue
        if entry.is_dir():
            yield from _walk(entry)
        else:
            yield entry
