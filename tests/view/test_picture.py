"""Screenshots of the page in the documentation; `HEDON_PICTURES=1 pytest tests/view/test_picture.py` takes them."""

import io
import os

import pytest
from matplotlib.image import imread
from project_files import ROOT
from view_page import demo_server, live_server, serving

pytest_plugins = ("view_fixture",)

IMAGES = ROOT / "docs" / "images"
LARGEST = 450_000  # bytes of one picture


def live(watched, steps):
    """Runs a live world for some steps, and pauses it."""
    watched.get("hedon.play(false)")
    watched.until("!hedon.source.busy")
    while (done := watched.get("hedon.source.last")) < steps:
        watched.get(f"hedon.source.advance({min(steps - done, 128)}, 20000)")
        watched.until("!hedon.source.busy")
    watched.get("hedon.seek(hedon.source.last)")
    watched.until("hedon.frame && hedon.frame.step === hedon.source.last && hedon.source.digest() !== ''")


def show_agent(watched):
    """Shows the agent nearest to the middle among those that have eaten; its rays are easiest to see there."""
    live(watched, 1000)
    watched.get(
        """hedon.choose([...hedon.frame.id]
          .map((id, i) => [Math.hypot(hedon.frame.x[i] - 240, hedon.frame.y[i] - 180), id])
          .filter(([, id]) => hedon.source.lives.get(id).eaten[0] > 0).sort((a, b) => a[0] - b[0])[0][1])"""
    )
    watched.until("document.querySelector('#agent').textContent.includes('value of now')")


def show_meals(watched):
    live(watched, 300)
    watched.page.locator("#color").select_option("last")
    watched.get("hedon.tab('world-panel')")
    watched.page.locator("#keep").click()
    watched.until("hedon.source.kept >= 0")


def show_twin(watched):
    """Shows the world next to a copy with five times the cost of living."""
    live(watched, 64)
    watched.get("hedon.tab('world-panel')")
    watched.page.locator("#twin-setting").select_option("energy.basic_cost")
    watched.page.locator("#twin-value").fill("0.005")
    watched.page.locator("#twin-begin").click()
    watched.until("hedon.twin.live && hedon.now > 900")
    watched.get("hedon.play(false)")
    watched.until("!hedon.source.busy && !hedon.twin.live.busy")


def show_settings(watched):
    live(watched, 384)
    watched.get("document.documentElement.dataset.theme = 'dark'")
    watched.get("hedon.tab('settings')")
    watched.get(
        "[...document.querySelectorAll('#settings details')].find((x) => /^food/.test(x.innerText)).open = true"
    )


def show_plots(watched):
    watched.until("hedon.source.series.step.length > 1 && hedon.source.lives.size > 0")
    watched.get("(hedon.play(false), hedon.seek(hedon.source.last * 0.7))")
    watched.page.locator("#color").select_option("w_normal")
    watched.get("hedon.tab('plots')")


VIEWS = {
    "view": ("live", show_agent),
    "view-world": ("live", show_meals),
    "view-twin": ("live", show_twin),
    "view-settings": ("live", show_settings),
    "view-plots": ("site", show_plots),
}


@pytest.mark.long
@pytest.mark.parametrize("name", VIEWS)
def test_the_documentation_has_a_picture_of_each_view(name, watch):
    kind, show = VIEWS[name]
    with serving(live_server("poison") if kind == "live" else demo_server()) as server:
        watched = watch(server.link if kind == "live" else f"http://127.0.0.1:{server.server_port}/index.html")
        show(watched)
        drawn = watched.get("hedon.pictures")
        watched.until(f"hedon.pictures > {drawn} + 30")  # the panels are updated a few times a second
        taken = watched.page.screenshot()
    path = IMAGES / f"{name}.png"
    if os.environ.get("HEDON_PICTURES"):
        path.write_bytes(taken)
    known = path.read_bytes()
    assert imread(io.BytesIO(known)).shape == imread(io.BytesIO(taken)).shape
    assert len(known) < LARGEST
    assert 0.4 < len(known) / len(taken) < 2.5, "the page looks quite different now: take the pictures again"
