"""Scripts act as readers of the article: goals are reached, and the engine in Python gives the same bits."""

import numpy as np
import pytest
from story_page import address_of, backend, click_agent, native, opened, run_to, set_knob, stage

import hedon.env
from hedon import load_config
from hedon.demography.life import birth_rate, hazard
from hedon.view.story import SCENES

pytest_plugins = ("view_fixture", "story_fixture")


def test_a_reader_steers_to_five_meals_and_the_link_has_the_same_bits(article):
    watched = article("creature")
    creature = stage("creature")
    watched.until(f"{creature}.playing && {creature}.live.last > 3 && {creature}.frame")  # it drives itself
    box = watched.page.locator("#creature canvas.world")
    box.focus()
    watched.page.keyboard.down("ArrowUp")
    watched.until(f"{creature}.life()?.eaten[0] > 0 && {creature}.track().startsWith('f')")
    watched.page.keyboard.up("ArrowUp")
    assert watched.get(f"{creature}.live.last") < 200, "a reader who takes over begins a new world, facing food"
    begun = watched.get(f"{creature}.life().eaten[0]")
    for _ in range(40):  # hold the pointer on the nearest food until it is eaten
        place = watched.get(
            f"""(() => {{
              const {{ frame, arena }} = {creature};
              const away = (i) => Math.hypot(frame.foodX[i] - frame.x[0], frame.foodY[i] - frame.y[0]);
              const best = [...frame.foodX.keys()].sort((a, b) => away(a) - away(b))[0];
              return arena.scene.toPage(frame.foodX[best], frame.foodY[best]);
            }})()"""
        )
        watched.page.mouse.move(*place)
        watched.page.mouse.down()
        eaten = watched.get(f"{creature}.life().eaten[0]")
        watched.until(f"{creature}.life().eaten[0] > {eaten} || {creature}.live.last % 40 === 0")
        watched.page.mouse.up()
        if watched.get(f"{creature}.life().eaten[0]") >= 5:
            break
    watched.until("document.querySelector('#creature-meals').classList.contains('reached')")
    assert watched.get(f"{creature}.life().eaten[0]") > begun
    watched.get(f"{creature}.setPlaying(false)")
    address = address_of(watched, "creature")
    digest, step = watched.get(f"[{creature}.live.digest(), {creature}.live.last]")
    track, commands = watched.get(f"[{creature}.track(), {creature}.commands]")
    assert steered(watched, track, commands, step) == digest
    other = opened(article, "creature", address)
    assert other.get(f"[{creature}.live.digest(), {creature}.live.last]") == [digest, step]


def steered(watched, track, commands, steps):
    """The digest in Python after the same commands and the same number of steps."""
    seed = watched.get(f"{stage('creature')}.seed")
    worlds = hedon.make(SCENES / "creature.toml", seed=seed, actions="logit", backend=backend(watched, "creature"))
    done, at = 0, 0
    while at < len(track):
        end = at + 1
        while end < len(track) and track[end].isdigit():
            end += 1
        worlds.actions[...] = np.array(commands[track[at]], np.float32)
        for _ in range(int(track[at + 1 : end])):
            worlds.step(worlds.actions)
            done += 1
        at = end
    assert done == steps
    return worlds.simulation.worlds[0].digest()


@pytest.mark.long
def test_reward_rises_without_a_meal_if_moving_feels_good(article):
    watched = article("creature")
    set_knob(watched, "creature", "genome.action.initial_mean", "5")
    texts = (
        "[...document.querySelectorAll('#creature [data-of=\"genome.action.initial_mean\"]')].map((x) => x.textContent)"
    )
    assert set(watched.get(texts)) == {"5"}
    watched.page.locator("#creature canvas.world").focus()
    watched.page.keyboard.down("ArrowLeft")
    watched.until(f"{stage('creature')}.live.last > 40")
    watched.page.keyboard.up("ArrowLeft")
    watched.get(f"{stage('creature')}.setPlaying(false)")
    life = watched.get(f"{stage('creature')}.life()")
    assert life["eaten"] == [0]
    assert life["reward"] > 0.5
    assert life["energy"] < 40
    watched.page.locator("#creature input[value=yes]").check()
    watched.until("!document.querySelector('#creature .answer').hidden")
    watched.page.locator("#creature").get_by_role("button", name="Reset").click()
    watched.until(f"{stage('creature')}.changes.size === 0 && {stage('creature')}.live.last === 0")
    assert watched.get(texts) == ["0"]


@pytest.mark.long
def test_it_learns_to_eat_more_and_to_sit_still_if_moving_feels_bad(article):
    watched = article("learning")
    learning = stage("learning")
    watched.page.locator("#learning-run").click()
    watched.until(f"{learning}.live.last >= 81920", 400)
    watched.until("document.querySelector('#learning .answer').textContent.includes('times as many')")
    before, after = watched.get(f"[{learning}.rate(0, 5), {learning}.rate(75, 80)]")
    assert after > 5 * max(before, 1)
    pace = watched.get(f"{learning}.pace()")
    watched.get(f"{learning}.setPlaying(false)")
    watched.page.locator("#learning-sit").click()
    watched.until(f"{learning}.changes.size === 1 && {learning}.live.ready && {learning}.live.last === 0")
    run_to(watched, "learning", 20480)
    assert watched.get(f"{learning}.pace()") < pace / 4
    same = native(watched, "learning", "learning", 20480, "genome.action.initial_mean=-10")
    assert watched.get(f"{learning}.live.digest()") == same.digest()
    opened(article, "learning", address_of(watched, "learning"))


