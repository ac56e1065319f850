"""A changed setting acts at once if a running world can take it, with the same bits as a branch of the native world."""

import pytest
from view_page import live_server, run_live, serving

from hedon import Simulation, load_config
from hedon.config.fixed import fixed_path
from hedon.view.live import live_world

pytest_plugins = ("view_fixture",)


@pytest.fixture
def watched(watch):
    with serving(live_server("small")) as server:
        page = watch(server.link)
        run_live(page, 150)  # or a few more if the page was faster than the test
        page.get("hedon.tab('settings')")
        page.get("document.querySelectorAll('#settings details').forEach((box) => (box.open = true))")
        yield page


def when(watched, path):
    return watched.get(
        f"document.querySelector(\"[data-path='{path}']\").closest('label').querySelector('.when').textContent"
    )


def test_a_running_world_continues_with_a_changed_value(watched):
    begun = watched.get("hedon.source.last")
    watched.page.locator("[data-path='energy.basic_cost']").fill("0.2")
    watched.until("hedon.source.acts.length === 1")
    watched.until(f"document.querySelector('#settings').textContent.includes('acts since step {begun}')")
    run_live(watched, 400)
    watched.page.locator("[data-path='food.normal.growth_rate']").fill("2")
    watched.until("hedon.source.acts.length === 2")
    run_live(watched, 700)
    kernel = "" if watched.get("hedon.source.fused") else "portable"
    simulation, changes = Simulation(load_config("small"), [1], backend=kernel), []
    for steps, change in ((begun, "energy.basic_cost=0.2"), (400 - begun, "food.normal.growth_rate=2"), (300, "")):
        simulation.run(steps)
        if change:
            changes.append(change)
            state = simulation.engine.save(0)
            simulation = Simulation(load_config("small", overrides=changes), [1], backend=kernel)
            simulation.engine.restore(0, state)
    assert watched.get("hedon.source.digest()") == simulation.worlds[0].digest()
    watched.get("hedon.seek(hedon.source.last)")
    watched.until("document.querySelector('#digest').textContent.includes('changed by hand')")
    watched.get("hedon.help()")
    said = watched.page.locator("#help").inner_text()
    assert f"At step {begun}: energy.basic_cost = 0.2" in said
    assert "At step 400: food.normal.growth_rate = 2" in said


@pytest.mark.long
def test_a_change_waits_until_the_agents_have_learned(watched):
    window = watched.get("hedon.source.layout.window")
    run_live(watched, window - 1)
    watched.get("hedon.source.advance(1, 0)")
    watched.until("!hedon.source.busy")
    assert watched.get("hedon.source.learning") > 0
    watched.page.locator("[data-path='energy.basic_cost']").fill("0.2")
    watched.until("hedon.source.acts.length === 1")
    assert watched.get("[hedon.source.last, hedon.source.learning, hedon.source.error]") == [window, 0, ""]


@pytest.mark.parametrize(
    "path", ["food.normal.initial_count", pytest.param("sensor.ray_count", marks=pytest.mark.long)]
)
def test_a_setting_that_matters_from_the_beginning_says_so(path, watched):
    watched.page.locator(f"[data-path='{path}']").fill("7")
    assert when(watched, path) == "matters from the beginning: start again"
    watched.page.locator("#restart").click()
    watched.until(f"hedon.source.changes.get('{path}') === '7' && hedon.frame")


def test_a_setting_that_memory_depends_on_is_refused_with_a_reason(watched):
    watched.page.locator("[data-path='population.capacity']").fill("60")
    row = "document.querySelector(\"[data-path='population.capacity']\").closest('label')"
    watched.until(f"{row}.querySelector('.when').textContent.includes('start again')")
    assert when(watched, "population.capacity") == "this setting needs a new beginning: start again"
    begun, digest = watched.get("[hedon.source.last, hedon.source.digest()]")
    run_live(watched, begun)
    assert watched.get("[hedon.source.last, hedon.source.edited]") == [begun, False]
    assert watched.get("hedon.source.digest()") == digest


def test_each_setting_says_whether_it_acts_at_once():
    settings = live_world(load_config("poison"), "poison")["settings"]
    acts = {each["path"]: each["at_once"] for each in settings}
    assert acts["energy.basic_cost"]
    assert acts["hazard.kappa"]
    assert acts["food.poison.growth_rate"]
    assert not any(acts[path] for path in acts if fixed_path(path) or path.endswith(("initial", "initial_count")))
    assert sum(acts.values()) > 40
