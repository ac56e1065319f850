"""The plots of the page tell species apart, in a replay as in a live world."""

import polars as pl
import pytest
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)
TITLES = "[...document.querySelectorAll('.plot-title')].map((each) => each.innerText)"


def test_a_replay_plots_the_numbers_of_each_species(tmp_path, watch):
    run = open_run(record_species(tmp_path / "run", steps=640, seeds=(1,)))
    rows = run.population()
    with serving(run_server(run.path)) as server:
        watched = watch(server.link)
        watched.until(f"hedon.source.series.step.length === {rows['step'].n_unique()}")
        for species in ("prey", "predator"):
            own = rows.filter(pl.col("species") == species).sort("step")
            for name in ("alive", "energy_mean", "w_action_mean"):
                assert watched.get(f"hedon.source.series.get('{species}.{name}')") == pytest.approx(own[name].to_list())
        assert (
            watched.get("hedon.source.series.get('alive')")
            == rows.group_by("step").agg(pl.col("alive").sum()).sort("step")["alive"].to_list()
        )
        watched.get("hedon.tab('plots')")
        titles = watched.get(TITLES)
        assert [title.split() for title in titles[:2]] == [
            ["agents", "alive", "●", "prey", "●", "predator"],
            ["mean", "energy", "●", "prey", "●", "predator"],
        ]
        assert titles[2].startswith("mean weights of prey")
        assert titles[3].startswith("mean weights of predator")


def test_a_live_world_plots_the_numbers_of_each_species(watch):
    with serving(live_server("predator")) as server:
        watched = watch(server.link)
        run_live(watched, 256)
        counts = watched.get(
            "['prey', 'predator', ''].map((each) => hedon.source.series.get(each ? `${each}.alive` : 'alive').at(-1))"
        )
        assert counts[2] == counts[0] + counts[1] > 100
        assert 0 < counts[1] <= 50
        energies = watched.get(
            "['prey', 'predator'].map((each) => hedon.source.series.get(`${each}.energy_mean`).at(-1))"
        )
        assert all(0 < energy < 1000 for energy in energies)
        assert energies[0] != energies[1]
