"""The article as a page: its words, size and sources, and its accessibility on any screen, light or dark."""

import gzip
import json
import os
import re
import runpy
from html.parser import HTMLParser

import pytest
from command import hedon as command
from project_files import ROOT
from view_page import CHROMIUM, Watched, serving, site_server, story_server

from hedon import load_config
from hedon.view.page import page_files
from hedon.view.single import FONT
from hedon.view.story import PAGE, SCENES, story

pytest_plugins = ("view_fixture",)

STORY = ROOT / "web" / "src" / "story"
TEXTS = ("creature", "learning", "family", "evolve", "contest", "sandbox")
PICTURES = os.environ.get("HEDON_PICTURES")
"""If set, the pictures of all scenes are kept in `build/story`."""
ASK_AXE = """() => axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) =>
  violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html.slice(0, 160))]))"""


class Words(HTMLParser):
    """The words of a page, and the numbers in it that are bound to settings."""

    def __init__(self, html):
        super().__init__()
        self.words, self.bound, self.knobs, self._of = [], [], [], None
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self._of = given.get("data-of")
        if "data-path" in given:
            self.knobs.append((given["data-path"], given["value"]))

    def handle_data(self, data):
        self.words += data.split()
        if self._of:
            self.bound.append((self._of, data))
        self._of = None


def scene(name):
    return (STORY / f"{name}.html").read_text()


def test_the_article_is_short():
    texts = [(ROOT / "web" / "story.html").read_text(), *map(scene, TEXTS)]
    assert 600 < sum(len(Words(re.sub(r"(?s)<!--.*?-->", "", text)).words) for text in texts) < 1200


@pytest.mark.parametrize("name", TEXTS)
def test_each_scene_can_be_read_without_scripts(name):
    text = scene(name)
    assert len(Words(text[text.index("<figcaption>") :]).words) > 12, "for those who only read"
    assert name in ("evolve", "sandbox", "contest") or "Your guess" in text


@pytest.mark.parametrize("name", TEXTS)
def test_numbers_in_the_text_match_the_config(name):
    worlds = story()["worlds"]
    settings = {each["path"]: each["value"] for world in worlds.values() for each in world["settings"]}
    if name in worlds:
        settings = {each["path"]: each["value"] for each in worlds[name]["settings"]}
    found = Words(scene(name))
    assert not [word for word in found.words if re.match(r"-\d", word)], "a hyphen is not a minus sign"
    for path, text in found.bound + ([] if name == "sandbox" else found.knobs):
        assert float(text.replace("\N{MINUS SIGN}", "-")) == settings[path], path
    assert found.bound or name in ("learning", "family", "evolve", "sandbox")


def test_the_article_is_small():
    """Compressed: what a reader loads, with the one of the two modules that the browser uses."""
    names = [PAGE, "hedon.wasm", "hedon-relaxed.wasm", "assets/story.js", "assets/story.css", "assets/live.worker.js"]
    names += ["assets/shared.js", "assets/member.worker.js", FONT]
    told = len(gzip.compress(json.dumps(story()).encode()))
    sizes = {name: len(gzip.compress(page_files()[name].read_bytes())) for name in names}
    both = sum(size for name, size in sizes.items() if name.endswith(".wasm"))
    assert sum(sizes.values()) - both / 2 + told < 400_000
    assert sum(sizes.values()) + told < 600_000
    assert page_files()["hero.gz"].stat().st_size < 300_000, "loaded after the first picture"
    assert page_files()["hero.jpg"].stat().st_size < 130_000
    stills = [page_files()[f"still/{name}.jpg"].stat().st_size for name in TEXTS]
    assert max(stills) < 50_000, "loaded only if a world cannot run"


def test_the_font_is_small_and_comes_with_its_license(server, browser):
    assert page_files()[FONT].stat().st_size < 25_000
    assert "SIL OPEN FONT LICENSE Version 1.1" in page_files()["font-license.txt"].read_text()
    watched = Watched(browser.new_page(), server.link + PAGE)
    watched.until("[...document.fonts].length === 1 && [...document.fonts][0].status === 'loaded'")
    watched.page.close()
    assert watched.faults == []


def test_the_numbers_of_the_contest_match_the_committed_results():
    made = runpy.run_path(str(ROOT / "web" / "evidence.py"))["text"]()
    assert (STORY / "evidence.json").read_text() == made, "run: python web/evidence.py"
    means = {row["weight"]: row["mean"] for row in json.loads(made)["ends"]["mean"] if row["seed"] == 1}
    evolved = load_config(SCENES / "contest.toml").species["evolution"]
    assert evolved.reward.meal_coef == means["w_normal"]
    assert evolved.genome.action.initial_mean == means["w_action"]


