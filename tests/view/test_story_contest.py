"""Scripts act as readers in the article's last scenes, the contest and the sandbox."""

import re

import numpy as np
import pytest
from story_page import address_of, native, opened, run_to, set_knob, stage

from hedon import load_config
from hedon.view.story import SCENES

pytest_plugins = ("view_fixture", "story_fixture")

SCORE = "document.querySelector('#contest-score').textContent"
KNOBS = "[...document.querySelectorAll('#contest input[data-path]')].map((knob) => knob.value)"
BAD = {"species.you.reward.meal_coef": "-8", "species.you.genome.action.initial_mean": "0"}


def test_a_contest_is_counted_and_its_link_carries_choice_and_seed(article):
    watched = article("contest")
    for path, value in BAD.items():
        set_knob(watched, "contest", path, value)
    run_to(watched, "contest", 100)
    address = address_of(watched, "contest")
    same = native(watched, "contest", "contest", 100, *(f"{path}={value}" for path, value in BAD.items()))
    assert watched.get(f"{stage('contest')}.live.digest()") == same.digest()
    other = opened(article, "contest", address)
    assert other.get(KNOBS) == list(BAD.values())
    chances = f"[[5, 5], [0, 3], [3, 4]].map((each) => {stage('contest')}.luck(...each))"
    assert watched.get(chances) == [1 / 32, 1, 5 / 16]


def test_the_worlds_of_a_contest_are_listed_in_a_table_and_compared_with_a_coin(article):
    watched = article("contest")
    ends = [(1, 3, 5), (2, 9, 1), (3, 4, 4), (4, 7, 2)]
    for seed, yours, its in ends:
        watched.get(f"{stage('contest')}.results().push({{ seed: {seed}, you: {yours}, evolution: {its} }})")
    watched.until(
        f"{SCORE}.endsWith('You beat evolution 2 : 1, with 1 draw. A coin does as well or better in 50 of 100 tries.')"
    )
    with watched.page.expect_download() as waiting:
        watched.page.locator("#contest-picture").click()
    picture = waiting.value.path().read_bytes()
    assert [int.from_bytes(picture[at : at + 4], "big") for at in (16, 20)] == [1200, 630]
    cells = watched.get("[...document.querySelectorAll('#contest tbody td')].map((cell) => cell.textContent)")
    assert cells == [str(value) for end in ends for value in end]
    rings = f"""(() => {{
      const {{ arena, live, frame, camera }} = {stage("contest")};
      let drawn = 0;
      const {{ scene }} = arena;
      const disc = scene.disc;
      scene.disc = (...given) => (drawn += (given[6] ?? 0) > 0 ? 1 : 0);
      arena.draw(live, frame, camera.coloring, -1);
      scene.disc = disc;
      return [drawn, frame.species.length];
    }})()"""
    watched.until(f"{stage('contest')}.frame")
    drawn, agents = watched.get(rings)
    assert (drawn, agents) == (0, 32), "a ring would make one side look larger"


def rests(watched, name):
    """Whether the world of a scene stays at its first step while the page keeps drawing."""
    watched.until(f"{stage(name)}.live.ready")
    drawn = watched.get("hedon.pictures")
    watched.until(f"hedon.pictures > {drawn} + 15")
    return watched.get(f"[{stage(name)}.running, {stage(name)}.live.last]") == [False, 0]


@pytest.mark.long
def test_reset_and_sliders_end_a_running_contest_and_another_may_begin(article):
    watched = article("contest")
    begin = watched.page.locator("#contest-one")
    reset = watched.page.locator("#contest").get_by_role("button", name="Reset")
    begin.click()
    watched.until(f"{stage('contest')}.live.last > 100 && {SCORE}.startsWith('World 1, step ')")
    set_knob(watched, "contest", "species.you.reward.meal_coef", "-8")
    assert rests(watched, "contest")
    watched.get(f"{stage('contest')}.results().push({{ seed: 1, you: 3, evolution: 5 }})")
    watched.page.locator("#contest-more").click()
    watched.until(f"{stage('contest')}.live.last > 100")
    reset.click()
    assert rests(watched, "contest")
    watched.until(f"{SCORE} === 'No world yet.'")
    assert watched.get(KNOBS) == ["0", "0"]
    begin.click()
    watched.until(f"{stage('contest')}.live.last > 100 && {SCORE}.includes('of 20,480: you have ')")


