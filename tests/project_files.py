"""The files of the project for the repository tests, which also work in an unpacked archive, without git."""

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
IGNORED = {".git", *(line.rstrip("/") for line in (ROOT / ".gitignore").read_text().splitlines() if line.endswith("/"))}


def project_files(*suffixes: str) -> list[Path]:
    """Files whose names end with one of the suffixes, outside the folders listed in `.gitignore`."""
    return sorted(path for path in _walk(ROOT) if path.name.endswith(suffixes))


def _walk(folder: Path) -> Iterator[Path]:
    for entry in folder.iterdir():
        if entry.name in IGNORED:
            continue
        if entry.is_dir():
            yield from _walk(entry)
        else:
            yield entry
