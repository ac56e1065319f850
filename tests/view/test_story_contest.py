"""What a reader does in the article's last scenes, by script: the contest, the guess that is drawn, and the sandbox."""

import pytest
from story_page import address_of, native, opened, run_to, set_knob, stage

from hedon import load_config
from hedon.view.story import SCENES

pytest_plugins = ("view_fixture", "story_fixture")

BAD = {"species.blue.reward.meal_coef": "-8", "species.blue.genome.action.initial_mean": "0"}


def test_a_contest_is_counted_and_its_link_carries_choice_and_seed(article):
    watched = article("contest")
    for path, value in BAD.items():
        set_knob(watched, "contest", path, value)
    run_to(watched, "contest", 100)
    address = address_of(watched, "contest")
    same = native(watched, "contest", "contest", 100, *(f"{path}={value}" for path, value in BAD.items()))
    assert watched.get(f"{stage('contest')}.live.digest()") == same.digest()
    other = opened(article, "contest", address)
    values = "[...document.querySelectorAll('#contest input[data-path]')].map((knob) => knob.value)"
    assert other.get(values) == list(BAD.values())
    chances = f"[[5, 5], [0, 3], [3, 4]].map((each) => {stage('contest')}.luck(...each))"
    assert watched.get(chances) == [1 / 32, 1, 5 / 16]
    watched.get(f"{stage('contest')}.results().push([3, 5], [9, 1], [4, 4], [7, 2])")
    watched.until("document.querySelector('#contest-score').textContent.includes('You win 2 of 3 worlds')")
    watched.until("document.querySelector('#contest-score').textContent.includes('as well or better by luck in 50 of')")


@pytest.mark.long
def test_bad_feelings_lose_to_evolution(article):
    watched = article("contest")
    for path, value in BAD.items():
        set_knob(watched, "contest", path, value)
    watched.page.locator("#contest-one").click()
    watched.until(f"{stage('contest')}.results().length === 1", 900)
    [[blue, orange]] = watched.get(f"{stage('contest')}.results()")
    assert blue < orange
    watched.until("document.querySelector('#contest-score').textContent.includes('evolution wins')")
    watched.until("!document.querySelector('#contest-map').hidden")
    same = native(watched, "contest", "contest", 20480, *(f"{path}={value}" for path, value in BAD.items()))
    assert watched.get(f"{stage('contest')}.live.digest()") == same.digest()


def test_a_guess_is_drawn_before_the_answer_by_pointer_and_by_keys(article):
    watched = article("chance")
    plot = watched.page.locator("#chance-plot")
    assert watched.page.locator("#chance-real").is_disabled()
    box = plot.bounding_box()
    watched.page.mouse.move(box["x"] + 50, box["y"] + 100)
    watched.page.mouse.down()
    watched.page.mouse.move(box["x"] + box["width"] - 11, box["y"] + 200, steps=10)
    watched.page.mouse.up()
    watched.until("!document.querySelector('#chance-real').disabled")
    address = watched.get("new URL(document.querySelector('#chance-link').href).hash")
    watched.page.locator("#chance-real").click()
    watched.until("document.querySelector('#chance-answer').textContent.includes('ended at 0.5')")
    watched.page.locator("#chance-drift").click()
    watched.until(
        "/Of 16 genes that do nothing, \\d+ ended/.test(document.querySelector('#chance-answer').textContent)"
    )
    other = article("chance", address)
    other.until("!document.querySelector('#chance-real').disabled")
    other.page.locator("#chance-reset").click()
    other.page.locator("#chance-plot").focus()
    for _ in range(51):
        other.page.keyboard.press("ArrowRight")
    other.until("!document.querySelector('#chance-real').disabled")


@pytest.mark.parametrize("world", ["predators", "poison", "seasons", "pitfalls"])
def test_the_sandbox_has_worlds_that_are_those_of_python(world, article):
    watched = article("sandbox")
    sandbox = stage("sandbox")
    watched.page.locator(f"button[data-world={world}]").click()
    watched.until(f"{sandbox}.world.name === '{world}' && {sandbox}.live.ready && {sandbox}.live.last > 0")
    watched.get(f"{sandbox}.setPlaying(false)")
    run_to(watched, "sandbox", 60)
    step = watched.get(f"{sandbox}.live.last")
    assert watched.get(f"{sandbox}.live.digest()") == native(watched, "sandbox", world, step).digest()
    if world == "poison":
        set_knob(watched, "sandbox", "food.poison.gives.energy", "-2")
        with watched.page.expect_download() as waiting:
            watched.page.locator("#sandbox-config").click()
        taken = load_config(str(waiting.value.path()))
        assert taken.food == load_config(SCENES / "poison.toml", overrides=["food.poison.gives.energy=-2"]).food
        run_to(watched, "sandbox", 30)
        other = opened(article, "sandbox", address_of(watched, "sandbox"))
        assert other.get(f"{sandbox}.value('food.poison.gives.energy')") == -2
        with other.page.expect_download() as waiting:
            other.page.locator("#sandbox-picture").click()
        assert waiting.value.path().read_bytes().startswith(b"\x89PNG")
