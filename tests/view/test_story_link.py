"""The page reports links to the article that are damaged, or that lead to a different world than before."""

import pytest
from story_page import stage
from view_page import sized

pytest_plugins = ("view_fixture", "story_fixture")

NOTICE = "document.querySelector('#notice')"
DAMAGED = {
    "scene=family&seed=abc&step=5": "it has seed=abc",
    "scene=family&seed=1&step=3OO": "it has step=3OO",
    "scene=family&seed=1&step=-5": "it has step=-5",
    "scene=family&seed=1": "it has no step",
    "scene=family&step=5": "it has no seed",
    "scene=family&seed=1&seed=2&step=5": "it has seed twice",
    "scene=family&seed=1&step=5&agnet=3": "nothing in it is called agnet",
    "scene=family&seed=1&step=5&agent=99999": "this world has no creature 99999",
    "scene=family&seed=1&step=5&digest=c": "it has digest=c",
    "scene=creature&seed=1&step=5&steer=f3x2": "it has steer=f3x2",
    "scene=creature&seed=1&step=5&genome.action.initial_me": "genome.action.initial_me: is no setting",
    "scene=sandbox&seed=1&step=5&world=atlantis": "the world 'atlantis': there are predators, poison",
    "scene=sandbox&seed=1&step=5&world=toString": "the world 'toString': there are predators",
    "scene=contest&seed=1&step=0&worlds=0": "it has worlds=0",
    "scene=evolve&seed=1&step=0&guess=1_2": "it has guess=1_2",
    "scene=constructor&seed=1&step=0": "the scene 'constructor': there are creature",
}


def told(watched, address):
    """The text of the notice after an address is opened."""
    watched.get(f"({NOTICE}.hidden = true, location.hash = '#{address}')")
    watched.until(f"!{NOTICE}.hidden")
    return watched.get(f"{NOTICE}.querySelector('span').textContent")


@pytest.mark.long
def test_a_damaged_link_is_reported_as_damaged(article):
    watched = article("creature")
    for address, words in DAMAGED.items():
        text = told(watched, address)
        assert text.startswith("The link is damaged: "), address
        assert words in text, address


def test_a_link_to_another_world_is_reported(article):
    watched = article("family", "#scene=family&seed=1&step=5")
    watched.until("hedon.opened !== ''")
    digest = watched.get(f"{stage('family')}.live.digest()")[:8]
    for seed, letters in ((2, digest), (1, digest.translate(str.maketrans("0123456789abcdef", "123456789abcdef0")))):
        text = told(watched, f"scene=family&seed={seed}&step=5&digest={letters}")
        assert text.startswith(f"This is not the world of the link, whose letters are {letters}")
    watched.get(f"(location.hash = '#scene=family&seed=1&step=5&agent=7&digest={digest}')")
    watched.until("hedon.opened.includes('agent=7')")
    watched.until("document.querySelector('#family .digest').textContent.includes('as in the link')")
    assert watched.get(f"{NOTICE}.hidden")


def test_a_guess_in_a_link_stays_on_its_plot(article):
    watched = article("evolve", "#scene=evolve&seed=1&step=0&guess=1000000000_-99_0.5_0.5_0.5_0.5_0.5_0.5_0.5_0.5_0.5")
    watched.until("hedon.opened !== ''")
    assert watched.get(f"{NOTICE}.hidden")
    watched.until("document.querySelector('#evolve .permalink').href.includes('guess=1.00_-1.00_0.50_0.50')")


@pytest.mark.parametrize("width", [1400, 1024])
def test_a_notice_hides_neither_the_heading_nor_the_arena(width, article):
    still = {"viewport": {"width": width, "height": 768}, "reduced_motion": "reduce"}
    watched = article("contest", "#scene=contest&seed=1&step=5&digest=00000000", **still)
    watched.until(f"!{NOTICE}.hidden")
    notice = watched.page.locator("#notice").bounding_box()
    for part in ("h2", ".view"):
        hidden = watched.page.locator(f"#contest {part}").bounding_box()
        beside = notice["x"] >= hidden["x"] + hidden["width"] or hidden["x"] >= notice["x"] + notice["width"]
        assert beside or notice["y"] >= hidden["y"] + hidden["height"], part
    assert notice["x"] >= watched.page.locator("#contest .words").bounding_box()["x"] - 8


@pytest.mark.parametrize("width", [1400, 390])
def test_a_link_and_its_digest_are_shown_together(width, article):
    watched = article("family", "#scene=family&seed=1&step=5&digest=00000000", **sized(width))
    watched.until("document.querySelector('#family .digest').textContent.includes('in the link')")
    names = ["#family .permalink", "#family .digest"]
    link, letters = watched.get(
        f"""{names}.map((each) => {{
          const {{ left, right, top, bottom }} = document.querySelector(each).getBoundingClientRect();
          return {{ left, right, middle: (top + bottom) / 2 }};
        }})"""
    )
    assert letters["left"] > link["right"]
    assert abs(letters["middle"] - link["middle"]) < 6


def test_no_scene_is_wider_than_a_small_phone(article):
    watched = article("family", viewport={"width": 320, "height": 640})
    assert watched.get("document.documentElement.scrollWidth") == 320


@pytest.mark.parametrize("ground", ["light", "dark"])
def test_a_ring_of_a_predator_differs_from_its_disc_however_full_it_is(ground, article):
    watched = article("sandbox", **sized(1400, ground))
    watched.until(f"{stage('sandbox')}.frame")
    ring, full = watched.get(
        f"""(() => {{
          const {{ arena, live, frame, camera }} = {stage("sandbox")};
          const {{ scene }} = arena;
          const {{ disc }} = scene;
          const [rings, discs] = [[], []];
          scene.disc = (...given) => ((given[6] ?? 0) > 0 ? rings : discs).push(given[3]);
          arena.draw(live, frame, {{ ...camera.coloring, value: () => 1e9 }}, -1);
          scene.disc = disc;
          return [rings[0], discs[discs.length - 1]].map((color) => [0, 8, 16].map((bits) => (color >> bits) & 255));
        }})()"""
    )
    assert sum(abs(a - b) for a, b in zip(ring, full, strict=True)) > 200
