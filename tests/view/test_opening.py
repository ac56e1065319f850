"""The page opens on what evolved: agents are colored by the first weight, and the plots are shown."""

import polars as pl
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)
SHOWN = "[...document.querySelectorAll('[role=tabpanel]')].filter((each) => !each.hidden).map((each) => each.id)"


def color(watched):
    return watched.get("[hedon.colors.current.name, document.querySelector('#legend strong').innerText]")


def test_a_run_opens_with_its_first_weight_and_the_plots(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.until("document.querySelector('#legend strong')")
        assert color(watched) == ["w_normal", "Color: weight of normal food"]
        assert watched.page.locator("#color").input_value() == "w_normal"
        assert watched.get(SHOWN) == ["plots"]
        watched.rest_at(640)
        watched.page.keyboard.press("n")
        assert watched.get(SHOWN) == ["agent"]
        watched.page.locator("#color").select_option("energy")
        again = watch(watched.get("location.href"))
        again.until("hedon.frame && hedon.frame.step === 640")
        assert again.get(SHOWN) == ["agent"]
        assert again.page.locator("#color").input_value() == "energy"
        watched.page.keyboard.press("Escape")
        again = watch(watched.get("location.href"))
        again.until("hedon.frame && hedon.frame.step === 640")
        assert again.get(SHOWN) == ["plots"]
        assert "color=energy" in again.get("location.href")


def test_another_world_keeps_the_color_that_was_chosen(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.rest_at(640)
        watched.page.keyboard.press("n")
        watched.page.locator("#world").select_option("live 0")
        watched.until("hedon.source.live && hedon.frame")
        assert watched.get(SHOWN) == ["plots"]
        assert watched.get("hedon.colors.current.name") == "w_normal"
        watched.page.locator("#color").select_option("age")
        watched.page.locator("#world").select_option("run 0")
        watched.until("!hedon.source.live && hedon.frame")
        assert watched.page.locator("#color").input_value() == "age"


def test_a_world_of_several_species_opens_with_a_weight(tmp_path, watch):
    folder = record_species(tmp_path / "run", seeds=(1,))
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.loaded && hedon.frame")
        assert watched.get("hedon.colors.current.name") == "w_normal"
        prey = open_run(folder).agents().filter(pl.col("species") == "prey")
        agent = prey.row(0, named=True)
        value = f"hedon.colors.current.value(hedon.source.lives.get({agent['agent_id']}), hedon.frame, 0)"
        assert watched.get(value) == agent["w_normal"]


def test_neutral_genes_are_one_entry_with_a_list_of_their_own(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        run_live(watched, 20)
        names = watched.get("[...document.querySelector('#color').options].map((each) => each.value)")
        genes = watched.get("hedon.source.layout.genes.map((each) => [each.name, each.role])")
        neutral = [name for name, role in genes if role == "neutral"]
        assert len(neutral) > 8
        assert [name for name in names if name.startswith("neutral")] == ["neutral"]
        assert {name for name, role in genes if role != "neutral"} | {"energy", "age", "family", "eats"} < set(names)
        assert watched.page.locator("#neutral").is_hidden()
        watched.page.locator("#color").select_option("neutral")
        own = watched.page.locator("#neutral")
        assert own.is_visible()
        assert watched.get("[...document.querySelector('#neutral').options].map((each) => each.value)") == neutral
        assert watched.get("hedon.colors.current.name") == neutral[0]
        own.select_option(neutral[4])
        place = [name for name, _ in genes].index(neutral[4])
        life = "hedon.source.lives.get(hedon.frame.id[3])"
        assert watched.get(f"hedon.colors.current.value({life}, hedon.frame, 3) === {life}.genome[{place}]")
        watched.until(f"document.querySelector('#legend strong').innerText === 'Color: neutral gene {neutral[4][8:]}'")
        again = watch(watched.get("location.href"))
        again.until("hedon.frame")
        assert again.get("['color', 'neutral'].map((id) => document.getElementById(id).value)") == [
            "neutral",
            neutral[4],
        ]
        own.select_option(neutral[0])
        watched.page.locator("#color").select_option("age")
        assert own.is_hidden()
