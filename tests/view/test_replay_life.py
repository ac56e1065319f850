"""What a replay says of a life is what the records say, under a title that is true at the step that is shown."""

import polars as pl
import pytest
from split_run import record_species
from view_page import Watched, live_server, run_live, run_server, serving

from hedon.record.reader import open_run

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
          for (const each of document.querySelector("#agent").children) {
            if (/^H/.test(each.tagName)) title = each.innerText;
            if (each.tagName === "TABLE")
              found[title] = Object.fromEntries([...each.rows].map((row) => [...row.cells].map((x) => x.innerText)));
          }
          return found;
        })()"""
    )


def number(text: str) -> float:
    return float(text.split()[0].replace(",", ""))


def check(watched, row, title, meals):
    """Compares the panel with a row of the table of agents, and returns what stands for the step alone."""
    name = f"Agent {row['agent_id']}"
    watched.get(f"hedon.choose({row['agent_id']})")
    watched.until(f"document.querySelector('#agent h2')?.textContent === '{name}'")
    found = tables(watched)
    assert set(found[name]) & {"reward", "children", *(f"{meal} eaten" for meal in meals)} == set()
    counted = found[title]
    assert number(counted["children"]) == row["children"]
    assert number(counted["reward"]) == pytest.approx(row["reward_sum"], abs=6e-3)
    for meal in meals:
        assert number(counted[f"{meal} eaten"]) == row[f"eaten_{meal}"]
    return found[name]


def test_counts_of_a_life_stand_under_the_title_that_is_true(species_run, watch):
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
                assert number(now["age"]) == STEP - row["birth_step"]
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
        watched.get("hedon.seek(10)")  # a look back: the counts are those of the newest step
        watched.get("hedon.choose(hedon.frame.id[0])")
        watched.until("document.querySelector('#agent').textContent.includes(`up to step ${hedon.source.last}`)")
