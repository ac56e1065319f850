"""The recording at the top of the article shows the preset, moves at once, and may be missing."""

import gzip
import json
import runpy

import numpy as np
import pytest
from project_files import ROOT

from hedon.view.page import page_files
from hedon.view.story import PAGE

pytest_plugins = ("view_fixture", "story_fixture")
STRIP = "[...document.querySelector('#hero-world').getContext('2d').getImageData(0, 100, 400, 1).data]"


def test_it_begins_within_a_second_and_can_be_paused(story_site, watch):
    watched = watch(story_site.link + PAGE)
    watched.until("hedon.hero?.moment() > 2")
    assert watched.page.locator("#hero-world").is_visible()
    assert "alive, mean feeling" in watched.page.locator("#hero-clock").inner_text()
    watched.page.locator("#hero-play").click()
    at = watched.get("hedon.hero.moment()")
    watched.until("hedon.pictures > 30")
    assert watched.get("hedon.hero.moment()") == at
    watched.get("hedon.hero.jump(320)")
    watched.until("document.querySelector('#hero-clock').textContent.startsWith('step 20,480')")


def test_with_reduced_motion_it_shows_its_end(story_site, watch):
    watched = watch(story_site.link + PAGE, reduced_motion="reduce")
    watched.until("hedon.hero && document.querySelector('#hero-clock').textContent.startsWith('step 20,480')")
    assert watched.page.locator("#hero-play").inner_text() == "Play"


def test_without_the_recording_the_picture_stays_and_it_can_be_tried_again(story_site, browser):
    page = browser.new_page()
    page.route("**/hero.gz", lambda route: route.abort())
    page.goto(story_site.link + PAGE)
    page.locator("#hero-fault").wait_for()
    assert page.locator("#hero img").is_visible()
    assert page.locator("#hero-world").is_hidden()
    page.unroute("**/hero.gz")
    page.locator("#hero-fault button").click()
    page.locator("#hero-world").wait_for()
    assert page.locator("#hero-fault").is_hidden()
    page.close()


def test_only_sites_with_the_article_have_the_recording(tmp_path):
    from hedon.view.export import export

    export(tmp_path / "run", {"page": {}}, {})
    export(tmp_path / "story", {"page": {}, "story": {}}, {})
    assert {path.name for path in tmp_path.glob("*/hero.*")} == {"hero.gz", "hero.jpg"}
    assert not list((tmp_path / "run").glob("hero.*"))


@pytest.mark.long
def test_the_recording_is_what_its_command_makes(tmp_path):
    made = runpy.run_path(str(ROOT / "web" / "hero.py"))
    made["main"].__globals__["PUBLIC"] = tmp_path
    made["main"]()
    assert gzip.decompress((tmp_path / "hero.gz").read_bytes()) == gzip.decompress(page_files()["hero.gz"].read_bytes())


def test_its_positions_have_the_format_that_the_page_reads():
    """The header names the columns that follow, and the summed position changes stay in the arena."""
    head, _, rest = gzip.decompress(page_files()["hero.gz"].read_bytes()).partition(b"\n")
    told = json.loads(head)
    columns, at = {}, 0
    for name, count in told["columns"].items():
        planes = np.frombuffer(rest, np.uint8, 2 * count, at).reshape(2, count)
        columns[name] = np.ascontiguousarray(planes.T).view("<i2").ravel()
        at += 2 * count
    assert at == len(rest)
    ends = np.cumsum(columns["count"])
    for axis, size in (("x", told["width"]), ("y", told["height"])):
        places = np.concatenate([np.cumsum(each) for each in np.split(columns[axis], ends[:-1])])
        assert places.min() >= 0
        assert places.max() <= size
    first, last = (
        columns["feeling"][(columns["first"] <= moment) & (moment < columns["first"] + columns["count"])]
        for moment in (1, told["moments"] - 1)
    )
    assert abs(first.mean()) < 5 < 30 < last.mean(), "the feeling evolves"
