"""The page on a desktop, a tablet and a phone, light and dark: nothing is cut off or jumps, and it is accessible."""

from itertools import product

import pytest
from split_run import record_species
from view_page import GROUNDS, SIZES, live_server, run_server, serving, sized

axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs axe: uv sync --group browser")

pytest_plugins = ("view_fixture",)
PANELS = ("agent", "agents", "plots", "settings", "world-panel")
TARGET = 44  # pixels (WCAG 2.2, 2.5.5)


@pytest.fixture(scope="module")
def servers(tmp_path_factory):
    folder = record_species(tmp_path_factory.mktemp("width") / "run", steps=640, seeds=(1,))
    with serving(run_server(folder)) as replay, serving(live_server("small")) as live:
        yield {"replay": replay.link, "live": live.link}


def rest(watched):
    watched.get("hedon.play(false)")
    watched.until("hedon.frame && hedon.source.lives.size > 0")
    watched.get("hedon.next()")
    watched.until("document.querySelector('#agent h2')")


def violations(watched):
    found = axe.Axe().run(watched.page).response["violations"]
    return [(each["id"], [node["target"] for node in each["nodes"]][:3]) for each in found]


SCREENS = list(product(("live", "replay"), SIZES, GROUNDS))
WIDTHS = [390, *(pytest.param(width, marks=pytest.mark.long) for width in SIZES if width != 390)]
FEW = [("live", 390, "dark"), ("replay", 1400, "light")]


@pytest.mark.parametrize(
    ("kind", "width", "ground"),
    [pytest.param(*each, marks=[pytest.mark.long] * (each not in FEW)) for each in SCREENS],
)
def test_axe_finds_nothing(servers, kind, width, ground, watch):
    watched = watch(servers[kind], **sized(width, ground))
    rest(watched)
    watched.page.locator("#heat").select_option("positions")
    watched.page.locator("#color").select_option("neutral")
    for panel in PANELS:
        watched.get(f"hedon.tab('{panel}')")
        watched.get("document.querySelectorAll('details').forEach((each) => (each.open = true))")
        if panel == "agents":
            watched.page.locator("#filter").fill("agee > 3")
            watched.until("document.querySelector('#filter-problem').textContent !== ''")
        assert (panel, violations(watched)) == (panel, [])
    watched.page.keyboard.press("?")
    watched.until("document.querySelector('#help').open")
    assert violations(watched) == []


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_wider_than_the_page_and_no_panel_grows(servers, width, watch):
    watched = watch(servers["replay"], **sized(width))
    rest(watched)
    for panel in PANELS:
        watched.get(f"hedon.tab('{panel}')")
        watched.until("hedon.panelsDue > performance.now()")
        sizes = (
            f"(({{ scrollWidth, scrollHeight }}) => [scrollWidth, scrollHeight])(document.querySelector('#{panel}'))"
        )
        before = settled(watched, sizes)
        drawn = watched.get("hedon.pictures")
        watched.until(f"hedon.pictures > {drawn} + 60")  # several updates of the panels
        assert (panel, watched.get(sizes)) == (panel, before)
        assert watched.get("document.documentElement.scrollWidth") <= width
        right = f"""[...document.querySelectorAll('#{panel} *')].filter((each) => !each.closest('.agents *'))
          .map((each) => each.getBoundingClientRect().right)"""  # the table of agents scrolls
        assert watched.get(f"Math.max(...{right})") <= width + 1, panel


def settled(watched, sizes, tries=20):
    """The size of a panel once its records have been read, however long that takes on a busy machine."""
    for _ in range(tries):
        before, drawn = watched.get(sizes), watched.get("hedon.pictures")
        watched.until(f"hedon.pictures > {drawn} + 20")
        if watched.get(sizes) == before:
            return before
    raise AssertionError("the panel keeps growing")


@pytest.mark.parametrize("width", WIDTHS)
def test_the_time_line_stays_in_its_place(servers, width, watch):
    watched = watch(servers["live"], **sized(width))
    place = "JSON.stringify(document.querySelector('#timeline').getBoundingClientRect())"
    watched.get("hedon.play(false)")
    watched.until("hedon.frame")
    still = watched.get(place)
    watched.page.locator("#speed").select_option("64")
    watched.get("hedon.play(true)")
    watched.until("/steps skipped/.test(document.querySelector('#clock').textContent)")
    assert watched.get(place) == still
    watched.get("hedon.play(false)")
    watched.until("!/steps skipped/.test(document.querySelector('#clock').textContent)")
    assert watched.get(place) == still


def test_everything_that_a_finger_touches_is_large_enough(servers, watch):
    watched = watch(servers["live"], **sized(390))
    rest(watched)
    watched.get("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    for panel in PANELS:
        watched.get(f"hedon.tab('{panel}')")
        small = f"""[...document.querySelectorAll('button, select, summary, input, a, label.check, #timeline')]
          .filter((each) => each.offsetParent && each.type !== 'checkbox')
          .map((each) => [each.id || each.textContent || each.className, each.getBoundingClientRect()])
          .filter(([, box]) => box.width < {TARGET} || box.height < {TARGET}).map(([name]) => name)"""
        assert (panel, watched.get(small)) == (panel, [])


def test_a_phone_shows_arena_and_play_first(servers, watch):
    watched = watch(servers["live"], **sized(390))
    rest(watched)
    for name in ("scene", "play", "timeline", "look-next"):
        box = watched.page.locator(f"#{name}").bounding_box()
        assert box["y"] + box["height"] <= SIZES[390], name


def test_with_reduced_motion_the_world_waits_for_play(servers, watch):
    watched = watch(servers["live"], reduced_motion="reduce")
    watched.until("hedon.frame")
    assert watched.get("[hedon.playing, hedon.source.last]") == [False, 0]
    watched.page.locator("#play").click()
    watched.until("hedon.source.last > 0")


def test_the_theme_is_remembered_on_other_ports(servers, watch):
    """Each `hedon view` has its own port."""
    watched = watch(servers["live"])
    watched.page.locator("#theme").click()
    assert watched.get("document.documentElement.dataset.theme") == "dark"
    other = watched.page.context.new_page()
    other.goto(servers["replay"])
    assert other.evaluate("document.documentElement.dataset.theme") == "dark"
    other.close()


def test_what_happens_is_announced(servers, watch):
    watched = watch(servers["live"])
    rest(watched)
    watched.until("document.querySelector('#said').textContent.startsWith('Agent ')")
    watched.get("hedon.play(true)")
    watched.get("hedon.play(false)")
    said = watched.page.locator("#said").text_content()
    assert said.startswith("Paused at step ")
    assert said.endswith(" agents")


def test_each_picture_has_a_name_before_it_is_drawn(watch):
    with serving(live_server("baseline")) as server:
        watched = watch(server.link)
        names = watched.get("[...document.querySelectorAll('[role=img]')].map((each) => each.ariaLabel)")
        assert len(names) > 4
        assert all(names)
