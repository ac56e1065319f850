"""The page in a real browser shows what the records and the engine contain."""

import io
import json
import shutil
from contextlib import contextmanager

import numpy as np
import polars as pl
import pytest
from matplotlib.image import imread
from view_page import live_server, numbers, record, run_live, run_server, serving, site_server

from hedon import ConfigError, Simulation, _engine, load_config
from hedon.config.layout import layouts, observation_columns
from hedon.experiment.resume import resume
from hedon.record.manifest import load_manifest
from hedon.record.reader import open_run
from hedon.view.export import export
from hedon.view.index import RunIndex
from hedon.view.live import live_world
from hedon.view.server import Server

pytest_plugins = ("view_fixture",)
STEP = 640


def agents_at(folder, step):
    rows = open_run(folder).frames().filter((pl.col("step") == step) & (pl.col("kind") == "agent")).collect()
    return rows.sort("id")


def pixels_of(watched):
    watched.get("(document.querySelector('#look').hidden = true)")  # its buttons cover part of the arena
    return imread(io.BytesIO(watched.page.locator("#scene").screenshot()))[:, :, :3]


def on_canvas(watched, x, y):
    """Canvas pixels of positions in the arena, which is shown whole, as large as fits, with a 2 % margin."""
    arena = load_config("poison").arena
    box = watched.page.locator("#scene").bounding_box()
    zoom = 0.96 * min(box["width"] / arena.width, box["height"] / arena.height)
    left = box["width"] / 2 + (x - arena.width / 2) * zoom
    top = box["height"] / 2 - (y - arena.height / 2) * zoom
    return left, top, zoom


