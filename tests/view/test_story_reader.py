"""Scenes 1 to 3 of the article report and count what happens, however a reader goes through them."""

import re

import numpy as np
import pytest
from story_page import backend, click_agent, native, run_to, stage
from view_page import sized

from hedon import Simulation, load_config
from hedon.view.story import SCENES

pytest_plugins = ("view_fixture", "story_fixture")

WINDOW = 1024
ROUNDS = 80


@pytest.mark.long
def test_meals_are_counted_at_the_ends_of_rounds_however_fast_the_machine_is(article):
    """All steps in one request, as on an infinitely fast machine: the engine in Python gives the same numbers."""
    watched = article("learning")
    learning = stage("learning")
    watched.page.locator("#learning .guess input").fill("7")
    steps = ROUNDS * WINDOW
    watched.until(f"{learning}.live.advance({steps}, 1e6, {{ trace: true }})")
    simulation = Simulation(load_config(SCENES / "learning.toml"), seeds=[1], backend=backend(watched, "learning"))
    eaten, places = [0], []
    while (step := simulation.worlds[0].step) < steps:
        part = 1 if step < 500 or step >= steps - 500 else min(WINDOW - step % WINDOW, steps - 500 - step)
        simulation.run(part)
        agents = simulation.worlds[0].agents()
        if part == 1:
            places.append((agents["x"][0], agents["y"][0]))
        if simulation.worlds[0].step % WINDOW == 0:
            eaten.append(int(agents["eaten"].sum()))
    watched.until(f"{learning}.live.last >= {steps}", 200)
    shown = watched.get(f"Array.from({{ length: {ROUNDS} }}, (_, i) => {learning}.rate(i, i + 1))")
    assert shown == pytest.approx(1000 * np.diff(eaten) / WINDOW)
    assert min(shown[ROUNDS // 2 :]) > 0, "one that has learned eats in each round"
    early, late = (np.hypot(*np.diff(part, axis=0).T).mean() for part in (places[:500], places[500:]))
    before, after = eaten[5], eaten[ROUNDS] - eaten[ROUNDS - 5]
    times = f"{after / before:.0f} times as many"
    watched.until("!document.querySelector('#learning .answer').hidden")
    assert watched.get("document.querySelector('#learning .answer').textContent") == (
        f"It ate {before} meals in its first 5 rounds and {after} meals in its last 5: {times}. "
        f"You guessed 7 times. It moves {late:.2f} units per step, at first {early:.2f}."
    )


@pytest.mark.long
def test_a_creature_that_moving_hurts_differs_in_nothing_else(article):
    watched = article("learning")
    learning = stage("learning")
    watched.page.locator("#learning-sit").click()
    watched.until(f"[...{learning}.changes].join() === 'genome.action.initial_mean,-10'")
    watched.until(f"{learning}.live.ready && {learning}.live.last === 0")
    watched.until(f"{learning}.live.advance({ROUNDS * WINDOW}, 1e6, {{ trace: true }})")
    watched.until("!document.querySelector('#learning .answer').hidden", 200)
    told = watched.get("document.querySelector('#learning .answer').textContent")
    late, early = (float(number) for number in re.findall(r"\d\.\d\d", told))
    assert 0.4 < late / early < 0.7, "about half as much as at first"
    assert watched.get(f"{learning}.rate(75, 80)") < 0.5, "hardly eats"


def test_it_strolls_by_itself_and_says_how_to_take_over(article):
    watched = article("creature")
    creature = stage("creature")
    hint = watched.page.locator("#creature .hint")
    watched.until(f"{creature}.live.last > 3 && {creature}.frame && !document.querySelector('#creature .hint').hidden")
    assert "drives itself" in hint.inner_text()
    assert "to take over" in hint.inner_text()
    watched.page.keyboard.press("ArrowUp")
    watched.until("document.querySelector('#creature .hint').hidden")


@pytest.mark.parametrize("ground", ["light", "dark"])
def test_rays_have_the_colors_that_the_caption_names(ground, article):
    watched = article("creature", **sized(1400, ground))
    watched.get(
        f"""(() => {{
          const {{ scene }} = {stage("creature")}.arena;
          const disc = scene.disc.bind(scene);
          window.ends = new Set();
          scene.disc = (x, y, radius, color, ...form) => {{
            if (radius < 2) ends.add([0, 8, 16].map((bits) => (color >> bits) & 255).join());
            disc(x, y, radius, color, ...form);
          }};
        }})()"""
    )
    watched.until("ends.size === 2")
    colors = [tuple(map(int, end.split(","))) for end in watched.get("[...ends]")]
    gray, green = sorted(colors, key=lambda color: max(color) - min(color))
    assert max(gray) - min(gray) < 30
    assert green[1] > max(green[0], green[2]) + 30
    assert "green at food, gray at walls" in watched.page.locator("#creature figcaption").inner_text()


@pytest.mark.long
def test_arrow_keys_steer_after_a_click_on_a_guess_or_a_slider(article):
    watched = article("creature")
    creature = stage("creature")
    no = watched.page.locator("#creature input[value=no]")
    slider = watched.page.locator("#creature input[type=range]").last
    for used in (no, watched.page.locator("#creature .guess label").last, slider):
        used.click(position={"x": 12, "y": 9})
        watched.until("document.activeElement === document.body")
        watched.get(f"{creature}.setPlaying(false)")
        before = [no.is_checked(), slider.input_value()]
        watched.page.keyboard.down("ArrowLeft")
        watched.until(f"{creature}.playing && {creature}.track().includes('l')")
        watched.page.keyboard.up("ArrowLeft")
        assert [no.is_checked(), slider.input_value()] == before
        watched.page.locator("#creature").get_by_role("button", name="Reset").click()
    slider.focus()
    watched.page.keyboard.press("ArrowRight")
    assert slider.input_value() == "0.5", "with keyboard focus, arrow keys move the slider"


@pytest.mark.parametrize("width", [1400, 390])
def test_sliders_stay_on_the_screen_with_the_arena(width, article):
    watched = article("creature", **sized(width))
    watched.page.locator("#creature input[value=yes]").check()
    watched.until("!document.querySelector('#creature .answer').hidden")
    for name, seen in (("creature", ".view"), ("learning", ".view")):
        arena = watched.page.locator(f"#{name} {seen}").bounding_box()
        knobs = watched.page.locator(f"#{name} .knobs").bounding_box()
        assert knobs["y"] > arena["y"] + arena["height"], f"{name}: the sliders come first, so no answer moves them"
        assert knobs["y"] + knobs["height"] - arena["y"] < 844, name
    section = watched.page.locator("#creature").bounding_box()
    knobs = watched.page.locator("#creature .knobs").bounding_box()
    assert width < 800 or knobs["y"] + knobs["height"] - section["y"] < 900


def drawn(watched, chart):
    """Starts to record what a chart writes, and the colors of its last picture in their order."""
    watched.get(
        f"""(() => {{
          const ink = document.getElementById("{chart}").getContext("2d");
          const own = (name) => ink[name].bind(ink);
          const [fill, fillText, setTransform] = [own("fill"), own("fillText"), own("setTransform")];
          const noted = window.drawn = {{ words: new Set(), colors: [], last: [] }};
          ink.fill = () => (noted.colors.push(ink.fillStyle), fill());
          ink.fillText = (text, ...where) => (noted.words.add(text), fillText(text, ...where));
          ink.setTransform = (...all) => ([noted.last, noted.colors] = [noted.colors, []], setTransform(...all));
        }})()"""
    )


def test_n_cycles_through_living_children_wherever_the_focus_is(article):
    watched = article("family")
    family = stage("family")
    watched.get(f"{family}.setPlaying(false)")
    run_to(watched, "family", 400)
    watched.until(f"{family}.frame.step === 400 && !document.querySelector('#family-next').disabled")
    agents = native(watched, "family", "family", 400).agents()
    expected = sorted(int(i) for i in agents["agent_id"][agents["parent_id"] >= 0])
    assert len(expected) > 5
    watched.get(f"{family}.choose(0)")
    seen = []
    for step in range(len(expected)):
        watched.page.keyboard.press("n") if step % 2 else watched.page.locator("#family-next").click()
        seen.append(watched.get(f"{family}.chosen"))
    assert seen == expected
    watched.page.keyboard.press("n")
    assert watched.get(f"{family}.chosen") == expected[0]


def test_the_card_shows_meals_and_age_of_child_and_parent_even_if_dead(article):
    watched = article("family")
    family = stage("family")
    watched.get(f"{family}.setPlaying(false)")
    run_to(watched, "family", 1100)
    card = watched.page.locator("#family-card")
    child, parent = watched.get(
        f"""{family}.pairs().filter(([child, parent]) => child.death < 0 && parent.death < 0)
          .map(([child, parent]) => [child.id, parent.id])[0]"""
    )
    agents = native(watched, "family", "family", 1100).agents()

    def lived(some):
        [at] = np.flatnonzero(agents["agent_id"] == some)
        eaten, age = int(agents["eaten"][at].sum()), 1100 - int(agents["birth_step"][at])
        return f"{eaten} meal{'' if eaten == 1 else 's'} in {age:,} steps of life"

    number = watched.page.locator("#family-number")
    number.fill(str(child))
    number.press("Enter")
    watched.until(f"document.querySelector('#family-card').textContent.startsWith('Creature {child}:')")
    own, its_parent = card.locator("p").all_inner_texts()[:2]
    assert lived(child) in own
    assert its_parent.startswith(f"Its parent, {parent}:")
    assert lived(parent) in its_parent
    dead = watched.get(f"[...{family}.live.lives.all()].find((life) => life.death >= 0).id")
    number.fill(str(dead))
    number.press("Enter")
    watched.until(f"document.querySelector('#family-card').textContent.startsWith('Creature {dead} (dead):')")
    number.fill("99999")
    number.press("Enter")
    assert number.input_value() == str(dead), "no creature has that number yet"


@pytest.mark.long
def test_dots_of_kin_are_drawn_above_the_others(article):
    watched = article("family")
    family = stage("family")
    watched.get(f"{family}.setPlaying(false)")
    run_to(watched, "family", 400)
    watched.get(f"{family}.choose({family}.pairs()[0][0].id)")
    drawn(watched, "family-dots")
    watched.until("drawn.last.length > 3")
    colors = watched.get("drawn.last")
    kin = watched.get("getComputedStyle(document.documentElement).getPropertyValue('--kin').trim()")
    assert 0 < colors.count(kin) < len(colors)
    assert kin not in colors[: -colors.count(kin)]


def test_a_click_on_empty_ground_clears_the_card(article):
    watched = article("family")
    family = stage("family")
    watched.get(f"{family}.setPlaying(false)")
    watched.until("document.querySelector('#family-card').textContent.startsWith('Creature 39')")
    click_agent(watched, 5)
    watched.until("document.querySelector('#family-card').textContent.startsWith('Creature 5:')")
    box = watched.page.locator("#family canvas.world").bounding_box()
    watched.page.mouse.click(box["x"] + 3, box["y"] + 3)
    watched.until("document.querySelector('#family-card').textContent.startsWith('Click or tap a creature')")
    assert watched.page.locator("#family-number").input_value() == ""


def test_on_a_phone_the_card_is_under_the_arena_and_no_key_is_named(article):
    watched = article("family", **sized(390))
    arena, card, chart = (
        watched.page.locator(f"#family {each}").bounding_box() for each in (".view", ".card", "#family-dots")
    )
    assert arena["y"] + arena["height"] < card["y"] < chart["y"]
    assert card["y"] + card["height"] - arena["y"] < 844
    assert watched.page.locator("#family-next").inner_text() == "Next child"
    assert "arrow keys" not in watched.page.locator("#creature .words").inner_text()
