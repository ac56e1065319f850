"""Writes the article as one file that any browser can open without a server."""

import base64
import gzip
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hedon.record.atomic import write_atomically
from hedon.view.page import CONTENT_TYPES, page_files, to_json
from hedon.view.story import PAGE

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; "
    "connect-src data: blob:; style-src 'unsafe-inline'; font-src data:; img-src data: blob:; base-uri 'none'; "
    "form-action 'none'"
)
FONT = "assets/fraunces-latin-600-normal.woff2"
HELD = (
    "assets/story.js",
    "assets/shared.js",
    "assets/live.worker.js",
    "hedon-relaxed.wasm",
    "hedon.wasm",
    "hero.gz",
)
"""Files that the page would request from a server, besides the worlds of scenes. `single.js` gives each an address."""


def write_single(path: Path, told: Mapping[str, Any]) -> int:
    """Writes the article with everything that it needs to one file, replacing an existing one.

    Args:
        path: Path of the file.
        told: The data from `story()`.

    Returns:
        Number of bytes written.

    Raises:
        RecordError: The file cannot be written.
        ViewError: The page has not been built.
    """
    files = page_files()
    embedded = {name: files[name].read_bytes() for name in HELD} | {"data/story.json": to_json(told)}
    blocks = "\n".join(_held(name, content) for name, content in embedded.items())
    picture, font = (_data_url(kind, files[name]) for name, kind in (("hero.jpg", "image/jpeg"), (FONT, "font/woff2")))
    style, script = (files[name].read_text(encoding="utf-8") for name in ("assets/story.css", "single.js"))
    style = style.replace(f"url(./{Path(FONT).name})", f"url({font})")
    page = files[PAGE].read_text(encoding="utf-8")
    for pattern, text in (
        (r'(?<=http-equiv="Content-Security-Policy")\s+content="[^"]*"', f' content="{POLICY}"'),
        (r'<script type="module"[^>]*></script>\s*', ""),
        (r'<link rel="stylesheet"[^>]*>', f"<style>{style}</style>"),
        (r'\s*<meta property="og:image"[^>]*>', ""),  # needs a web address, which the file lacks
        (r'<a href="index\.html">[^<]*</a>', "a world of your own (<code>hedon view --live</code>)"),
        (r'(?<=src=")[^"]*hero\.jpg', picture),
        (r"(?=</body>)", f"{blocks}\n<script>{script}</script>\n"),
    ):
        page, count = re.subn(pattern, lambda _, text=text: text, page)
        assert count == 1, pattern
    content = page.encode()
    write_atomically(path, lambda file: file.write(content))
    return len(content)


def _data_url(kind: str, path: Path) -> str:
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"


def _held(name: str, content: bytes) -> str:
    """A file as text within the page."""
    kind = CONTENT_TYPES.get(Path(name).suffix, "application/octet-stream").partition(";")[0]
    packed = content if name.endswith(".gz") else gzip.compress(content, 9, mtime=0)
    text = base64.b64encode(packed).decode()
    return f'<script type="text/plain" data-name="{name}" data-type="{kind}">{text}</script>'
