"""A reader of the article may do things in any order: before an arena is seen, in mid-run, or with another link."""

import re

import pytest
from story_page import run_to, set_knob, stage

pytest_plugins = ("view_fixture", "story_fixture")

LOW = {"viewport": {"width": 390, "height": 420}, "has_touch": True}
"""A screen on which a scene's words leave no room for its arena."""


def scroll_to(watched, shown, where):
    """Scrolls an element to the start, the center or the end of the screen."""
    watched.get(f"document.querySelector('{shown}').scrollIntoView({{ block: '{where}', behavior: 'instant' }})")


def unseen(article, scene, shown):
    """A page with an element of a scene on the screen, whose arena has never been on it."""
    watched = article("creature", **LOW)
    scroll_to(watched, shown, "end")
    watched.until(f"{stage(scene)}.live?.ready")
    assert not watched.get(f"{stage(scene)}.seen")
    return watched


@pytest.mark.parametrize(
    ("scene", "button", "told"),
    [
        ("learning", "#learning-run", "Learning: round "),
        ("contest", "#contest-one", "Begin"),
    ],
)
def test_a_world_runs_and_says_so_though_its_arena_was_never_seen(scene, button, told, article):
    watched = unseen(article, scene, button)
    assert not watched.get(f"{stage(scene)}.pictures")
    watched.page.locator(button).tap()
    watched.until(f"{stage(scene)}.live.last > 0")
    watched.until(f"document.querySelector('{button}').textContent.startsWith('{told}')")
    if scene == "contest":
        assert watched.page.locator(button).is_disabled()
        watched.until("document.querySelector('#contest-score').textContent.startsWith('World 1, step ')")
        watched.until(f"{stage(scene)}.seen")  # the page scrolls there
    else:
        assert not watched.get(f"{stage(scene)}.pictures")


def test_four_more_worlds_cannot_be_asked_for_before_the_first(article):
    watched = article("creature")
    assert not watched.get(f"{stage('contest')}.live")
    assert watched.page.locator("#contest-more").is_disabled()


def test_a_guess_is_answered_and_a_chart_is_drawn_while_the_arena_is_out_of_sight(article):
    watched = unseen(article, "learning", "#learning .guess")
    scroll_to(watched, "#creature .guess", "end")
    watched.page.locator("#creature input[value=yes]").check()
    watched.until("!document.querySelector('#creature .answer').hidden")
    chart = "document.querySelector('#contest-map')"
    scroll_to(watched, "#contest h2", "end")
    watched.until(f"{stage('contest')}.live?.ready")
    watched.get(f"{stage('contest')}.results().push({{ seed: 1, you: 3, evolution: 5 }})")  # shows the map
    watched.page.locator("#contest-map").wait_for(state="visible")
    scroll_to(watched, "#contest-map", "end")
    drawn = f"{chart}.getContext('2d').getImageData(0, 0, {chart}.width, {chart}.height).data.join()"
    watched.until(f"{stage('contest')}.live?.ready && {chart}.width === {chart}.clientWidth && {drawn}.match(/[1-9]/)")
    assert not watched.get(f"{stage('contest')}.seen")
    before = watched.get(drawn)
    set_knob(watched, "contest", "species.you.reward.meal_coef", "7")
    watched.until(f"{drawn} !== {before!r}")
    assert not watched.get(f"{stage('contest')}.pictures")


def test_a_scene_that_moves_by_itself_does_so_even_if_its_words_came_first(article):
    watched = unseen(article, "sandbox", "#sandbox h2")
    scroll_to(watched, "#sandbox .view", "center")
    watched.until(f"{stage('sandbox')}.live.last > 3")


def rests(watched, scene):
    """Whether the world of a scene stays where it is while the page keeps drawing."""
    at = f"[{stage(scene)}.running, {stage(scene)}.playing, {stage(scene)}.live.last]"
    before = watched.get(at)
    drawn = watched.get("hedon.pictures")
    watched.until(f"hedon.pictures > {drawn} + 15")
    return before[:2] == [False, False] and watched.get(at) == before


