"""What you can do with a live world in the page: edit it, return to a snapshot, save files, and run at any speed."""

import polars as pl
import pytest
from view_page import live_server, serving

from hedon import Simulation, load_config

pytest_plugins = ("view_fixture",)


@pytest.fixture(scope="module")
def server():
    with serving(live_server("small")) as running:
        yield running


@pytest.fixture
def world(server, watch):
    """A page with a world paused at step 200, or later if the page was faster than the test."""
    watched = watch(server.link)
    rest(watched, 200)
    watched.get("hedon.tab('world-panel')")
    return watched


def rest(watched, step):
    watched.get("hedon.play(false)")
    watched.until("!hedon.source.busy")
    while (done := watched.get("hedon.source.last")) < step:
        watched.get(f"hedon.source.advance({step - done}, 5000)")
        watched.until("!hedon.source.busy")
    watched.get("hedon.seek(hedon.source.last)")
    watched.until("hedon.frame && hedon.frame.step === hedon.source.last && hedon.source.digest() !== ''")


def native(watched, step):
    kernel = "" if watched.get("hedon.source.fused") else "portable"
    simulation = Simulation(load_config("small"), seeds=[1], backend=kernel)
    simulation.run(step)
    return simulation.worlds[0]


def click_at(watched, place):
    x, y = watched.get(f"hedon.arena.scene.toPage(...{place})")
    watched.page.mouse.click(x, y)


def free_place(watched, gap):
    """A place in the middle of the arena with nothing within `gap` units."""
    return watched.get(
        f"""(() => {{
          const {{ frame }} = hedon;
          const [xs, ys] = [[...frame.x, ...frame.foodX], [...frame.y, ...frame.foodY]];
          for (let x = 60; x < 300; x += 5) for (let y = 60; y < 300; y += 5)
            if (!xs.some((other, i) => Math.hypot(other - x, ys[i] - y) < {gap})) return [x, y];
        }})()"""
    )


def download(watched, button):
    with watched.page.expect_download() as waiting:
        watched.page.locator(button).click()
    return waiting.value


@pytest.mark.parametrize(("choice", "count"), [("0", "frame.id.length"), ("1", "frame.foodX.length")])
def test_agents_and_food_can_be_added_and_removed_by_hand(world, choice, count):
    place = free_place(world, 24)
    before = world.get(f"hedon.{count}")
    world.page.locator("#edit").select_option(choice)
    click_at(world, place)
    world.until(f"hedon.{count} === {before + 1}")
    world.until("document.querySelector('#digest')?.textContent.includes('changed by hand')")
    click_at(world, place)
    world.until("document.querySelector('#world-panel .problem').textContent.includes('there is no room')")
    world.page.locator("#edit").select_option("remove")
    click_at(world, place)
    world.until(f"hedon.{count} === {before}")
    world.until("document.querySelector('#world-panel .problem').textContent === ''")
    world.page.locator("#edit").select_option("choose")
    world.get("hedon.play(true)")
    world.until("hedon.source.last > 220")
    assert world.get("hedon.source.error") == ""


def test_a_world_returns_to_its_snapshot_and_continues_with_the_same_digest(world):
    assert world.page.locator("#back").is_disabled()
    begun = world.get("hedon.source.last")
    world.page.locator("#keep").click()
    world.until(f"hedon.source.kept === {begun}")
    world.page.locator("#edit").select_option("1")
    click_at(world, free_place(world, 24))
    world.until("hedon.source.edited")
    rest(world, 700)
    later = world.get("hedon.source.series.step.length")
    world.page.locator("#back").click()
    world.until(f"hedon.source.last === {begun} && hedon.frame.step === {begun} && !hedon.source.edited")
    assert world.get("hedon.source.series.step.length") < later
    assert world.get("[...hedon.source.lives.all()].length") >= 50
    assert world.get(f"[...hedon.source.lives.all()].every((life) => Math.max(life.birth, life.death) <= {begun})")
    rest(world, 700)
    assert world.get("hedon.source.digest()") == native(world, 700).digest()


def test_the_records_of_the_page_match_those_of_the_native_world(world):
    rest(world, 900)
    same = native(world, 900)
    living = pl.read_csv(download(world, "#save-living").path())
    agents = same.agents()
    order = agents["agent_id"].argsort()
    assert living["agent_id"].to_list() == agents["agent_id"][order].tolist()
    assert living["energy"].to_list() == pytest.approx(agents["energy"][order].tolist(), rel=1e-6)
    assert living["death_step"].null_count() == len(living)
    x, y, agent = world.get("[hedon.frame.x[3], hedon.frame.y[3], hedon.frame.id[3]]")
    world.page.locator("#edit").select_option("remove")
    click_at(world, [x, y])
    world.until("hedon.source.edited")
    ended = pl.read_csv(download(world, "#save-ended").path())
    assert (agent, 900) in ended.select("agent_id", "death_step").rows()
    assert not set(ended["agent_id"]) & set(pl.read_csv(download(world, "#save-living").path())["agent_id"])
    assert {"parent_id", "eaten_normal", "w_action", "neutral_1"} <= set(living.columns)


