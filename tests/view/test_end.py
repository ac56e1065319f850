"""Nothing is a dead end: the end of a run, a world that died out, graphics that the browser takes away."""

import pytest
from view_page import run_server, serving

from hedon import load_config
from hedon.view.live import live_world
from hedon.view.server import Server

pytest_plugins = ("view_fixture",)


@pytest.mark.long
def test_play_at_the_end_begins_again(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.rest_at(2048)
        assert watched.page.locator("#play").inner_text() == "Play"
        watched.page.locator("#play").click()
        watched.until("hedon.playing && hedon.now < 1024")
        watched.get("(hedon.seek(2040), hedon.faster(5))")
        watched.until("!hedon.playing && hedon.now === 2048")
        assert watched.page.locator("#play").inner_text() == "Play"


@pytest.fixture
def doomed(watch):
    """A live world in which all agents starve within a few steps."""
    settings = ["energy.basic_cost=5", "food.normal.initial_count=0", "food.normal.growth_rate=0", "hazard.kappa=0.5"]
    page = {"run": False, "worlds": [live_world(load_config("small", overrides=settings), "small")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.over", 90)
        yield watched


def test_an_extinct_world_can_be_looked_back_at_and_restarted(doomed):
    doomed.until("!document.querySelector('#notice').hidden")
    last = doomed.get("hedon.source.last")
    notice = doomed.page.locator("#notice")
    assert notice.inner_text().startswith(f"The world died out at step {last}")
    doomed.get("hedon.setSpeed(1/8)")
    notice.get_by_role("button", name="Look back").click()
    doomed.until("hedon.playing && hedon.now < hedon.source.last && document.querySelector('#notice').hidden")
    assert doomed.get("hedon.frame.id.length") > 0
    doomed.get("hedon.seek(hedon.source.last)")
    doomed.until("!document.querySelector('#notice').hidden")
    notice.get_by_role("button", name="Another seed").click()
    doomed.until("hedon.source.seed === 2 && hedon.frame && document.querySelector('#notice').hidden")


def test_lost_graphics_are_reported_and_restored(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.rest_at(640)
        before = watched.page.locator("#scene").screenshot()
        watched.get("(window.taken = hedon.arena.scene.gl.getExtension('WEBGL_lose_context')).loseContext()")
        watched.until("document.querySelector('#notice').textContent.includes('graphics')")
        watched.get("taken.restoreContext()")
        watched.until("!hedon.arena.scene.lost && document.querySelector('#notice').hidden")
        drawn = watched.get("hedon.pictures")
        watched.until(f"hedon.pictures > {drawn} + 2")
        assert watched.page.locator("#scene").screenshot() == before
