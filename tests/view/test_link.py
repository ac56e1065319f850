"""A link leads another person to the same moment of the same world: settings, seed, step, agent, color and view."""

import pytest
from view_page import live_server, run_live, run_server, serving

from hedon import Simulation, load_config
from hedon.record.reader import open_run
from hedon.view.moment import fragment

pytest_plugins = ("view_fixture",)


def test_the_link_of_a_live_world_gives_the_same_moment(browser, watch):
    with serving(live_server("small")) as server:
        first = watch(f"{server.link}#live=small&seed=5&set=energy.basic_cost%3D0.03")
        run_live(first, 300)
        steps = first.get("hedon.source.last")  # more than 300 if the page was faster than the test
        first.get("hedon.seek(hedon.source.last)")
        first.get("hedon.choose(hedon.frame.id[4])")
        first.page.locator("#color").select_option("w_normal")
        first.get("(hedon.arena.look(hedon.source, [100, 90, 2]), hedon.viewed())")
        link, digest = first.get("[location.href, hedon.source.digest()]")
        second = watch(link)  # in a separate browser context
        second.until("hedon.source.digest() !== '' && hedon.chosen >= 0")
        same = second.get("[hedon.source.last, hedon.source.seed, hedon.chosen, hedon.source.digest()]")
        assert same == [steps, 5, first.get("hedon.chosen"), digest]
        assert second.page.locator("#color").input_value() == "w_normal"
        assert second.get("hedon.arena.view(hedon.source)") == pytest.approx([100, 90, 2], rel=1e-3)
        assert second.get("[...hedon.source.changes]") == [["energy.basic_cost", "0.03"]]
        assert second.page.locator("#restart").text_content() == "Start again with these"
        kernel = "" if second.get("hedon.source.fused") else "portable"
        simulation = Simulation(load_config("small", overrides=["energy.basic_cost=0.03"]), [5], backend=kernel)
        simulation.run(steps)
        assert simulation.worlds[0].digest() == digest


def test_the_link_of_a_run_gives_the_same_moment(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        first = watch(server.link)
        first.rest_at(1024)
        first.get("hedon.choose(hedon.frame.id[9])")
        first.page.locator("#color").select_option("family")
        link, agent = first.get("[location.href, hedon.chosen]")
        place = fragment(open_run(run_folder), 1024, 1, agent)  # of `hedon view RUN --step 1024 --seed 1 --agent ID`
        assert set(place[1:].split("&")) <= set(link.split("#")[1].split("&"))
        second = watch(link)
        second.until("hedon.frame && hedon.frame.step === 1024")
        assert second.get("[hedon.chosen, hedon.playing]") == [first.get("hedon.chosen"), False]
        assert second.page.locator("#color").input_value() == "family"


@pytest.mark.parametrize(
    "link", ["#live=small&step=-3&agent=x&view=1,2&set=nothing%3D4&color=none", "#%%%", "#step=1e9"]
)
def test_a_link_with_nonsense_shows_the_world(link, watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link + link)
        watched.until("hedon.frame && hedon.source.last > 3")
        assert watched.get("[...hedon.source.changes]") == []
