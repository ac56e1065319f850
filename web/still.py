"""Takes a picture of each scene of the article, shown where a browser cannot run its world.

As a program it writes `web/public/still/SCENE.jpg`. It needs the browser that the tests use.
"""

import sys
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "tests"))
from view_page import CHROMIUM, FLAGS, Watched, serving, story_server  # noqa: E402

from hedon.view.story import PAGE  # noqa: E402

STILL = ROOT / "web" / "public" / "still"
WIDTH, QUALITY = 640, 60
"""Width [pixel] and quality of a JPEG file: some 30 kB for each scene."""
STEPS = {"creature": 0, "learning": 81_920, "family": 700, "evolve": 12_288, "contest": 6_000, "sandbox": 600}
"""The step that each scene is shown at, in its first world."""


def main() -> None:
    """Writes the picture of every scene."""
    STILL.mkdir(exist_ok=True)
    with sync_playwright() as tool, serving(story_server()) as server:
        browser = tool.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        for scene, step in STEPS.items():
            context = browser.new_context(viewport={"width": 1400, "height": 900}, color_scheme="light")
            watched = Watched(context.new_page(), f"{server.link}{PAGE}#scene={scene}")
            watched.until("hedon.opened !== ''")
            watched.get(f"void hedon.scenes.{scene}.stage.runTo({step})")
            watched.until(f"!hedon.scenes.{scene}.stage.running", 900)
            view = watched.page.locator(f"#{scene} .view")
            view.scroll_into_view_if_needed()
            watched.get("[...document.querySelectorAll('.hint')].forEach((each) => each.remove())")
            drawn = watched.get(f"hedon.scenes.{scene}.stage.pictures")
            watched.until(f"hedon.scenes.{scene}.stage.pictures > {drawn} + 3")
            picture = Image.open(BytesIO(view.screenshot())).convert("RGB")
            size = (WIDTH, round(WIDTH * picture.height / picture.width))
            picture.resize(size, Image.Resampling.LANCZOS).save(STILL / f"{scene}.jpg", quality=QUALITY, optimize=True)
            context.close()
        browser.close()


if __name__ == "__main__":
    main()
