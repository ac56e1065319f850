"""What the article does if something is missing, what it remembers, and whether it can be used by touch."""

import json
import re
import runpy
import time

import pytest
from project_files import ROOT
from story_page import STAGES, stage
from view_page import Watched, live_server, run_live, run_server, serving, sized

from hedon.view.story import PAGE

pytest_plugins = ("view_fixture", "story_fixture")
NO_GRAPHICS = """
const inner = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind === "webgl2" ? null : inner.call(this, kind, ...rest);
};
"""


def test_without_graphics_the_text_and_the_recording_stay(story_site, browser):
    page = browser.new_page()
    page.add_init_script(NO_GRAPHICS)
    Watched(page, story_site.link + PAGE).until("hedon.pictures > 2 && hedon.hero?.moment() > 1")
    said = page.locator(".fault").all_inner_texts()
    assert set(said) == {"This scene cannot be shown: this browser has no WebGL2."}
    assert page.evaluate("Object.keys(hedon.scenes)") == []
    assert page.locator("#learning p").first.inner_text()
    for name in STAGES:
        picture = page.locator(f"#{name} .view img")
        picture.scroll_into_view_if_needed()
        assert picture.evaluate("(each) => each.decode().then(() => each.naturalWidth)") == 640, name
    assert page.locator("#notice").is_hidden()
    page.close()


def test_a_world_that_cannot_run_says_so_in_its_arena_and_can_be_tried_again(story_site, browser):
    page = browser.new_page()
    page.route("**/*.wasm", lambda route: route.abort())
    page.goto(f"{story_site.link}{PAGE}")
    page.wait_for_timeout(500)
    page.locator("#family canvas.world").scroll_into_view_if_needed()
    fault = page.locator("#family .fault")
    fault.wait_for(timeout=60_000)
    assert fault.inner_text().startswith("This world stopped: ")
    assert page.locator("#family .clock").inner_text() == "step 0"
    assert page.locator("#family .view img").is_visible()
    page.unroute("**/*.wasm")
    fault.get_by_role("button", name="Try again").click()
    page.wait_for_selector("#family .fault", state="hidden")
    ready = "hedon.scenes.family.stage.live.ready && hedon.scenes.family.stage.live.last > 0"
    assert page.locator("#family .view img").count() == 0
    deadline = time.monotonic() + 60
    while not page.evaluate(ready):
        assert time.monotonic() < deadline
        time.sleep(0.1)
    page.close()


def test_no_scene_that_runs_shows_a_fault(article):
    watched = article("creature")
    watched.until("hedon.scenes.creature.stage.live.last > 30")
    watched.page.locator("#creature .hint").get_by_text("It drives itself").wait_for()
    assert watched.get("[...document.querySelectorAll('.fault')].filter((each) => !each.hidden).length") == 0


def test_the_article_remembers_its_theme(article, story_site):
    watched = article("contest")
    watched.page.locator("#theme").click()
    assert watched.get("document.documentElement.dataset.theme") == "dark"
    other = watched.page.context.new_page()
    other.goto(story_site.link + PAGE)
    assert other.evaluate("document.documentElement.dataset.theme") == "dark"
    other.close()


def test_the_scale_of_energy_follows_one_rule_from_the_first_step_on(watch):
    with serving(live_server("baseline")) as server:
        watched = watch(server.link)
        scale = watched.page.locator("#legend .scale")
        watched.until("hedon.frame && document.querySelector('#legend .scale')?.innerText")
        first = scale.inner_text()
        run_live(watched, 320)
        watched.get("(hedon.panelsDue = 0)")
        watched.until("hedon.source.series.step.length > 0")
        assert scale.inner_text() == first


