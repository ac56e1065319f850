"""The files of the web page that `make viewer` builds, and the data that it loads."""

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

from hedon.error import HedonError

STATIC = Path(str(files("hedon.view"))) / "static"
CONTENT_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json",
    ".wasm": "application/wasm",
    ".woff2": "font/woff2",
    ".parquet": "application/octet-stream",
}


class ViewError(HedonError):
    """A run cannot be shown, or a page cannot be written."""


def page_files() -> dict[str, Path]:
    """Every file of the built page, by the name that a browser requests.

    Raises:
        ViewError: The page has not been built.
    """
    if not (STATIC / "index.html").is_file():
        raise ViewError("the page is not built here: call `make viewer` in a checkout, which needs Node")
    paths = (path for path in sorted(STATIC.rglob("*")) if path.is_file())
    return {path.relative_to(STATIC).as_posix(): path for path in paths}


def to_json(data: Any) -> bytes:
    """Data for the page as JSON; NaN is refused, since browsers cannot parse it."""
    return json.dumps(data, allow_nan=False, separators=(",", ":")).encode()