@pytest.mark.long
def test_a_contest_plays_only_worlds_that_count(article):
    watched = article("contest", "#scene=contest&seed=1&step=20800")
    play = watched.page.locator("#contest").get_by_role("button", name=re.compile("Play|Pause"))
    assert play.count() == 0, "it would run past the end, or play a world that is never counted"
    assert watched.get(f"{stage('contest')}.play.hidden")
    assert watched.page.locator("#contest-more").is_disabled()
    watched.page.locator("#contest-one").click()
    assert watched.page.locator("#contest-one").is_disabled(), "at once"


def test_the_lines_of_a_contest_stay_on_their_plot(article):
    watched = article("contest")
    watched.until(f"{stage('contest')}.live.last === 0 && {stage('contest')}.frame")
    ends = watched.get(
        """(() => {
          const { stage } = hedon.scenes.contest;
          const canvas = document.querySelector("#contest-lines");
          const drawn = [];
          const { prototype } = CanvasRenderingContext2D;
          const { lineTo } = prototype;
          prototype.lineTo = function (x, y) {
            if (this.canvas === canvas) drawn.push(x);
            lineTo.call(this, x, y);
          };
          stage.onMoment({ frame: { step: 40960 } });
          stage.live.last = 40960;
          stage.onWords();
          prototype.lineTo = lineTo;
          return [Math.max(...drawn), canvas.clientWidth];
        })()"""
    )
    assert 0.9 * ends[1] < ends[0] < ends[1]


@pytest.mark.long
def test_a_link_of_a_contest_shows_its_feelings_while_its_world_runs(article):
    watched = article("contest", "#scene=contest&seed=3&step=9000&species.you.reward.meal_coef=-8")
    watched.until(f"{SCORE}.startsWith('World 3, step') && {SCORE}.includes('of 9,000: you have ')")
    assert watched.get(KNOBS) == ["-8", "0"]
    assert watched.get(f"{stage('contest')}.live.last") < 9000
    watched.page.locator("#contest").get_by_role("button", name="Reset").click()
    assert rests(watched, "contest")


def reveal_map(watched):
    """Gives the contest a first result, after which the page shows the map."""
    assert watched.page.locator("#contest-map").is_hidden(), "the reader guesses first"
    watched.get(f"{stage('contest')}.results().push({{ seed: 1, you: 3, evolution: 5 }})")
    watched.page.locator("#contest-map").wait_for(state="visible")


TEXTS = """((meal, moving) => {
  const { stage } = hedon.scenes.contest;
  stage.set(["species.you.reward.meal_coef"], String(meal));
  stage.set(["species.you.genome.action.initial_mean"], String(moving));
  const { prototype } = CanvasRenderingContext2D;
  const { fillText } = prototype;
  const found = {};
  prototype.fillText = function (words, x, y) {
    const { width } = this.measureText(words);
    const left = this.textAlign === "right" ? x - width : x;
    if (this.canvas.id === "contest-map") found[words] = [left, y - 11, left + width, y + 2];
    fillText.call(this, words, x, y);
  };
  stage.onWords();
  prototype.fillText = fillText;
  const { clientWidth, clientHeight } = document.querySelector("#contest-map");
  return [found.you, found.evolution, [46, 10, clientWidth - 10, clientHeight - 34], Object.keys(found)];
})"""


