"""The scene in which a feeling evolves: a guess by pointer, finger and keyboard, and worlds that match Python."""

import re

import numpy as np
import pytest
from story_page import native, stage
from view_page import sized

from hedon import Simulation, load_config
from hedon.view.story import SCENES

pytest_plugins = ("view_fixture", "story_fixture")

EVOLVE = stage("evolve")
ANSWER = "document.querySelector('#evolve-answer').textContent"
READY = "document.querySelector('#evolve-run').ariaDisabled === 'false'"
LINK = "document.querySelector('#evolve .permalink').href"
CENTER = "document.querySelector('#evolve-plot').scrollIntoView({ block: 'center', behavior: 'instant' })"
SHORT = 1024  # steps after which a test ends a world


def end_early(watched):
    """Ends the running world at its next update, as if it had reached the right end of the plot."""
    watched.until(f"{EVOLVE}.live.last >= {SHORT}")
    watched.get(f"{EVOLVE}.stop()")


def test_a_guess_is_drawn_by_pointer_and_by_keys_before_the_world_runs(article):
    watched = article("evolve")
    watched.get(CENTER)
    assert not watched.get(READY)
    box = watched.page.locator("#evolve-plot").bounding_box()
    watched.page.mouse.move(box["x"] + 50, box["y"] + 100)
    watched.page.mouse.down()
    watched.page.mouse.move(box["x"] + box["width"] - 11, box["y"] + 60, steps=10)
    watched.page.mouse.up()
    watched.until(READY)
    assert watched.get(ANSWER) == "Now watch."
    watched.until(f"{LINK}.includes('guess=')")
    address = watched.get(f"new URL({LINK}).hash")
    other = article("evolve", address)
    other.until(READY)
    other.get(f"{EVOLVE}.reset()")
    other.until(f"{ANSWER} === 'Draw first.'")
    other.page.locator("#evolve-plot").focus()
    for _ in range(41):
        other.page.keyboard.press("ArrowRight")
    other.until(READY)
    other.get("document.querySelector('#evolve-plot').scrollIntoView({ behavior: 'instant', block: 'start' })")
    top = "document.querySelector('#evolve .view').getBoundingClientRect().top"
    assert other.get(top) < 0
    other.get("document.querySelector('#evolve-run').click()")
    other.until(f"{top} > -1 && {EVOLVE}.live.last > 0")


def test_a_finger_draws_and_scrolls_over_the_result(article):
    watched = article("evolve", **sized(390))
    watched.get(CENTER)
    plot = watched.page.locator("#evolve-plot")
    box = plot.bounding_box()
    fingers = watched.page.context.new_cdp_session(watched.page)
    level = box["y"] + 100

    def touch(kind, *places):
        points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)]
        fingers.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})

    touch("Start", (box["x"] + 50, level))
    touch("Move", (box["x"] + 150, level))
    touch("Start", (box["x"] + 150, level), (box["x"] + 250, level + 60))
    touch("Move", (box["x"] + 150, level), (box["x"] + 260, level + 60))
    touch("Move", (box["x"] + box["width"] - 10, level), (box["x"] + 260, level + 60))
    touch("End")
    watched.until(READY)
    watched.until(f"{LINK}.includes('guess=')")
    (values,) = (each.split("_") for each in re.findall(r"guess=([^&]+)", watched.get(LINK)))
    assert len(set(values[1:])) == 1, "the second finger draws nothing"
    watched.page.locator("#evolve-run").click()
    end_early(watched)
    watched.until(f"{ANSWER}.startsWith('You drew')")
    watched.get(CENTER)
    before, box = watched.get("scrollY"), plot.bounding_box()
    touch("Start", (box["x"] + 200, box["y"] + 200))
    for moved in range(10, 101, 10):
        touch("Move", (box["x"] + 200, box["y"] + 200 - moved))
    touch("End")
    watched.until(f"scrollY > {before} + 40")
    assert values == re.findall(r"guess=([^&]+)", watched.get(LINK))[0].split("_"), "it stays as it was drawn"


def test_its_lines_match_python_with_and_without_learning(article):
    watched = article("evolve", "#scene=evolve&seed=1&step=0&guess=0_0_0_0_0_0_0_0_0_0_0.5")
    watched.until(READY)
    watched.page.locator("#evolve-run").click()
    end_early(watched)
    watched.until(f"{EVOLVE}.courses().length === 1 && {EVOLVE}.live.digest()")
    watched.page.locator("#evolve-learner").click()
    end_early(watched)
    watched.until(f"{EVOLVE}.courses().length === 2 && {EVOLVE}.live.digest()")
    courses = watched.get(f"{EVOLVE}.courses()")
    assert [each["learns"] for each in courses] == [True, False]
    last = watched.get(f"{EVOLVE}.live.last")
    same = native(watched, "evolve", "evolve", last, "learning.learning_rate=0")
    assert watched.get(f"{EVOLVE}.live.digest()") == same.digest()
    for course in courses:
        step = course["step"][-1]
        changes = [] if course["learns"] else ["learning.learning_rate=0"]
        genome = native(watched, "evolve", "evolve", step, *changes).agents()["genome"]
        np.testing.assert_allclose(course["feeling"][-1], genome[:, 0].mean(), rtol=1e-6)
        np.testing.assert_allclose([each[-1] for each in course["neutral"]], genome[:, 2:].mean(axis=0), rtol=1e-5)
    assert re.search(r"^Where nobody could learn, the mean went from .0\.\d\d to ", watched.get(ANSWER))
    assert watched.page.locator("#evolve-learner").is_enabled()


@pytest.mark.long
def test_worlds_end_as_the_text_says():
    config = load_config(SCENES / "evolve.toml")
    ends = {}
    for learns in (True, False):
        changed = config if learns else config.with_("learning.learning_rate", 0.0)
        simulation = Simulation(changed, seeds=range(1, 9))
        simulation.run(12_288)
        ends[learns] = [world.agents()["genome"] for world in simulation.worlds]
    beyond = dict.fromkeys(ends, 0)
    for learns, genomes in ends.items():
        for feeling, _, *idle in (genome.mean(axis=0) for genome in genomes):
            beyond[learns] += abs(feeling) > max(map(abs, idle))
            assert not learns or 0.195 <= feeling <= 0.5
    assert beyond[True] == 8
    assert beyond[False] <= 2, "one in nine by chance"
    left = {learns: sum(map(len, genomes)) for learns, genomes in ends.items()}
    assert 0.28 < left[False] / left[True] < 0.4, "a third as many"