def test_the_config_of_the_page_makes_the_same_world(server, watch):
    watched = watch(server.link)
    watched.get("hedon.tab('settings')")
    watched.get("document.querySelectorAll('#settings details').forEach((box) => (box.open = true))")
    watched.page.locator("[data-path='energy.basic_cost']").fill("0.05")
    watched.page.locator("#restart").click()
    watched.until("hedon.source.changes.size === 1 && hedon.frame")
    rest(watched, 50)
    watched.get("hedon.tab('world-panel')")
    taken = download(watched, "#save-config")
    assert taken.suggested_filename == "small.toml"
    kernel = "" if watched.get("hedon.source.fused") else "portable"
    simulation = Simulation(load_config(str(taken.path())), [1], backend=kernel)
    simulation.run(watched.get("hedon.source.last"))
    assert watched.get("hedon.source.digest()") == simulation.worlds[0].digest()


def test_the_config_of_a_world_from_a_file_is_complete(tmp_path, watch):
    file = tmp_path / "mushrooms.toml"
    file.write_text('preset = "small"\n[food.mushroom]\ngives.energy = 3.0\ninitial_count = 5\ncapacity = 20\n')
    with serving(live_server(str(file))) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('settings')")
        watched.get("document.querySelectorAll('#settings details').forEach((box) => (box.open = true))")
        watched.page.locator("[data-path='food.mushroom.gives.energy']").fill("4.5")
        watched.page.locator("#restart").click()
        watched.until("hedon.source.changes.size === 1 && hedon.frame")
        watched.get("hedon.tab('world-panel')")
        taken = tmp_path / "taken.toml"
        download(watched, "#save-config").save_as(taken)
        expected = load_config(str(file), overrides=["food.mushroom.gives.energy=4.5"])
        assert load_config(str(taken)).food == expected.food


def test_agents_are_colored_by_what_they_ate_last(world):
    rest(world, 600)
    lives = world.get(
        "[...hedon.frame.id].map((id) => hedon.source.lives.get(id)).map((life) => [life.lastMeal, life.eaten])"
    )
    assert {last for last, _ in lives} == {-1, 0}
    assert all((last >= 0) == (sum(eaten) > 0) for last, eaten in lives)
    world.page.locator("#color").select_option("last")
    world.until("document.querySelector('#legend').textContent.includes('ate last')")


def test_the_page_says_how_many_steps_it_does_not_draw(world):
    world.page.locator("#speed").select_option("64")
    world.get("hedon.play(true)")
    world.until("/steps skipped/.test(document.querySelector('#clock').textContent)")
    world.get("hedon.play(false)")
    world.until("!/steps skipped/.test(document.querySelector('#clock').textContent)")


def test_two_worlds_of_one_seed_stay_in_step_and_differ_by_one_setting(world):
    world.page.locator("#twin-setting").select_option("energy.basic_cost")
    world.page.locator("#twin-value").fill("-1")
    world.page.locator("#twin-begin").click()
    world.until("document.querySelectorAll('#world-panel .problem')[1].textContent.includes('must be')")
    assert world.get("hedon.twin.live") is None
    world.page.locator("#twin-value").fill("0.05")
    world.page.locator("#twin-begin").click()
    world.until("hedon.twin.live && hedon.now > 30")
    world.get("hedon.play(false)")
    lasts = "[hedon.source.last, hedon.twin.live.last]"
    world.until("!hedon.source.busy && !hedon.twin.live.busy && hedon.source.digest() && hedon.twin.live.digest()")
    first, second = world.get(lasts)
    assert abs(first - second) <= 4  # one of them may already have run its steps for the next picture
    kernel = "" if world.get("hedon.source.fused") else "portable"
    for changes, name, steps in (([], "source", first), (["energy.basic_cost=0.05"], "twin.live", second)):
        simulation = Simulation(load_config("small", overrides=changes), seeds=[1], backend=kernel)
        simulation.run(steps)
        assert world.get(f"hedon.{name}.digest()") == simulation.worlds[0].digest()
    captions = [world.page.locator(f"#{name}").inner_text() for name in ("caption", "caption-twin")]
    assert captions[0].startswith("energy.basic_cost = ")
    assert captions[1].startswith("energy.basic_cost = 0.05: ")
    world.page.locator("#twin-end").click()
    world.until("document.querySelector('#scene-twin').hidden")
