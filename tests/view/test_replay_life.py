"""A replay shows a life as the records have it, under a title that is true at the step shown."""

import polars as pl
import pytest
from split_run import record_species
from view_page import Watched, live_server, numbers, run_live, run_server, serving

from hedon import Simulation, load_config
from hedon.record.reader import open_run
from hedon.view.live import live_world
from hedon.view.server import Server

pytest_plugins = ("view_fixture",)
STEP = 256


@pytest.fixture(scope="module")
def species_run(tmp_path_factory):
    return record_species(tmp_path_factory.mktemp("life") / "run", steps=640, seeds=(1,))


def tables(watched: Watched) -> dict[str, dict[str, str]]:
    """The rows of the agent's panel, by the title above them."""
    return watched.get(
        """(() => {
          const found = {};
          let title = "";
          for (const each of document.querySelectorAll("#agent h2, #agent h3, #agent table")) {
            if (/^H/.test(each.tagName)) title = each.innerText;
            if (each.tagName === "TABLE")
              found[title] = Object.fromEntries([...each.rows].map((row) => [...row.cells].map((x) => x.innerText)));
          }
          return found;
        })()"""
    )


def check(watched, row, title, meals):
    """Compares the panel with a row of the table of agents, and returns the values that belong to the step only."""
    name = f"Agent {row['agent_id']}"
    watched.get(f"hedon.choose({row['agent_id']})")
    watched.until(f"document.querySelector('#agent h2')?.textContent === '{name}'")
    found = tables(watched)
    assert set(found[name]) & {"reward", "children", *(f"{meal} eaten" for meal in meals)} == set()
    counted = found[title]
    assert numbers(counted["children"])[0] == row["children"]
    assert numbers(counted["reward"])[0] == pytest.approx(row["reward_sum"], abs=6e-3)
    for meal in meals:
        assert numbers(counted[f"{meal} eaten"])[0] == row[f"eaten_{meal}"]
    return found[name]


def test_counts_of_a_life_are_shown_under_a_true_title(species_run, watch):
    agents = open_run(species_run).agents()
    born = agents.filter(pl.col("birth_step") <= STEP)
    died = born.filter(pl.col("death_step") > STEP)
    ate = pl.col("eaten_normal") + pl.col("eaten_prey") > 0
    assert died.height > 2
    cases = {"in its whole life": died.head(3).to_dicts(), "up to the last record of it": []}
    for species in ("prey", "predator"):
        living = born.filter(pl.col("death_step").is_null(), pl.col("species") == species, ate)
        cases["up to the last record of it"] += living.head(2).to_dicts()
    assert len(cases["up to the last record of it"]) == 4
    with serving(run_server(species_run)) as server:
        watched = watch(server.link)
        watched.until(f"hedon.source.lives.size === {agents.height}")
        watched.rest_at(STEP)
        for title, rows in cases.items():
            for row in rows:
                now = check(watched, row, title, ("normal", "prey"))
                assert numbers(now["age"])[0] == STEP - row["birth_step"]
        later = agents.filter(pl.col("birth_step") > STEP).row(0, named=True)
        title = "in its whole life" if later["death_step"] is not None else "up to the last record of it"
        assert "age" not in check(watched, later, title, ("normal", "prey"))
        assert "so far" not in watched.page.locator("body").inner_text()
        labels = watched.get("[...document.querySelectorAll('#color option')].map((each) => each.textContent)")
        assert "reward of the whole life" in labels


def test_a_live_world_says_up_to_which_step_it_counts(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        run_live(watched, 50)
        watched.get("hedon.seek(10)")  # looking back: the counts are still those at the newest step
        watched.get("hedon.choose(hedon.frame.id[0])")
        watched.until("document.querySelector('#agent').textContent.includes(`up to step ${hedon.source.last}`)")


def test_a_live_world_shows_the_reward_of_each_window(watch):
    """Compared with the reward that agents of the native world gain from one window's end to the next."""
    config = load_config("small", overrides=["world.rollout_steps=64", "learning.minibatch_size=64"])
    page = {"run": False, "worlds": [live_world(config, "small")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        run_live(watched, 5 * 64 + 10)
        kernel = "" if watched.get("hedon.source.fused") else "portable"
        simulation, before, known = Simulation(config, [1], backend=kernel), {}, {}
        for _ in range(5):
            simulation.run(64)
            agents = simulation.worlds[0].agents()
            now = dict(zip(agents["agent_id"].tolist(), agents["reward"].tolist(), strict=True))
            for agent, reward in now.items():
                known.setdefault(agent, []).append(reward - before.get(agent, 0.0))
            before = now
        assert len(before) > 20
        for agent in before:
            shown = watched.get(f"hedon.source.earned({agent}).map((each) => each.reward)")
            assert shown == pytest.approx(known[agent], abs=1e-4)
        founder = next(agent for agent in before if len(known[agent]) == 5)
        watched.get(f"(hedon.seek(hedon.source.last), hedon.choose({founder}))")
        watched.until("document.querySelector('#agent').textContent.includes('per window')")
