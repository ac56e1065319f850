"""Maps of the arena count where agents were, as in the records, and where they ate, as in the engine."""

import numpy as np
import polars as pl
import pytest
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon import Simulation, load_config
from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)
CELLS = 40
COUNTS = "[...hedon.heat.counts]"
DONE = "!hedon.heat.reading && hedon.heat.moments"


def counted(x, y, arena):
    """The number of positions in each square, in rows from the bottom, as in the page."""
    width, height = arena
    size = max(width, height) / CELLS
    columns, rows = int(np.ceil(width / size)), int(np.ceil(height / size))
    counts = np.zeros((rows, columns))
    np.add.at(counts, (np.floor(np.asarray(y) / size).astype(int), np.floor(np.asarray(x) / size).astype(int)), 1)
    return counts.ravel().tolist()


def arena(watched):
    return watched.get("[hedon.source.layout.arena.width, hedon.source.layout.arena.height]")


@pytest.mark.parametrize("kind", ["one", "two"])
def test_a_run_shows_where_agents_were_at_all_recorded_moments(kind, run_folder, tmp_path, watch):
    folder = run_folder if kind == "one" else record_species(tmp_path / "run", seeds=(1, 2))
    with serving(run_server(folder)) as server:
        watched = watch(f"{server.link}#world={0 if kind == 'one' else 1}")
        watched.until("hedon.frame && hedon.source.loaded")
        watched.get("hedon.play(false)")
        assert watched.get("hedon.heat.counts.length") == 0
        assert watched.get("document.querySelector('#heat option[value=meals]').disabled")
        assert "not in records" in watched.page.locator("#heat option[value=meals]").inner_text()
        watched.page.locator("#heat").select_option("positions")
        frames = open_run(folder).frames().filter(pl.col("world") == (kind == "two")).collect()
        rows = frames.filter(pl.col("kind").is_in(["agent", "prey", "predator"]))
        watched.until(f"{DONE} === {frames['step'].n_unique()}")
        assert watched.get(COUNTS) == counted(rows["x"], rows["y"], arena(watched))
        text = watched.page.locator("#heat-scale").inner_text()
        assert text.startswith(f"Map: agents in each square, at {frames['step'].n_unique()} moments recorded")
        squares = watched.get("hedon.arena.scene.triangles.count")
        obstacles = watched.get("hedon.source.obstacles.length")
        assert obstacles == 0
        assert squares == 6 * sum(each > 0 for each in watched.get(COUNTS))
        watched.page.locator("#heat").select_option("")
        watched.until("hedon.arena.scene.triangles.count === 0")
        assert watched.page.locator("#heat-scale").is_hidden()


def test_a_live_world_shows_where_its_agents_ate_and_were(watch):
    """Compared with the same world in Python, step by step; the page itself sees only some of the steps."""
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        run_live(watched, 400)
        steps = watched.get("hedon.source.last")
        watched.page.locator("#heat").select_option("meals")
        kernel = "" if watched.get("hedon.source.fused") else "portable"
        simulation = Simulation(load_config("small"), [1], backend=kernel)
        (world,) = simulation.worlds
        before, x, y = {}, [], []
        for _ in range(steps):
            simulation.run(1)
            agents = world.agents()
            for i, agent in enumerate(agents["agent_id"].tolist()):
                eaten = agents["eaten"][i].sum()
                if eaten > before.get(agent, 0):
                    x.append(agents["x"][i])
                    y.append(agents["y"][i])
                before[agent] = eaten
        assert len(x) > 20
        watched.until(f"hedon.source.bites.total === {len(x)} && hedon.heat.seen === {len(x)}")
        assert watched.get(COUNTS) == counted(x, y, arena(watched))
        assert (
            watched.page.locator("#heat-scale")
            .inner_text()
            .startswith(f"Map: meals eaten in each square, {len(x):,} in all")
        )
        watched.page.locator("#heat").select_option("positions")
        watched.until(f"{DONE} === hedon.source.frames.length")
        places = watched.get("hedon.source.frames.map((each) => [[...each.x], [...each.y]])")
        x, y = (np.concatenate([each[axis] for each in places]) for axis in (0, 1))
        assert watched.get(COUNTS) == counted(x, y, arena(watched))
        more = watched.get("hedon.heat.moments")
        run_live(watched, steps + 50)
        watched.until(f"hedon.heat.moments > {more} && {DONE} === hedon.source.frames.length")


def test_going_back_to_a_snapshot_forgets_the_meals_after_it(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        run_live(watched, 200)
        watched.get("hedon.tab('world-panel')")
        watched.page.locator("#heat").select_option("meals")
        watched.page.locator("#keep").click()
        watched.until("hedon.source.kept >= 200")
        kept = watched.get("hedon.source.kept")
        before = watched.get("hedon.source.bites.total")
        run_live(watched, kept + 300)
        watched.until(f"hedon.source.bites.total > {before} && hedon.heat.seen === hedon.source.bites.total")
        watched.page.locator("#back").click()
        watched.until(f"hedon.source.last === {kept} && hedon.heat.seen === {before}")
        assert sum(watched.get(COUNTS)) == before
