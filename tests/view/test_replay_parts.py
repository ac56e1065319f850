"""A replay has every agent and every food at every recorded step, wherever the records are split into parts."""

from collections import Counter

import polars as pl
import pytest
from split_run import FRAMES, record_species, split_parts
from view_page import demo_server, run_server, serving

from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)

COUNTS = """(() => {
  const { step, id, species, foodKind } = hedon.frame, { layout } = hedon.source, counts = {};
  const count = (name) => (counts[name] = (counts[name] ?? 0) + 1);
  species.forEach((each) => count(layout.species[each].name));
  foodKind.forEach((each) => count(layout.foods[each].name));
  return { step, counts, ids: Array.from(id) };
})()"""


def recorded(folder, world):
    """The contents of a world's frames at each step: the number of each kind, and the ids in order."""
    rows = open_run(folder).frames().filter(pl.col("world") == world).collect()
    return {
        step: (Counter(mine["kind"]), mine["id"].drop_nulls().sort().to_list())
        for (step,), mine in rows.group_by("step")
    }


def replayed(watched, steps):
    watched.get("hedon.play(false)")
    found = {}
    for step in steps:
        watched.get(f"hedon.seek({step})")
        watched.until(f"hedon.frame && hedon.frame.step === {step}")
        shown = watched.get(COUNTS)
        found[step] = Counter(shown["counts"]), shown["ids"]
    return found


@pytest.fixture(scope="module")
def species_run(tmp_path_factory):
    return record_species(tmp_path_factory.mktemp("parts") / "run")


@pytest.mark.parametrize("world", [0, pytest.param(1, marks=pytest.mark.long)])
def test_every_recorded_step_is_shown_whole(species_run, watch, world):
    """First from one part, then from parts so small that a step extends into a third one."""
    folder = species_run
    known = recorded(folder, world)
    assert sorted(known) == list(range(FRAMES, 257, FRAMES))
    population = open_run(folder).population().filter(pl.col("world") == world).group_by("step").agg(pl.sum("alive"))
    alive = dict(population.sort("step").iter_rows())
    for rows in (10**6, 700, 150):
        straddling = split_parts(folder, "frames", rows)
        split_parts(folder, "population", 10**6 if rows == 10**6 else 3)
        assert (straddling > 5) == (rows < 10**6)
        with serving(run_server(folder)) as server:
            watched = watch(f"{server.link}#world={world}")
            assert replayed(watched, sorted(known)) == known
            assert replayed(watched, sorted(known, reverse=True)) == known
            watched.until(f"hedon.source.series.step.length === {len(alive)}")
            shown = watched.get("[Array.from(hedon.source.series.step), hedon.source.series.get('alive')]")
            assert dict(zip(*shown, strict=True)) == alive


@pytest.mark.long
def test_the_demo_site_shows_all_agents_at_every_step(watch):
    """Compared with the table of lives, which does not depend on the parts of the frames."""
    with serving(demo_server()) as server:
        watched = watch(f"http://127.0.0.1:{server.server_port}/index.html")
        watched.until("hedon.source.lives.size > 0")
        last, frames = watched.get("hedon.source.last"), watched.get("hedon.source.index.frames")
        assert last // frames >= 50
        for step in range(frames, last + 1, frames):
            watched.rest_at(step)
            alive = f"(life) => life.birth <= {step} && (life.death < 0 || life.death > {step})"
            watched.until(f"hedon.frame.id.length === [...hedon.source.lives.all()].filter({alive}).length")