@pytest.mark.long
def test_starting_another_world_ends_the_learning_of_the_previous_one(article):
    watched = article("learning")
    learning = stage("learning")
    section = watched.page.locator("#learning")

    def learn():
        section.locator("#learning-run").click()
        watched.until(f"{learning}.running && {learning}.live.last > 0")

    learn()
    watched.get("(location.hash = '#scene=learning&seed=2&step=300')")
    watched.until(f"{learning}.seed === 2 && {learning}.live.last === 300 && !{learning}.running")
    assert rests(watched, "learning")
    for begin in (section.locator("#learning-sit"), section.get_by_role("button", name="Reset")):
        learn()
        begin.click()
        watched.until(f"{learning}.live.ready && {learning}.live.last === 0")
        assert rests(watched, "learning")
    learn()
    set_knob(watched, "learning", "food.normal.gene.initial_mean", "2")
    assert rests(watched, "learning")


def test_a_link_that_is_refused_changes_nothing(article):
    watched = article("contest")
    [meal, moving] = (f"species.you.{name}" for name in ("reward.meal_coef", "genome.action.initial_mean"))
    set_knob(watched, "contest", meal, "7")
    live = f"{stage('contest')}.live"
    watched.get(f"void (window.before = {live})")
    watched.get(f"(location.hash = '#scene=contest&seed=1&step=5&{meal}=2&{moving}=x')")
    watched.until("!document.querySelector('#notice').hidden")
    knobs = watched.get("[...document.querySelectorAll('#contest input[data-path]')].map((knob) => knob.value)")
    assert knobs == ["7", "0"]
    assert watched.get(f"[...{stage('contest')}.changes].join()") == f"{meal},7"
    assert watched.get(f"before === {live}")


HINT = "document.querySelector('#creature .hint')"
STEER = "f3l2" * 4000
"""Commands for 20,000 steps, so that a reader can act before they are done."""


def replayed(article):
    """A page in the middle of replaying a link with many commands."""
    watched = article("creature")
    watched.get(f"(location.hash = '#scene=creature&seed=1&step=20000&steer={STEER}')")
    creature = stage("creature")
    watched.until(f"{creature}.running && {creature}.live.last > 20 && {HINT}.innerText.startsWith('It does again')")
    return watched


def test_a_steered_link_is_replayed_at_once_and_with_the_same_commands(article):
    watched = article("creature")
    drawn = watched.get("hedon.pictures")
    steer = STEER[: 4 * 240]
    watched.get(f"(location.hash = '#scene=creature&seed=1&step=1200&steer={steer}')")
    watched.until(f"{stage('creature')}.live.last === 1200 && !{stage('creature')}.running")
    assert watched.get("hedon.pictures") - drawn < 480, "fewer pictures than commands"
    assert watched.get(f"{stage('creature')}.track()") == steer


def test_reset_ends_the_replay_of_a_link(article):
    watched = replayed(article)
    watched.page.locator("#creature").get_by_role("button", name="Reset").click()
    watched.until(f"{stage('creature')}.live.ready && {stage('creature')}.live.last === 0")
    assert rests(watched, "creature")
    assert watched.get(f"{stage('creature')}.track()") == ""


def test_a_reader_who_steers_continues_from_where_the_replay_is(article):
    watched = replayed(article)
    watched.page.keyboard.down("ArrowDown")
    watched.until(f"{stage('creature')}.track().includes('b')")
    watched.page.keyboard.up("ArrowDown")
    assert not watched.get(f"{stage('creature')}.running")
    done = re.findall(r"[a-z.]\d+", watched.get(f"{stage('creature')}.track()").split("b")[0])
    assert len(done) > 8
    assert STEER.startswith("".join(done[:-1])), "the last one may be cut short"
    watched.until(f"{HINT}.hidden")


def test_the_button_ends_a_run_of_any_length(article):
    watched = article("creature")
    watched.get("(location.hash = '#scene=creature&seed=1&step=999999999999999')")
    watched.until(f"{stage('creature')}.running && {stage('creature')}.live.last > 20")
    watched.page.locator("#creature").get_by_role("button", name="Pause").click()
    watched.until("document.querySelector('#creature .bar .main').textContent === 'Play'")
    watched.until(f"{stage('creature')}.live.digest()")
    assert rests(watched, "creature")


@pytest.mark.parametrize("used", ["Play", *(pytest.param(used, marks=pytest.mark.long) for used in ("Reset", "link"))])
def test_arrow_keys_steer_after_a_click_on_a_button(used, article):
    watched = article("creature")
    creature = stage("creature")
    watched.get(f"{creature}.setPlaying(false)")
    watched.page.locator("#creature .bar").get_by_text(used, exact=True).click()
    watched.until("document.activeElement === document.body")
    watched.page.keyboard.down("ArrowLeft")
    watched.until(f"{creature}.playing && {creature}.track().includes('l')")
    watched.page.keyboard.up("ArrowLeft")