def test_agents_and_food_are_drawn_at_their_recorded_positions(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.rest_at(STEP)
        image = pixels_of(watched)
        ground = image[image.shape[0] // 2, 2]
        rows = open_run(run_folder).frames().filter(pl.col("step") == STEP).collect()
        left, top, zoom = on_canvas(watched, rows["x"].to_numpy(), rows["y"].to_numpy())
        config = load_config("poison")
        radius = np.where(rows["kind"] == "agent", config.species["agent"].body.radius, config.world.food_radius) * zoom
        rows_of, columns = np.mgrid[0 : image.shape[0], 0 : image.shape[1]]
        distance = np.min(
            [np.hypot(columns + 0.5 - x, rows_of + 0.5 - y) - r for x, y, r in zip(left, top, radius, strict=True)],
            axis=0,
        )
        painted = np.abs(image - ground).max(axis=2) > 0.02
        # The white rim of a mouth may be as pale as the background, so only the inner part of each body is compared.
        assert painted[distance < -0.25 * radius.max()].mean() > 0.999
        inside = (columns > left.min()) & (columns < left.max()) & (rows_of > top.min()) & (rows_of < top.max())
        assert painted[(distance > 3) & inside].mean() < 0.001


def test_a_click_chooses_the_agent_under_it(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.rest_at(STEP)
        for row in agents_at(run_folder, STEP).to_dicts()[::11]:
            left, top, _ = on_canvas(watched, row["x"], row["y"])
            watched.page.locator("#scene").click(position={"x": left, "y": top})
            watched.until(f"document.querySelector('#agent h2')?.textContent === 'Agent {row['id']}'")
            shown = watched.page.locator("#agent table").first.inner_text()
            assert f"{row['energy']:.2f}".rstrip("0").rstrip(".") in shown


def test_the_keyboard_moves_through_time_and_agents(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.rest_at(STEP)
        watched.page.keyboard.press("ArrowRight")
        watched.until(f"hedon.frame.step === {STEP + 64}")
        watched.page.keyboard.press("ArrowLeft")
        watched.until(f"hedon.frame.step === {STEP}")
        watched.page.keyboard.press("n")
        watched.until("hedon.chosen >= 0")
        watched.page.keyboard.press("End")
        watched.until("hedon.now === hedon.source.last && hedon.source.last === 2048")
        watched.page.keyboard.press("Escape")
        assert watched.get("hedon.chosen") == -1


def test_a_link_leads_to_its_moment(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        chosen = agents_at(run_folder, STEP)["id"][7]
        watched = watch(f"{server.link}#world=0&step={STEP}&agent={chosen}")
        watched.until(f"hedon.frame && hedon.frame.step === {STEP}")
        watched.until(f"document.querySelector('#agent h2')?.textContent === 'Agent {chosen}'")


def test_the_page_shows_the_digest_of_the_run(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        digest = load_manifest(run_folder).world_digests[0]
        watched.until(f"document.querySelector('#digest')?.textContent.includes('{digest}')")


def check_digest(watched, preset, steps):
    fused = watched.get("hedon.source.fused")
    kernel = next((k for k in _engine.kernel.kernel_names() if k != "portable"), "") if fused else "portable"
    simulation = Simulation(load_config(preset), seeds=[1], backend=kernel)
    simulation.run(steps)
    assert watched.get("[hedon.source.last, hedon.source.digest()]") == [steps, simulation.worlds[0].digest()]


LONG = [
    pytest.param(preset, 20 * 1024, marks=pytest.mark.long, id=preset) for preset in ("baseline", "poison", "predator")
]


@pytest.mark.parametrize(("preset", "steps"), [("poison", 1030), *LONG])
def test_a_live_world_has_the_digest_of_the_native_one(preset, steps, watch):
    with serving(live_server(preset)) as server:
        watched = watch(server.link)
        run_live(watched, steps)
        assert watched.get("hedon.source.threads") == min(4, watched.get("navigator.hardwareConcurrency"))
        check_digest(watched, preset, steps)


def test_the_link_sets_the_number_of_threads_of_a_live_world(watch):
    with serving(live_server("small")) as server:
        watched = watch(f"{server.link}#threads=3")
        run_live(watched, 300)
        assert watched.get("hedon.source.threads") == 3
        watched.page.keyboard.press("?")
        watched.until("document.querySelector('#help').textContent.includes('3 threads')")
        check_digest(watched, "small", 300)


def test_a_chosen_agent_of_a_live_world_shows_its_network(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        watched.get("hedon.choose(hedon.frame.id[2])")
        watched.until("document.querySelector('#agent').textContent.includes('value of now')")


def shown_pairs(watched):
    """The rows of the tables in the agent panel, in order."""
    return watched.get(
        "[...document.querySelectorAll('#agent tr')].map((row) => [...row.children].map((cell) => cell.innerText))"
    )


def shown_rows(watched):
    """The same rows by their first cell; of rows with the same first cell, the last."""
    return dict(shown_pairs(watched))


def test_an_agent_shows_what_it_smells_and_what_its_reward_is_made_of(watch):
    settings = ['sensor.smells=["agent", "poison"]', "sensor.noses=2", "reward.action_coef=0"]
    config = load_config("poison", overrides=settings)
    page = {"run": False, "worlds": [live_world(config, "poison")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        run_live(watched, 300)
        watched.get("hedon.seek(hedon.source.last)")
        watched.until("hedon.frame.step === hedon.source.last")
        kernel = "" if watched.get("hedon.source.fused") else "portable"
        simulation = Simulation(config, seeds=[1], backend=kernel)
        simulation.run(300)
        world = simulation.worlds[0]
        columns = observation_columns(config, "agent")
        noses = {name: column for column, name in enumerate(columns) if name.startswith("smell_")}
        genes = layouts(config)["agent"].gene_names
        lives, observed = world.agents(), world.observations(0)
        hungry = 0
        for i in range(0, world.alive, 7):
            watched.get(f"hedon.choose({lives['agent_id'][i]})")
            watched.until(f"document.querySelector('#agent h2')?.textContent === 'Agent {lives['agent_id'][i]}'")
            rows = shown_rows(watched)
            for kind in ("agent", "poison"):
                right, left = (float(observed[i, noses[f"smell_{kind}_{n}"]]) for n in range(2))
                assert numbers(rows[kind]) == pytest.approx([left, right], abs=6e-3)
            for k, kind in enumerate(config.food):
                part = lives["genome"][i][genes.index(f"w_{kind}")] * lives["eaten"][i][k]
                assert numbers(rows[f"… by {kind}"])[0] == pytest.approx(part, abs=6e-3)
                hungry += part != 0
            assert rows["… by action"] == "0"
        assert hungry > 3


def test_an_agent_shows_its_stores_and_what_it_observes(watch):
    settings = ["store.water.capacity=7", "store.water.initial=3", "store.water.basic_cost=0.01", "sensor.scaling=unit"]
    settings += ["store.water.birth_weight=4", "energy.birth_weight=-0.1", "birth.kappa=0.02"]
    settings += ["sensor.observes.age=100", "sensor.observes.moved=0.5"]
    config = load_config("small", overrides=settings)
    page = {"run": False, "worlds": [live_world(config, "small")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        run_live(watched, 100)
        watched.get("hedon.seek(hedon.source.last)")
        watched.until("hedon.frame.step === hedon.source.last")
        simulation = Simulation(config, seeds=[1], backend="" if watched.get("hedon.source.fused") else "portable")
        simulation.run(100)
        world, layout = simulation.worlds[0], layouts(config)["agent"]
        assert world.counters["births"] > 5
        assert watched.get("hedon.source.digest()") == world.digest()
        lives, observed = world.agents(), world.observations(0)[:, -len(layout.observed) :]
        for i in range(0, world.alive, 9):
            watched.get(f"hedon.choose({lives['agent_id'][i]})")
            watched.until(f"document.querySelector('#agent h2')?.textContent === 'Agent {lives['agent_id'][i]}'")
            watched.until("document.querySelector('#agent').textContent.includes('what else it observes')")
            rows = shown_pairs(watched)
            (held,) = (text for name, text in rows if name == "water" and " of " in text)
            assert numbers(held) == pytest.approx([lives["water"][i], 7], abs=6e-3)
            shown = {name: numbers(text)[0] for name, text in rows if name in ("age", "moved")}
            for channel, value in zip(layout.observed, observed[i], strict=True):
                if channel.name in ("age", "moved"):
                    assert shown[channel.name] == pytest.approx(value * channel.scale, abs=6e-4)


@pytest.mark.parametrize("preset", ["poison", "pitfall"])
def test_rays_are_drawn_as_the_engine_casts_them(preset, watch):
    with serving(live_server(preset)) as server:
        watched = watch(server.link)
        run_live(watched, 100)
        watched.get("hedon.seek(hedon.source.last)")
        watched.until("hedon.frame.step === hedon.source.last")
        seen = 0
        for i in range(0, watched.get("hedon.frame.id.length"), 7):
            watched.get(f"hedon.choose(hedon.frame.id[{i}])")
            watched.until(f"hedon.source.agentProbe()?.id === hedon.frame.id[{i}]")
            drawn = watched.get(f"hedon.rays({i})")
            reading = watched.get("Array.from(hedon.source.agentProbe().reading)")
            types = watched.get("Array.from(hedon.source.agentProbe().type)")
            for r, ray in enumerate(drawn):
                assert (ray["type"] >= 0) == (reading[r] > 0)
                if ray["type"] >= 0:
                    # A reading is 2 minus the fraction of the ray's length; float32 in the engine, double in the page.
                    assert ray["share"] == pytest.approx(2 - reading[r], abs=2e-4)
                    assert ray["type"] == types[r]
                    seen += 1
        assert seen > 50


@pytest.mark.parametrize(
    ("path", "value"),
    [("food.normal.gives.energy", "1000000"), ("population.capacity", "1.5"), ("energy.initial", "many")],
)
def test_a_setting_is_refused_with_the_message_of_the_command(path, value, watch):
    given = value if value != "many" else f'"{value}"'
    with pytest.raises(ConfigError) as refused:
        load_config("poison", overrides=[f"{path}={given}"])
    message = refused.value.problems[0].message
    with serving(live_server("poison")) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('settings')")
        watched.get("document.querySelectorAll('#settings details').forEach((box) => (box.open = true))")
        watched.page.locator(f"[data-path='{path}']").fill(value)
        watched.until("document.querySelector('#settings .problem').textContent !== ''")
        assert watched.page.locator("#settings .problem").inner_text() == f"{path} = {value}: {message}"
        assert watched.page.locator("#restart").is_disabled()


def test_a_changed_setting_makes_the_world_that_the_command_makes(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('settings')")
        watched.get("document.querySelectorAll('#settings details').forEach((box) => (box.open = true))")
        watched.page.locator("[data-path='food.normal.initial_count']").fill("37")
        watched.page.locator("#restart").click()
        watched.until("hedon.source.changes.size === 1 && hedon.frame")
        watched.get("hedon.play(false)")
        watched.until("!hedon.source.busy && hedon.source.digest() !== ''")
        steps = watched.get("hedon.source.last")
        kernel = "" if watched.get("hedon.source.fused") else "portable"
        simulation = Simulation(load_config("small", overrides=["food.normal.initial_count=37"]), [1], backend=kernel)
        simulation.run(steps)
        assert watched.get("hedon.source.digest()") == simulation.worlds[0].digest()


def test_a_run_that_continues_is_followed(run_folder, tmp_path, watch):
    folder = record(tmp_path / "growing", 1024)
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(manifest | {"status": "running"}))
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.last === 1024")
        resume(folder, 2048, threads=1)
        watched.until("hedon.source.last === 2048")
        watched.rest_at(2048)
        assert watched.get("hedon.frame.id.length") == len(agents_at(run_folder, 2048))


def test_names_of_a_hostile_run_stay_text(run_folder, tmp_path, watch):
    evil = "<img src=x onerror=document.title='taken'>"
    folder = tmp_path / evil.replace("/", "")
    shutil.copytree(run_folder, folder)
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(manifest | {"name": evil}))
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("document.querySelector('#status').textContent.includes('<img')")
        assert watched.page.locator("img").count() == 0
        assert watched.page.title() == "hedon"


@contextmanager
def plain_server(site):
    with serving(site_server(site)) as server:
        yield f"http://127.0.0.1:{server.server_port}/index.html"


def test_an_exported_site_works_from_any_server(run_folder, tmp_path, watch):
    index = RunIndex(run_folder)
    export(tmp_path / "site", {"page": {"run": True, "worlds": []}, "run": index.describe()}, index.files())
    with plain_server(tmp_path / "site") as link:
        watched = watch(link)
        watched.rest_at(STEP)
        assert watched.get("Array.from(hedon.frame.id)") == agents_at(run_folder, STEP)["id"].to_list()


def test_a_live_world_has_one_thread_if_the_page_is_not_isolated(tmp_path, watch):
    page = {"run": False, "worlds": [live_world(load_config("small"), "small")]}
    export(tmp_path / "site", {"page": page}, {})
    with plain_server(tmp_path / "site") as link:
        watched = watch(f"{link}#threads=2")
        run_live(watched, 1030)
        assert watched.get("[crossOriginIsolated, hedon.source.threads]") == [False, 1]
        check_digest(watched, "small", 1030)
