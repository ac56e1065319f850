"""The article as one file: a browser opens it without a server, and its worlds match Python."""

import gzip
import re

import pytest
from command import hedon as command
from story_page import native, run_to, stage
from view_page import Watched

pytest_plugins = ("view_fixture",)

FONT_LOADED = "document.fonts.check('600 27px Fraunces') && [...document.fonts][0].status === 'loaded'"
PAPER = "https://arxiv.org/abs/2406.15016"


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("single") / "article.html"
    done = command("view", "--story", "--export", str(path))
    assert done.stdout.endswith("MB: open it in any browser\n")
    return path


def test_it_is_small_and_requests_nothing(file):
    text = file.read_text(encoding="utf-8")
    assert len(gzip.compress(file.read_bytes())) < 1_100_000
    assert 'src="./' not in text
    assert 'href="./' not in text
    assert "url(./" not in text
    assert "url(data:font/woff2;base64," in text
    assert set(re.findall(r'<a href="([^#"][^"]*)"', text)) == {PAPER}, "the live page is in another file"
    assert "<code>hedon view --live</code>" in text


def test_it_plays_and_has_the_bits_of_python_without_a_server(file, browser):
    page = browser.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    watched = Watched(page, file.as_uri())
    watched.faults = [fault for fault in watched.faults if not fault.startswith("asked ")]
    watched.until("hedon.hero?.moment() > 1")
    watched.until(FONT_LOADED)
    watched.get("document.querySelector('#family').scrollIntoView({ behavior: 'instant' })")
    watched.until(f"{stage('family')}.live?.ready")
    run_to(watched, "family", 300)
    watched.until(f"{stage('family')}.live.digest()")
    world = native(watched, "family", "family", watched.get(f"{stage('family')}.live.last"))
    assert watched.get(f"{stage('family')}.live.digest()") == world.digest()
    assert {url.partition(":")[0] for url in asked} <= {"file", "blob", "data"}
    assert [fault for fault in watched.faults if not fault.startswith("asked ")] == []
    page.close()


@pytest.mark.parametrize("words", [("--live", "--story"), ("--live",), ("run", "--story")])
def test_only_the_article_can_be_exported_as_one_file(tmp_path, words):
    done = command("view", *words, "--export", str(tmp_path / "page.html"))
    assert done.returncode == 2
    assert "only the article alone fits into one file; give a folder instead" in done.stderr
    assert not (tmp_path / "page.html").exists()
