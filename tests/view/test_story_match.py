"""A reader plays the contest to its end; then the score, the table, the picture and the link agree."""

import re

import pytest
from story_page import native, stage
from view_page import numbers, sized

pytest_plugins = ("view_fixture", "story_fixture")

CONTEST = stage("contest")
SCORE = "document.querySelector('#contest-score').textContent"
MEAL, MOVING = "species.you.reward.meal_coef", "species.you.genome.action.initial_mean"
STEPS = 20480


def slide(watched, path, value):
    """Drags a slider of the contest from 0 to a value."""
    knob = watched.page.locator(f'#contest input[data-path="{path}"]')
    knob.scroll_into_view_if_needed()
    box, thumb = knob.bounding_box(), 16
    y = box["y"] + box["height"] / 2
    watched.page.mouse.move(box["x"] + box["width"] / 2, y)
    watched.page.mouse.down()
    watched.page.mouse.move(box["x"] + thumb / 2 + (value + 8) / 16 * (box["width"] - thumb), y, steps=5)
    watched.page.mouse.up()
    assert float(knob.input_value()) == value


def written(watched):
    """The texts in the picture that the button saves."""
    watched.get(
        """(() => {
          window.written = [];
          const { prototype } = CanvasRenderingContext2D;
          const { fillText } = prototype;
          prototype.fillText = function (text, ...where) {
            if (!this.canvas.isConnected) written.push([text, where[0] + this.measureText(text).width]);
            fillText.call(this, text, ...where);
          };
        })()"""
    )
    with watched.page.expect_download():
        watched.page.locator("#contest-picture").click()
    texts = watched.get("written")
    assert all(right < 1200 for _, right in texts), "nothing is cut off"
    return [text for text, _ in texts]


def won(ends):
    return sum(end["you"] > end["evolution"] for end in ends), sum(end["you"] < end["evolution"] for end in ends)


@pytest.mark.long
@pytest.mark.parametrize(("width", "ground", "worlds"), [(1400, "light", 5), (390, "dark", 1), (1024, "dark", 1)])
def test_a_reader_plays_to_the_end_and_the_score_is_the_same_everywhere(width, ground, worlds, article):
    watched = article("contest", **sized(width, ground))
    slide(watched, MEAL, 4)
    slide(watched, MOVING, -4)
    watched.page.locator("#contest-one").click()
    watched.until(f"{CONTEST}.live.last > 500 && {SCORE}.startsWith('World 1, step ')")
    view, score = (watched.page.locator(f"#contest {each}").bounding_box() for each in (".view", "#contest-score"))
    assert view["y"] > -1, "the arena and the score are on the screen"
    assert score["y"] + score["height"] < watched.page.viewport_size["height"] + 1
    assert re.search(r": you have \d+ descendants, evolution \d+\. $", watched.get(SCORE))
    watched.until(f"{SCORE}.endsWith('One world may be luck.')", 900)
    if worlds > 1:
        watched.page.locator("#contest-more").click()
        watched.until(f"{SCORE}.startsWith('World {worlds}: ')", 3000)
    ends = watched.get(f"{CONTEST}.results()")
    assert [end["seed"] for end in ends] == [*range(1, worlds + 1)]
    mine, its = won(ends)
    assert mine > its, "the texts below are for a reader who wins"
    assert numbers(watched.get(SCORE))[:5] == [worlds, ends[-1]["you"], ends[-1]["evolution"], mine, its]
    assert f"You beat evolution {mine} : {its}" in watched.get(SCORE)
    cells = watched.page.locator("#contest tbody td").all_inner_texts()
    assert cells == [str(end[name]) for end in ends for name in ("seed", "you", "evolution")]
    head, about, foot = written(watched)
    assert head == f"I beat evolution {mine} : {its}"
    assert about.endswith("a meal feels like 4 and moving like \N{MINUS SIGN}4.")
    assert foot == "Where do rewards come from? ", "no one else can open an address on this machine"
    watched.until(f"{CONTEST}.live.digest()")
    watched.page.locator("#contest .permalink").click()
    watched.until("location.hash.includes('&digest=')")
    link = watched.get("location.hash")
    same = native(watched, "contest", "contest", STEPS, f"{MEAL}=4", f"{MOVING}=-4", seed=worlds)
    earlier = f"&worlds={worlds}" if worlds > 1 else ""
    assert link.startswith(f"#scene=contest&seed={worlds}&step={STEPS}{earlier}&species.you.reward")
    assert link.endswith(f"&digest={same.digest()[:8]}")


@pytest.mark.long
def test_a_link_to_several_worlds_plays_all_of_them(article):
    changes = [f"{MEAL}=-8", f"{MOVING}=8"]
    link = f"#scene=contest&seed=3&step=600&worlds=2&{'&'.join(changes)}"
    watched = article("contest", link)
    watched.until(f"{SCORE}.startsWith('World 2, step ')")
    assert watched.page.locator("#contest-more").is_disabled()
    watched.until("hedon.opened !== ''", 900)
    [end] = watched.get(f"{CONTEST}.results()")
    agents = native(watched, "contest", "contest", STEPS, *changes, seed=2).agents()
    assert end["seed"] == 2
    assert (end["you"] > 0) >= (agents["species"] == 0).any()
    same = native(watched, "contest", "contest", 600, *changes, seed=3)
    assert watched.get(f"{CONTEST}.live.digest()") == same.digest()
    assert watched.get(f"[{CONTEST}.seed, {CONTEST}.live.last, {CONTEST}.notes.get('worlds')]") == [3, 600, "2"]
