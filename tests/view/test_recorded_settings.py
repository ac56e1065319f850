"""The settings of a recorded run: those that it changes, and all of them."""

from view_page import run_server, serving
from worlds import QUICK

from hedon import RunPlan, load_config, run
from hedon.view.index import RunIndex

pytest_plugins = ("view_fixture",)
PANEL = "document.querySelector('#settings')"


def test_a_replay_shows_the_settings_of_its_run(tmp_path, watch):
    config = load_config("predator", overrides=[*QUICK, "species.prey.energy.basic_cost=0.003"])
    run(RunPlan(config, (1,), 128, tmp_path / "run", frames=64))
    told = RunIndex(tmp_path / "run").describe()["settings"]
    assert told["base"] == "predator (corrected)"
    assert ["species.prey.energy.basic_cost", "0.003", "0.0001"] in told["changed"]
    assert len(told["all"]) > 200
    with serving(run_server(tmp_path / "run")) as server:
        watched = watch(server.link)
        watched.until("hedon.source.lives.size > 0")
        watched.get("hedon.tab('settings')")
        text = watched.get(f"{PANEL}.innerText")
        assert "This run differs from predator (corrected) in:" in text
        assert "species.prey.energy.basic_cost\n0.003, not 0.0001" in text
        assert f"All {len(told['all'])} settings" in text
        watched.page.locator("#settings summary").click()
        watched.page.locator("#settings input[type=search]").fill("ray_length")
        shown = watched.get(
            f"[...{PANEL}.querySelectorAll('details div')].filter((row) => !row.hidden).map((row) => row.innerText)"
        )
        assert len(shown) == 2
        assert all("sensor.ray_length = " in row for row in shown)
        assert watched.get(f"{PANEL}.scrollWidth <= {PANEL}.clientWidth")
