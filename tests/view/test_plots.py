"""The plots of the page tell species apart, both in a replay and in a live world."""

import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from split_run import record_species
from view_page import live_server, numbers, run_live, run_server, serving

from hedon import load_config
from hedon.analysis.descent.genealogy import living_at
from hedon.analysis.descent.walk import mutation_law, neutral_courses
from hedon.analysis.gene.pedigree import walked_pedigree
from hedon.analysis.world.record import read_worlds
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.reader import open_run
from hedon.view.live import live_world
from hedon.view.server import Server

pytest_plugins = ("view_fixture",)
TITLES = "[...document.querySelectorAll('.plot-title')].map((each) => each.innerText)"


def test_a_replay_plots_the_numbers_of_each_species(tmp_path, watch):
    recorded = open_run(record_species(tmp_path / "run", steps=640, seeds=(1,)))
    rows = recorded.population()
    with serving(run_server(recorded.path)) as server:
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
PLOTS = "hedon.plots.plots.filter((each) => each.judge).map((each) => each.chart.data.map((column) => [...column]))"
"""What is drawn for each weight: steps, means, and the limits of the band."""
LAWS = {
    "weight of normal food": {},
    "weight of poison": {"food.poison.gene.initial_mean": 1.0, "food.poison.gene.initial_sd": 0.02},
    "weight of action": {"genome.mutation.w_action": {"law": "student_t", "df": 3.0, "scale": 0.2, "limit": 0.3}},
}
"""Settings that make the gene of each weight start or mutate differently from the neutral genes."""


@pytest.fixture(scope="module")
def unlike(tmp_path_factory) -> Path:
    """A run whose genes differ in their founders and mutations."""
    config = load_config("poison").with_("learning.policy", "random").with_("world.rollout_steps", 256)
    for changes in LAWS.values():
        for path, value in changes.items():
            config = config.with_(path, value)
    folder = tmp_path_factory.mktemp("unlike") / "run"
    run(RunPlan(config, (1,), 4096, folder, 1, 1024))
    return folder


def test_each_weight_has_the_band_of_its_own_founders_and_mutations(unlike, watch):
    """Of 4000 neutral genes that the analysis simulates, 5 % are beyond the page's limits, which come from 400."""
    (world,) = read_worlds([open_run(unlike)])
    tree = walked_pedigree(world)
    assert tree is not None
    steps = world.population["step"].to_list()
    living = [living_at(tree, step) for step in steps]
    names = dict(zip(LAWS, world.reward_names, strict=True))
    with serving(run_server(unlike)) as server:
        watched = watch(server.link)
        watched.until(f"hedon.source.series.step.length === {len(steps)}")
        watched.get("hedon.tab('plots')")
        watched.until("hedon.source.loaded && hedon.plots.known === hedon.source.lives.size")
        watched.rest_at(4096)
        watched.until("!/^$|yet/.test(document.querySelector('.verdict').innerText)")
        said = watched.get(VERDICTS)
        assert list(said) == list(names)
        for (title, name), (step, mean, high, low) in zip(names.items(), watched.get(PLOTS), strict=True):
            assert step == steps
            walked = neutral_courses(
                tree, living, mutation_law(world.config, world.gene(name)), np.random.default_rng(1), 4000
            )
            share = ((walked < np.array(low)) | (walked > np.array(high))).mean(axis=0)
            assert (share > 0.015).all(), title  # the standard error of a share of 400 is 1.1 %
            assert (share < 0.09).all(), title
            assert numbers(said[title]) == pytest.approx([mean[-1], low[-1], high[-1]], abs=2e-3)
            where = "within" if low[-1] <= mean[-1] <= high[-1] else "outside"
            assert f"{where} drift" in said[title]


def test_a_band_is_left_out_if_a_parent_is_missing(unlike, tmp_path, watch):
    folder = tmp_path / "run"
    shutil.copytree(unlike, folder)
    for part in [*(folder / "agents").glob("*.parquet"), *folder.glob("living*.parquet")]:
        rows = pl.read_parquet(part)
        rows.filter(pl.col("parent_id").is_not_null()).write_parquet(part, compression="zstd")
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.series.step.length > 1 && hedon.source.loaded")
        watched.get("hedon.tab('plots')")
        watched.rest_at(4096)
        watched.until("!/^$|yet/.test(document.querySelectorAll('.verdict')[1].innerText)")
        said = watched.get(VERDICTS)
    assert "drift (" in said["weight of normal food"]  # from 16 recorded neutral genes with the same law
    assert said["weight of poison"] == "No band: the parents of some agents are not known."


def test_a_live_world_takes_the_laws_of_changed_settings(watch):
    changes = {"food.normal.gene.initial_mean": "1.5", "learning.policy": "random", "birth.mating": "none"}
    told = "".join(f"&set={path}%3D{value}" for path, value in changes.items())
    with serving(live_server("small")) as server:
        watched = watch(f"{server.link}#live=small{told}")
        watched.get("hedon.tab('plots')")
        for step in (256, 512):
            run_live(watched, step)
        watched.until("hedon.plots.points === 2")
        (step, mean, high, low), *_ = watched.get(PLOTS)
        assert step[-1] == 512
        assert low[-1] < 1.5 < high[-1] < low[-1] + 0.3
        assert low[-1] - 0.1 < mean[-1] < high[-1] + 0.1
        watched.get("hedon.source.acts.push({ step: 0, path: 'genome.mutation_scale', value: '1' })")
        run_live(watched, 768)
        watched.until("hedon.plots.points === 3")
        assert watched.get(PLOTS)[0][3][-1] is None


def test_an_empty_plot_says_when_it_fills(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        run_live(watched, 20)
        watched.get("hedon.tab('plots')")
        watched.until("document.querySelector('.empty').innerText.includes('Fills from step 512 on')")
        for step in (256, 512):  # a point at the end of each batch of steps that the page requests
            run_live(watched, step)
        watched.until("[...document.querySelectorAll('.empty')].every((each) => each.hidden)")


def test_two_parents_and_too_few_neutral_genes_leave_no_band_and_the_page_says_so(watch):
    overrides = ["genome.neutral_count=1", 'birth.mating="pairs"']
    page = {"run": False, "worlds": [live_world(load_config("small", overrides=overrides), "small")]}
    with serving(Server({"page": lambda: page}, dict)) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('plots')")
        watched.until("document.querySelector('.verdict').innerText.startsWith('No band: children have two parents')")
