"""Writes the page and the records that it needs as a static site, for any web server."""

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hedon.view.page import ViewError, page_files, to_json


def export(folder: Path, data: Mapping[str, Any], records: Mapping[str, Path]) -> int:
    """Writes a site.

    Args:
        folder: Folder of the site.
        data: Data of the page, by name.
        records: Files that the page may read, by name.

    Returns:
        Number of bytes written.

    Raises:
        ViewError: The folder already contains something else.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ViewError(f"{folder} is not empty: choose a new folder, or remove what is in it first")
    excluded = ("single.js",) if "story" in data else ("single.js", "hero.", "still/")
    pages = {name: path for name, path in page_files().items() if not name.startswith(excluded)}
    pairs = [*pages.items(), *((f"data/run/{name}", path) for name, path in records.items())]
    for name, path in pairs:
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target, follow_symlinks=False)
    for name, content in data.items():
        target = folder / "data" / f"{name}.json"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(to_json(content))
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