@pytest.fixture(scope="module")
def server():
    with serving(story_server()) as running:
        yield running


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("pictures")


@pytest.mark.parametrize(
    ("width", "scheme"),
    [
        (390, "light"),
        *(
            pytest.param(*each, marks=pytest.mark.long)
            for each in ((390, "dark"), (1024, "light"), (1024, "dark"), (1400, "light"), (1400, "dark"))
        ),
    ],
)
def test_each_scene_fits_each_screen(width, scheme, server, browser, folder):
    axe = pytest.importorskip("axe_playwright_python.base", reason="needs axe: uv sync --group browser")
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme, has_touch=width < 500)
    watched = Watched(context.new_page(), server.link + PAGE)
    for name in TEXTS:
        section = watched.page.locator(f"#{name}")
        section.scroll_into_view_if_needed()
        watched.get(f"document.getElementById('{name}').scrollIntoView({{ behavior: 'instant' }})")
        watched.page.locator(f"#{name} .view").scroll_into_view_if_needed()  # on a phone a map may come first
        watched.until(f"hedon.scenes.{name}.stage.frame && hedon.scenes.{name}.stage.pictures > 3")
        taken = section.screenshot()
        assert len(taken) > 20_000, "something is drawn"
        path = folder / f"{name}-{width}-{scheme}.png"
        if PICTURES:
            path = ROOT / "build" / "story" / path.name
            path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(taken)
    assert watched.get("document.documentElement.scrollWidth") <= width, "nothing is wider than the screen"
    small = watched.get(
        """[...document.querySelectorAll('main button:not(.link), main input')].filter((each) => each.offsetParent)
          .map((each) => [each.id || each.textContent, each.getBoundingClientRect().height])"""
    )
    assert [each for each in small if each[1] < 18] == []
    watched.get(axe.AXE_FILE_PATH.read_text())
    assert watched.page.evaluate(ASK_AXE) == []
    context.close()
    assert watched.faults == []


def test_with_reduced_motion_nothing_moves_by_itself(server, browser):
    context = browser.new_context(reduced_motion="reduce")
    watched = Watched(context.new_page(), server.link + PAGE)
    watched.until("hedon.scenes.creature")
    watched.get("document.querySelector('#creature').scrollIntoView({ behavior: 'instant' })")
    watched.until("hedon.scenes.creature.stage.live?.ready && hedon.scenes.creature.stage.pictures > 20")
    assert watched.get("hedon.scenes.creature.stage.live.last") == 0
    watched.page.locator("#creature").get_by_role("button", name="Play").click()
    watched.until("hedon.scenes.creature.stage.live.last > 3")
    context.close()
    assert watched.faults == []


@pytest.mark.smoke
def test_the_article_can_be_exported_to_a_folder_for_any_server(tmp_path, watch):
    done = command("view", "--story", "--export", str(tmp_path / "site"))
    assert "open its story.html" in done.stdout
    with serving(site_server(tmp_path / "site")) as server:
        watched = watch(f"http://127.0.0.1:{server.server_port}/{PAGE}")
        watched.until("hedon.hero?.moment() > 0 && hedon.scenes.creature")
        watched.get("document.querySelector('#creature').scrollIntoView({ behavior: 'instant' })")
        watched.until("hedon.scenes.creature.stage.live?.last > 0")
        ids = set(watched.get("[...document.querySelectorAll('[id]')].map((each) => each.id)"))
        links = set(watched.get("[...document.querySelectorAll('a[href]')].map((each) => each.getAttribute('href'))"))
        inside = {link for link in links if link.startswith("#") and not link.startswith("#scene=")}
        assert {link[1:] for link in inside} <= ids
        assert {link for link in links if not link.startswith("#")} == {
            "index.html",
            "https://arxiv.org/abs/2406.15016",
        }
        watched.page.get_by_role("link", name="a world of your own").click()
        watched.until("window.hedon?.source?.ready")


def test_a_site_without_the_article_says_so(tmp_path, browser):
    if not CHROMIUM.exists():
        pytest.skip(f"needs {CHROMIUM}: apt-get install chromium")
    for name, path in page_files().items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(path.read_bytes())
    with serving(site_server(tmp_path)) as server:
        page = browser.new_page()
        page.goto(f"http://127.0.0.1:{server.server_port}/{PAGE}")
        page.wait_for_selector("#notice:not([hidden])")
        assert "call hedon view --story" in page.inner_text("#notice")
        page.close()
