"""The plots of the page tell species apart, in a replay as in a live world."""

import math
import re
import shutil

import polars as pl
import pytest
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon import load_config
from hedon.record.reader import open_run
from hedon.view.live import live_world
from hedon.view.server import Server

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
        assert titles[0] == "prey: weight of normal food [reward per meal, mean of the living]"
        assert "predator: weight of prey [reward per meal, mean of the living]" in titles
        assert not any("neutral" in title for title in titles)
        for title in ("agents alive [agents]", "mean energy [energy]"):
            assert f"{title} ● prey ● predator" in [" ".join(each.split()) for each in titles]


@pytest.mark.long
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


VERDICTS = """Object.fromEntries([...document.querySelectorAll('.verdict')]
  .map((each) => [each.previousElementSibling.innerText.split(' [')[0], each.innerText]))"""


def test_each_weight_is_judged_against_the_band_of_drift(run_folder, tmp_path, watch):
    """The words follow from the records: 1.96 times the root mean square of the neutral genes' means."""
    folder = tmp_path / "run"
    shutil.copytree(run_folder, folder)
    part = next((folder / "population").glob("*.parquet"))
    rows = pl.read_parquet(part)
    strayed = rows.with_columns(w_normal_mean=pl.col("w_normal_mean") + 5.0)  # as if it had been selected
    strayed.select(rows.columns).cast(rows.schema).write_parquet(part, compression="zstd")
    neutral = rows.select(pl.col("^neutral_\\d+_mean$")).row(-1)
    limit = 1.96 * math.sqrt(sum(value * value for value in neutral) / len(neutral))
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.series.step.length > 1")
        watched.get("hedon.tab('plots')")
        watched.rest_at(2048)
        watched.until("document.querySelector('.verdict').innerText !== ''")
        said = watched.get(VERDICTS)
        assert set(said) == {"weight of normal food", "weight of poison", "weight of action"}
        numbers = [float(each) for each in re.findall(r"-?[\d.]+", said["weight of normal food"])]
        assert numbers == pytest.approx([strayed["w_normal_mean"][-1], -limit, limit], abs=2e-3)
        assert "outside drift" in said["weight of normal food"]
        action = rows["w_action_mean"][-1]
        assert ("within" if abs(action) < limit else "outside") in said["weight of action"]


def test_an_empty_plot_says_when_it_fills(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        run_live(watched, 20)
        watched.get("hedon.tab('plots')")
        watched.until("document.querySelector('.empty').innerText.includes('Fills from step 512 on')")
        for step in (256, 512):  # a point at the end of each stretch of steps that a page asks for
            run_live(watched, step)
        watched.until("[...document.querySelectorAll('.empty')].every((each) => each.hidden)")


def test_without_neutral_genes_there_is_no_band_and_the_page_says_so(watch):
    page = {"run": False, "worlds": [live_world(load_config("small", overrides=["genome.neutral_count=1"]), "small")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('plots')")
        watched.until("document.querySelector('.verdict').innerText.startsWith('No band')")
