"""Shrinks pictures of the documentation to 128 colors: `python -m release.palette FILE.png ...`."""

import sys
from pathlib import Path

from PIL import Image

COLORS = 128


def shrink(path: Path) -> None:
    """Rewrites a picture with a palette, unless it has one.

    Args:
        path: Of a PNG file.
    """
    with Image.open(path) as picture:
        if picture.mode == "P":
            return
        dpi = picture.info.get("dpi", (72, 72))
        picture.convert("RGB").quantize(COLORS, dither=Image.Dither.NONE).save(path, optimize=True, dpi=dpi)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        shrink(Path(name))