def test_deaths_and_births_are_marked_where_they_happen_and_counted(article):
    """With costly steps founders starve; the page counts and marks the same births and deaths as Python."""
    dear = "energy.basic_cost=0.02"
    watched = article("family")
    family = stage("family")
    watched.get(f"{family}.setPlaying(false)")
    set_knob(watched, "family", "energy.basic_cost", "0.02")
    run_to(watched, "family", 1100)
    watched.until(f"{family}.live.ready && {family}.live.last === 1100")
    agents = native(watched, "family", "family", 1100, dear).agents()
    born = watched.get(f"[...{family}.live.lives.all()].filter(({{ parent }}) => parent >= 0).length")
    died = watched.get(f"[...{family}.live.lives.all()].filter(({{ death }}) => death >= 0).length")
    assert died > 0
    assert 80 + born - died == len(agents["agent_id"])
    assert max(agents["agent_id"]) < 80 + born, "ids continue after those of the founders"
    founders = watched.get(
        f"[...{family}.live.lives.all()].filter(({{ parent, death }}) => parent < 0 && death < 0).length"
    )
    assert founders == sum(agents["parent_id"] < 0)
    told = f"{len(agents['agent_id'])} alive; so far {born} were born and {died} died."
    watched.until(f"document.querySelector('#family-count').textContent === '{told}'")
    marked = watched.get(f"[{family}.marks.deaths, {family}.marks.births]")
    assert all(1100 - 300 <= each["step"] <= 1100 for part in marked for each in part)
    recent = {int(i) for i, step in zip(agents["agent_id"], agents["birth_step"], strict=True) if step >= 800}
    assert {each["child"] for each in marked[1]} >= recent
    parents = dict(zip(agents["agent_id"].tolist(), agents["parent_id"].tolist(), strict=True))
    assert all(parents.get(each["child"], each["parent"]) == each["parent"] for each in marked[1])


def test_the_curves_of_hazard_and_birth_rate_match_the_model(article):
    watched = article("family")
    config = load_config(SCENES / "family.toml")
    species = next(iter(config.species.values()))
    energy = np.array([0.0, 3.0, 10.0, 40.0])
    drawn = watched.get(f"{energy.tolist()}.map((e) => {stage('family')}.curve.hazard({stage('family')}, e, 1000))")
    assert drawn == pytest.approx(hazard(species.hazard, np.full(4, 1000.0), energy), rel=1e-12)
    drawn = watched.get(f"{energy.tolist()}.map((e) => {stage('family')}.curve.birth({stage('family')}, e))")
    assert drawn == pytest.approx(birth_rate(species.birth, energy), rel=1e-12)


def test_a_creature_glows_when_it_is_rewarded_and_the_second_slider_waits(article):
    watched = article("creature")
    creature = stage("creature")
    assert watched.get("document.querySelector('#creature-moving').hidden")
    watched.get(
        """(() => {
          const { prototype } = CanvasRenderingContext2D;
          const { createRadialGradient } = prototype;
          window.glows = 0;
          prototype.createRadialGradient = function (...given) {
            glows++;
            return createRadialGradient.apply(this, given);
          };
        })()"""
    )
    watched.until(f"{creature}.life()?.eaten[0] > 0 && glows > 0")
    watched.page.locator("#creature input[value=yes]").check()
    watched.until("!document.querySelector('#creature-moving').hidden")


@pytest.mark.long
def test_colors_show_feelings_and_children_inherit_them(article):
    watched = article("family")
    watched.get(f"{stage('family')}.setPlaying(false)")
    run_to(watched, "family", 400)
    pairs = watched.get(f"{stage('family')}.pairs().map(([child, parent]) => [child.genome[0], parent.genome[0]])")
    assert len(pairs) > 3
    child, parent = np.array(pairs).T
    assert np.median(np.abs(child - parent)) < 0.1 * np.std(parent)
    some = watched.get(f"{stage('family')}.pairs()[0][0].id")
    click_agent(watched, some)
    watched.until(f"document.querySelector('#family-card').textContent.includes('Creature {some}')")
    watched.until("document.querySelector('#family-card').textContent.includes('nothing that the parent had learned')")
    colors = watched.get(
        f"""(() => {{
          const {{ frame, live, camera }} = {stage("family")};
          const lives = [...frame.id].map((id) => live.lives.get(id));
          return lives.map((life, i) => [life.genome[0], camera.coloring.value(life, frame, i)]);
        }})()"""
    )
    assert len(colors) > 60
    assert all(feeling == shown for feeling, shown in colors)
    watched.page.locator("#family input[value=skill]").check()
    watched.until("document.querySelector('#family .answer').textContent.startsWith('Only what feels good')")
    address = address_of(watched, "family")
    assert watched.get(f"{stage('family')}.live.digest()") == native(watched, "family", "family", 400).digest()
    other = opened(article, "family", address)
    assert other.get(f"{stage('family')}.chosen") == some


@pytest.mark.long
def test_a_wrong_link_says_what_is_wrong(article):
    watched = article("creature", "#scene=creature&seed=1&step=3&birth.kappa=7")
    watched.until("document.querySelector('#notice').textContent.includes('birth.kappa = 7: must be')")
    other = article("creature", "#scene=nowhere")
    notice = other.page.locator("#notice")
    other.until("document.querySelector('#notice').textContent.includes(\"the scene 'nowhere': there are creature\")")
    notice.get_by_role("button", name="Close").click()
    assert notice.is_hidden()
    other.get("document.querySelector('#sandbox').scrollIntoView({ behavior: 'instant' })")
    other.get("(location.hash = '#scene=elsewhere')")
    other.until("!document.querySelector('#notice').hidden")
    box = notice.bounding_box()
    assert 0 <= box["y"] < other.page.viewport_size["height"] - box["height"], "it is visible where the reader is"
    other.get("(location.hash = '#scene=sandbox')")
    other.until("document.querySelector('#notice').hidden")