def test_after_its_stroll_it_waits_and_says_so(article):
    watched = article("creature")
    creature = stage("creature")
    run_to(watched, "creature", 1501)
    watched.page.locator("#creature").get_by_role("button", name="Play").click()
    watched.until(f"!{creature}.playing && {HINT}.innerText.startsWith('It waits for you')")
    watched.page.locator("#creature").get_by_role("button", name="Play").click()
    watched.until(f"{creature}.playing && {creature}.live.last > 1504")


def test_after_a_slider_it_waits_for_the_reader(article):
    watched = article("creature")
    creature = stage("creature")
    watched.until(f"{creature}.playing && {creature}.live.last > 3")
    set_knob(watched, "creature", "genome.action.initial_mean", "5")
    watched.until(f"{HINT}.innerText.startsWith('It waits for you')")
    assert rests(watched, "creature")
    watched.page.keyboard.down("ArrowLeft")
    watched.until(f"{creature}.playing && {creature}.live.last > 3 && {HINT}.hidden")
    watched.page.keyboard.up("ArrowLeft")


def test_only_the_main_button_of_a_mouse_steers(article):
    watched = article("creature")
    watched.until(f"{stage('creature')}.playing && {stage('creature')}.live.last > 3")
    watched.get(f"void (window.before = {stage('creature')}.live)")
    watched.page.locator("#creature canvas.world").click(button="right")
    watched.until(f"{stage('creature')}.live.last > 8")
    assert watched.get(f"before === {stage('creature')}.live")
    assert watched.get(f"{HINT}.innerText.startsWith('It drives itself')")


@pytest.mark.parametrize("how", ["click", pytest.param("key", marks=pytest.mark.long)])
def test_a_guess_may_be_the_number_already_on_the_slider(how, article):
    watched = article("learning")
    slider = watched.page.locator("#learning .guess input")
    if how == "click":
        box = slider.bounding_box()
        slider.click(position={"x": 8 + (box["width"] - 16) * 4 / 39, "y": box["height"] / 2})
    else:
        slider.press("Enter")
    assert slider.input_value() == "5"
    rounds = "Array.from({ length: 80 }, (_, i) => ({ step: 1024 * (i + 1), meals: [i] }))"
    watched.get(f"{stage('learning')}.onMoment({{ frame: {{ step: 0 }}, ends: {rounds}, trace: [] }})")
    watched.until("document.querySelector('#learning .answer').textContent.includes('You guessed 5 times')")


def test_a_button_that_was_pressed_by_a_key_keeps_the_focus(article):
    watched = article("learning")
    button = watched.page.locator("#learning-run")
    button.press("Enter")
    watched.until("document.querySelector('#learning-run').textContent.startsWith('Learning: round ')")
    assert button.get_attribute("aria-disabled") == "true"
    assert watched.get("document.activeElement.id") == "learning-run"
    watched.page.keyboard.press("Enter")
    assert watched.get(f"[{stage('learning')}.seed, {stage('learning')}.aim]") == [1, 80 * 1024]


@pytest.mark.long
def test_a_link_interrupted_by_another_world_does_not_choose_its_agent(article):
    watched = article("family")
    family = stage("family")
    watched.get("(location.hash = '#scene=family&seed=1&step=900000&agent=5')")
    watched.until(f"{family}.running && {family}.live.last > 0")
    watched.page.locator("#family").get_by_role("button", name="Reset").click()
    assert rests(watched, "family")
    assert watched.get(f"{family}.chosen") == 39


def test_in_a_hidden_tab_a_run_to_its_end_continues_and_a_playing_world_rests(article):
    watched = article("family")
    watched.until(f"{stage('family')}.playing && {stage('family')}.live.last > 0")
    watched.get(f"void {stage('learning')}.runTo(3000)")
    watched.get(
        """(() => {
          window.requestAnimationFrame = () => 0; // a hidden tab has no pictures
          Object.defineProperty(document, "hidden", { get: () => true });
          document.dispatchEvent(new Event("visibilitychange"));
        })()"""
    )
    pictures, plays = watched.get(f"[hedon.pictures, {stage('family')}.live.last]")
    watched.until(f"!{stage('learning')}.running")
    assert watched.get(f"{stage('learning')}.live.last") == 3000
    after, played = watched.get(f"[hedon.pictures, {stage('family')}.live.last]")
    assert after <= pictures + 1
    assert played <= plays + 4, "one request to the engine may have been under way"
