"""The data of the article of `hedon view --story`: the world of each scene, whose config is a file in `scene/`."""

from importlib.resources import files
from pathlib import Path
from typing import Any

from hedon.config.load import load_config
from hedon.view.live import live_world

SCENES = Path(str(files("hedon.view"))) / "scene"
PAGE = "story.html"
"""The file of the article in the built page."""


def story() -> dict[str, Any]:
    """The worlds of the article's scenes.

    Returns:
        `worlds`: the result of `live_world` for each scene's file, by its name; `hedon run FILE` also runs the file.
    """
    return {"worlds": {path.stem: live_world(load_config(path), str(path)) for path in sorted(SCENES.glob("*.toml"))}}