def test_the_names_on_the_map_stay_inside_and_apart(article):
    watched = article("contest")
    watched.until(f"{stage('contest')}.live.last === 0 && {stage('contest')}.frame")
    reveal_map(watched)
    for meal, moving in ((-8, 8), (8, 8), (-8, -8), (8, -8), (2, 0), (-1.5, 0.5), (0.5, 0)):
        you, evolution, axes, words = watched.get(f"{TEXTS}({meal}, {moving})")
        for left, top, right, bottom in (you, evolution):
            assert axes[0] <= left < right <= axes[2], (meal, moving)
            assert axes[1] <= top < bottom <= axes[3], (meal, moving)
        apart = you[0] > evolution[2] or you[2] < evolution[0] or you[1] > evolution[3] or you[3] < evolution[1]
        assert apart, (meal, moving)
        assert {"8", "\N{MINUS SIGN}8"} <= set(words), "the axes end where the sliders do"


@pytest.mark.long
def test_bad_feelings_lose_to_evolution(article):
    watched = article("contest")
    for path, value in BAD.items():
        set_knob(watched, "contest", path, value)
    watched.page.locator("#contest-one").click()
    watched.until(f"{stage('contest')}.results().length === 1", 900)
    [end] = watched.get(f"{stage('contest')}.results()")
    assert end["you"] < end["evolution"]
    watched.until("document.querySelector('#contest-score').textContent.includes('Evolution beat you 1 : 0')")
    same = native(watched, "contest", "contest", 20480, *(f"{path}={value}" for path, value in BAD.items()))
    assert watched.get(f"{stage('contest')}.live.digest()") == same.digest()


def test_the_score_counts_descendants_and_a_press_on_the_map_plays(article):
    watched = article("contest")
    watched.until(f"{stage('contest')}.live.last === 0 && {stage('contest')}.frame")
    reveal_map(watched)
    box = watched.page.locator("#contest-map").bounding_box()
    spot = {"x": box["width"] - 40, "y": box["height"] - 60}
    watched.page.locator("#contest-map").click(position=spot)
    watched.until(f"{SCORE}.startsWith('World 1, step ') && {stage('contest')}.live.last > 0")
    meal, moving = map(float, watched.get(KNOBS))
    assert meal > 5
    assert moving < -5
    changes = [f"species.you.reward.meal_coef={meal}", f"species.you.genome.action.initial_mean={moving}"]
    watched.page.locator("#contest").get_by_role("button", name="Reset").click()
    assert watched.page.locator("#contest-map").is_hidden()
    for change in changes:
        set_knob(watched, "contest", *change.split("="))
    run_to(watched, "contest", 3000)
    agents = native(watched, "contest", "contest", 3000, *changes).agents()
    lives = watched.get(
        f"[...{stage('contest')}.live.lives.all()].map((life) => [life.parent, life.species, life.death])"
    )
    for side in (0, 1):
        living = sum(species == side and death < 0 for _, species, death in lives)
        assert living == sum(agents["species"] == side)
    born = [sum(species == side and parent >= 0 for parent, species, _ in lives) for side in (0, 1)]
    assert min(born) > 0
    assert watched.get(f"{stage('contest')}.course().at(-1)") == [3000, *born]


@pytest.mark.parametrize(
    "world", ["poison", *(pytest.param(name, marks=pytest.mark.long) for name in ("predators", "seasons", "pitfalls"))]
)
def test_the_worlds_of_the_sandbox_match_python(world, article):
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
        set_knob(watched, "sandbox", "food.normal.gene.initial_mean", "3")
        watched.page.locator("#sandbox-color").select_option("food")
        run_to(watched, "sandbox", 30)
        shown = f"""[...{sandbox}.frame.id].map((id, i) =>
          {sandbox}.camera.coloring.value({sandbox}.life(id), {sandbox}.frame, i))"""
        assert min(watched.get(shown)) > 2, "the color is the feeling of founders about food, with a spread of 0.1"
        other = opened(article, "sandbox", address_of(watched, "sandbox"))
        assert other.get(f"{sandbox}.value('food.poison.gives.energy')") == -2
        assert other.get("document.querySelector('#sandbox-color').value") == "food"
        with other.page.expect_download() as waiting:
            other.page.locator("#sandbox-picture").click()
        picture = waiting.value.path().read_bytes()
        assert picture.startswith(b"\x89PNG")
        assert int.from_bytes(picture[16:20], "big") >= 1600, "it can be printed"
        other.until("document.querySelector('#sandbox canvas.world').width < 1600")


