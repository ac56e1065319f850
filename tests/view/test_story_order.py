"""A reader of the article does things in any order: before an arena is seen, in the middle of a run, with another link."""

import pytest
from story_page import set_knob, stage

pytest_plugins = ("view_fixture", "story_fixture")

LOW = {"viewport": {"width": 390, "height": 420}, "has_touch": True}
"""A screen on which a scene's words leave no place for its arena."""


def scroll_to(watched, shown, where):
    """Puts an element at the start, the center or the end of the screen."""
    watched.get(f"document.querySelector('{shown}').scrollIntoView({{ block: '{where}', behavior: 'instant' }})")


def unseen(article, scene, shown):
    """A reader who has an element of a scene on the screen, but never had its arena."""
    watched = article("creature", **LOW)
    scroll_to(watched, shown, "end")
    watched.until(f"{stage(scene)}.live?.ready")
    assert not watched.get(f"{stage(scene)}.seen")
    return watched


@pytest.mark.parametrize(
    ("scene", "button", "told"),
    [
        ("learning", "#learning-run", "Learning: round "),
        ("life", "#life-many", "Life 1 of 20: stop"),
        ("contest", "#contest-one", "Begin"),
    ],
)
def test_a_world_runs_and_tells_so_though_its_arena_was_never_seen(scene, button, told, article):
    watched = unseen(article, scene, button)
    assert not watched.get(f"{stage(scene)}.pictures")
    watched.page.locator(button).tap()
    watched.until(f"{stage(scene)}.live.last > 0")
    watched.until(f"document.querySelector('{button}').textContent.startsWith('{told}')")
    if scene == "contest":
        assert watched.page.locator(button).is_disabled()
        watched.until("document.querySelector('#contest-score').textContent.startsWith('World of seed 1: step ')")
    assert not watched.get(f"{stage(scene)}.pictures")


def test_four_more_worlds_cannot_be_asked_for_before_the_first(article):
    watched = article("creature")
    assert not watched.get(f"{stage('contest')}.live")
    assert watched.page.locator("#contest-more").is_disabled()


def test_a_guess_is_answered_and_a_chart_is_drawn_beside_an_arena_out_of_sight(article):
    watched = unseen(article, "learning", "#learning .guess")
    scroll_to(watched, "#creature .guess", "end")
    watched.page.locator("#creature input[value=yes]").check()
    watched.until("!document.querySelector('#creature .answer').hidden")
    chart = "document.querySelector('#life-curves')"
    scroll_to(watched, "#life-curves", "start")
    drawn = f"{chart}.getContext('2d').getImageData(0, 0, {chart}.width, {chart}.height).data.join()"
    watched.until(f"{stage('life')}.live?.ready && {chart}.width === {chart}.clientWidth && {drawn}.match(/[1-9]/)")
    assert not watched.get(f"{stage('life')}.seen")
    before = watched.get(drawn)
    set_knob(watched, "life", "birth.kappa", "0.002")
    watched.until(f"{drawn} !== {before!r}")
    assert not watched.get(f"{stage('life')}.pictures")


def test_a_scene_that_moves_by_itself_does_so_also_if_its_words_came_first(article):
    watched = unseen(article, "sandbox", "#sandbox h2")
    scroll_to(watched, "#sandbox .view", "center")
    watched.until(f"{stage('sandbox')}.live.last > 3")


def rests(watched, scene):
    """Whether the world of a scene stays where it is while the page goes on."""
    at = f"[{stage(scene)}.running, {stage(scene)}.playing, {stage(scene)}.live.last]"
    before = watched.get(at)
    drawn = watched.get("hedon.pictures")
    watched.until(f"hedon.pictures > {drawn} + 15")
    return before[:2] == [False, False] and watched.get(at) == before


def test_what_begins_another_world_ends_the_learning_of_the_one_before(article):
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
    [meal, moving] = (f"species.blue.{name}" for name in ("reward.meal_coef", "genome.action.initial_mean"))
    set_knob(watched, "contest", meal, "7")
    live = f"{stage('contest')}.live"
    watched.get(f"void (window.before = {live})")
    watched.get(f"(location.hash = '#scene=contest&seed=1&step=5&{meal}=2&{moving}=x')")
    watched.until("!document.querySelector('#notice').hidden")
    knobs = watched.get("[...document.querySelectorAll('#contest input[data-path]')].map((knob) => knob.value)")
    assert knobs == ["7", "5"]
    assert watched.get(f"[...{stage('contest')}.changes].join()") == f"{meal},7"
    assert watched.get(f"before === {live}")