@pytest.mark.parametrize("step", [0, 2048])
def test_no_plot_marks_a_moment_outside_its_axes(run_folder, watch, step):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.series.step.length > 1")
        watched.get("hedon.tab('plots')")
        watched.get("""(() => {
          window.marks = [];
          const inner = CanvasRenderingContext2D.prototype.fillRect;
          CanvasRenderingContext2D.prototype.fillRect = function (x, y, width, height) {
            if (width === 2 && this.canvas.closest('.plot')) window.marks.push(x);
            return inner.call(this, x, y, width, height);
          };
        })()""")
        watched.get(f"(hedon.play(false), hedon.seek({step}))")
        watched.get("(hedon.panelsDue = 0)")
        watched.until("hedon.pictures > 0")
        low, high = watched.get("[hedon.plots.plots[0].chart.bbox.left, hedon.plots.plots[0].chart.bbox.width]")
        marks = watched.get("new Promise((done) => setTimeout(() => done(window.marks), 600))")
        assert all(low - 1 <= x <= low + high for x in marks)
        assert bool(marks) == (step > 0)


def test_touch_targets_are_large_enough(article):
    watched = article("creature", **sized(390))
    small = watched.get("""[...document.querySelectorAll('button:not(.link), select, summary, input, .guess label')]
      .filter((each) => each.offsetParent && !/checkbox|radio/.test(each.type))
      .map((each) => [each.textContent || each.id || each.type, each.getBoundingClientRect().height])
      .filter(([, height]) => height < 44)""")
    assert small == []


def test_a_handout_has_a_picture_in_each_scene_and_a_line_for_each_answer(article):
    watched = article("creature")
    watched.get("void (window.print = () => (dispatchEvent(new Event('beforeprint')), (window.printed = true)))")
    watched.page.locator("#print").click()
    watched.until("window.printed", 120)
    sizes = watched.get("[...document.querySelectorAll('canvas.world')].map((each) => each.toDataURL().length)")
    assert len(sizes) == 6
    assert min(sizes) > 5_000, "something is drawn in each"
    watched.page.emulate_media(media="print")
    asked = ["#creature .guess", "#learning .guess", "#family .guess", "#evolve .words", "#contest .words"]
    lines = f"{asked}.map((each) => getComputedStyle(document.querySelector(each), '::after').content)"
    assert watched.get(lines) == ['"Your answer:"'] * 5
    assert not watched.page.locator("#contest-one").is_visible()
    rows = """Object.fromEntries([...document.querySelectorAll('.numbers')].map((each) =>
      [each.closest('section').id, each.querySelectorAll('tbody tr').length]))"""
    assert watched.get(rows) == {"creature": 0, "learning": 5, "family": 5, "evolve": 4, "contest": 5}
    assert watched.page.locator("#learning .numbers").is_visible()
    creature = watched.page.locator("#creature .numbers").inner_text()
    assert re.search(r"after [\d,]+ steps?, in which a meal felt like 1 and moving like 0\.$", creature)
    cells = "[...document.querySelectorAll('#contest .numbers td')].map((cell) => cell.textContent)"
    assert watched.get(cells) == [""] * 10, "to be filled in by hand"
    watched.get(f"void {stage('contest')}.results().push({{ seed: 1, you: 12, evolution: 19 }})")
    course = """{ seed: 3, learns: true, step: [0, 3072, 6200], feeling: [0, 0.1, 0.2],
      neutral: [[0, 0, 0.1], [0, -0.1, -0.3]] }"""
    watched.get(f"void {stage('evolve')}.courses().push({course})")
    watched.get("void dispatchEvent(new Event('beforeprint'))")
    assert watched.get(cells) == ["12", "19"]
    texts = watched.get("[...document.querySelectorAll('#evolve .numbers tbody tr')].map((row) => row.innerText)")
    assert [row.split("\t") for row in texts] == [
        ["feeling, world 3", "0.00", "+0.10", "+0.20", "", ""],
        ["gray gene, world 3", "0.00", "\N{MINUS SIGN}0.10", "\N{MINUS SIGN}0.30", "", ""],
    ]


@pytest.mark.long
def test_the_recorded_numbers_of_the_handout_match_its_worlds():
    record = runpy.run_path(str(ROOT / "web" / "handout.py"))
    kept = json.loads(record["FILE"].read_text())
    assert [record["learning"](each["moving"]) for each in kept["learning"]] == [
        each["rates"] for each in kept["learning"]
    ]
    assert record["evolve"](True, 1)["feeling"] == kept["evolve"][0]["feeling"][:2]
    assert [each["learns"] for each in kept["evolve"]] == [True, False]