def test_the_chart_of_the_sandbox_begins_with_the_world_and_counts_food_and_every_species(article):
    watched = article("sandbox")
    sandbox = stage("sandbox")
    watched.until(f"{sandbox}.course().length > 1")
    assert watched.get(f"{sandbox}.course()[0]") == [0, 60, 50, 6]
    watched.until(f"{sandbox}.live.last > 40")
    knobs = watched.get(
        "[...document.querySelectorAll('#sandbox [data-world=predators] input')].map((each) => each.dataset.path)"
    )
    both = ("species.prey.genome.action.initial_mean", "species.predator.genome.action.initial_mean")
    assert knobs[2:] == ["food.normal.gene.initial_mean", " ".join(both)]
    steps = watched.get(f"{sandbox}.course().map(([step]) => step)")
    assert len(steps) > 2
    assert min(np.diff(steps)) >= 16
    watched.page.locator("button[data-world=seasons]").click()
    watched.until(f"{sandbox}.world.name === 'seasons' && {sandbox}.course()[0]?.length === 3")
    caption = watched.get("document.querySelector('#sandbox figcaption').textContent")
    assert "redator" not in caption, "this world has no predators"
    colors = watched.get("getComputedStyle(document.querySelector('#sandbox-scale')).backgroundImage")
    assert colors.index("rgb(61, 111, 216)") < colors.index("rgb(196, 120, 0)"), "blue means little energy, amber much"


def test_the_link_of_a_playing_world_has_a_digest_too(article):
    watched = article("sandbox")
    sandbox = stage("sandbox")
    watched.until(f"{sandbox}.playing && {sandbox}.live.last > 10")
    watched.page.locator("#sandbox .permalink").click()
    watched.until("location.hash.includes('&digest=')")
    step, digest = watched.get(f"[{sandbox}.live.last, {sandbox}.live.digest()]")
    assert f"&step={step}&" in watched.get("location.hash")
    assert watched.get("location.hash").endswith(digest[:8])
    assert watched.get("document.querySelector('#sandbox .how').textContent").startswith("The same world on a command")


@pytest.mark.parametrize(("scene", "button"), [("contest", "contest-one"), ("sandbox", "sandbox-video")])
def test_a_button_works_before_its_arena_was_on_the_screen(scene, button, article):
    watched = article("creature", reduced_motion="reduce")  # far above both
    assert watched.get(f"{stage(scene)}.live === undefined || {stage(scene)}.live === null")
    watched.get(f"document.getElementById('{button}').click()")
    watched.until(f"{stage(scene)}.live?.ready")
    if scene == "contest":
        watched.until(f"{stage(scene)}.live.last > 0")


def test_a_button_that_waits_keeps_the_focus(article):
    scene, button = "contest", "contest-one"
    watched = article(scene)
    watched.page.locator(f"#{button}").focus()
    watched.page.keyboard.press("Enter")
    watched.until(f"document.getElementById('{button}').matches(':disabled, [aria-disabled=true]')")
    seed = watched.get(f"{stage(scene)}.seed")
    watched.page.keyboard.press("Enter")
    assert watched.get(f"[document.activeElement.id, {stage(scene)}.seed]") == [button, seed]
    watched.until(f"{stage(scene)}.live.last > 0")
