"""The plots of the page show all seeds of a run on request, and how a weight is distributed among the living."""

import shutil

import numpy as np
import polars as pl
import pytest
from split_run import record_species
from view_page import live_server, run_live, run_server, serving

from hedon.record.reader import open_run

pytest_plugins = ("view_fixture",)

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
NAMES = ("q05", "q25", "median", "q75", "q95")


def plot(title):
    """JavaScript that finds a plot by its title."""
    return f"hedon.plots.plots.find(({{ content }}) => content.title === '{title}')"


def drawn(watched, title):
    """The numbers that are drawn in a plot, steps first."""
    return watched.get(f"{plot(title)}.chart.data.map((column) => [...column])")


@pytest.fixture(scope="module")
def several(tmp_path_factory):
    """Three seeds of prey and predators."""
    return open_run(record_species(tmp_path_factory.mktemp("seeds") / "run", steps=640, seeds=(4, 7, 9)))


def test_other_seeds_are_read_and_drawn_only_on_request(several, watch):
    rows = several.population().sort("step")
    steps = rows["step"].unique().sort().to_list()

    def column(seed, species, name):
        return rows.filter(seed=seed, species=species)[name].to_list()

    with serving(run_server(several.path)) as server:
        watched = watch(f"{server.link}#world=1")
        asked = []
        watched.page.on("request", lambda request: asked.append(request.url))
        watched.until(f"hedon.source.series.step.length === {len(steps)} && hedon.source.loaded")
        watched.get("hedon.tab('plots')")
        watched.until(f"hedon.plots.points === {len(steps)}")
        before = drawn(watched, "agents alive")
        assert before == [steps, column(7, "prey", "alive"), column(7, "predator", "alive")]
        assert watched.get("hedon.source.others.length") == 0
        asked.clear()
        watched.page.get_by_label("all seeds (3)").check()
        watched.until("hedon.plots.seeds === 2")
        assert [url.split("/run/")[1] for url in asked if "population" in url] == [
            path.relative_to(several.path).as_posix() for path in sorted((several.path / "population").iterdir())
        ]
        wanted = [column(seed, species, "alive") for seed in (4, 9, 7) for species in ("prey", "predator")]
        assert drawn(watched, "agents alive") == [steps, *wanted]
        mean = drawn(watched, "prey: weight of normal food")
        assert mean[1:4] == [column(seed, "prey", "w_normal_mean") for seed in (4, 9, 7)]
        widths = watched.get("hedon.plots.plots.at(-1).chart.series.slice(1).map((each) => each.width)")
        assert widths == [1, 1, 2]

        with watched.page.expect_download() as download:
            watched.page.get_by_role("button", name="CSV of mean energy").click()
        table = pl.read_csv(download.value.path())
        assert table.columns == ["seed", "species", "step", "energy_mean"]
        for seed in (4, 7, 9):
            for species in ("prey", "predator"):
                own = table.filter(seed=seed, species=species)
                assert own["energy_mean"].to_list() == column(seed, species, "energy_mean")
        said = watched.get("document.querySelector('.readout').textContent")
        assert "(other seeds " in said

        watched.page.get_by_label("all seeds (3)").uncheck()
        watched.until("hedon.plots.seeds === 0")
        assert drawn(watched, "agents alive") == before


def test_a_seed_that_died_out_ends_before_the_others(several, tmp_path, watch):
    folder = tmp_path / "run"
    shutil.copytree(several.path, folder)
    every = several.population().sort("step")
    steps = every["step"].unique().sort().to_list()
    for path in (folder / "population").glob("*.parquet"):
        rows = pl.read_parquet(path)
        rows.filter((pl.col("seed") != 4) | (pl.col("step") < steps[-2])).write_parquet(path, compression="zstd")
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.series.step.length > 1 && hedon.source.loaded")
        watched.get("hedon.tab('plots')")
        assert drawn(watched, "agents alive")[0] == steps[:-2]
        watched.page.get_by_label("all seeds (3)").check()
        watched.until("hedon.plots.seeds === 2")
        step, *others, prey, _ = drawn(watched, "agents alive")
        assert step == steps
        assert others[0] == every.filter(seed=7, species="prey")["alive"].to_list()
        assert prey == [*every.filter(seed=4, species="prey")["alive"].to_list()[:-2], None, None]


def test_further_runs_are_drawn_over_the_first(several, run_folder, tmp_path, watch):
    """Each has the name of its folder and its own line style; a run with other species adds what it has."""
    copy = tmp_path / "second, changed"
    shutil.copytree(several.path, copy)
    for path in (copy / "population").glob("*.parquet"):
        rows = pl.read_parquet(path)
        rows.with_columns(energy_mean=pl.col("energy_mean") + 1).write_parquet(path, compression="zstd")
    every = several.population().sort("step")
    steps = every["step"].unique().sort().to_list()
    with serving(run_server(several.path, copy, run_folder)) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('plots')")
        watched.until(f"hedon.plots.points === {len(steps)} && hedon.plots.seeds === 6")
        assert watched.page.get_by_label("all runs and seeds (7)").is_checked(), "several runs are meant to be compared"
        key = f"solid: run, dashed: second, changed, dotted: {run_folder}"
        assert watched.page.locator(".runs").text_content() == key
        step, *columns = drawn(watched, "mean energy")
        at = [step.index(each) for each in steps]
        energy = [
            every.filter(seed=seed, species=species)["energy_mean"]
            for seed in (4, 7, 9)
            for species in ("prey", "predator")
        ]
        assert [[column[i] for i in at] for column in columns[4:10]] == [(each + 1).to_list() for each in energy]
        series = f"{plot('mean energy')}.chart.series.slice(1).map(({{ width, dash }}) => [width, dash?.length ?? 0])"
        assert watched.get(series) == [*[[1, 0]] * 4, *[[2, 2]] * 8, *[[2, 0]] * 2]
        notes = watched.get(f"{plot('mean energy')}.content.notes().map(({{ label }}) => label)")
        assert notes == [
            "thin: seeds 7, 9; thick: seed 4",
            "dashed: second, changed, seeds 4, 7, 9",
            f"{run_folder} has no such values",
        ]
        with watched.page.expect_download() as download:
            watched.page.get_by_role("button", name="CSV of mean energy").click()
        table = pl.read_csv(download.value.path())
        assert table.columns == ["run", "seed", "species", "step", "energy_mean"]
        changed = table.filter(run="second, changed", seed=9, species="prey")
        assert changed["energy_mean"].to_list() == (every.filter(seed=9, species="prey")["energy_mean"] + 1).to_list()


def test_one_seed_offers_no_others(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        assert watched.page.locator("#all-seeds").count() == 0


def recorded_quantiles(agents, steps, gene):
    """The quantiles of a gene among the agents alive at each step, from the table `agents`."""
    births, deaths = agents["birth_step"].to_numpy(), agents["death_step"].fill_null(2**40).to_numpy()
    genes = agents[gene].to_numpy().astype(np.float64)
    return [np.quantile(genes[(births <= step) & (deaths > step)], SHARES).tolist() for step in steps]


def test_a_distribution_has_the_quantiles_of_the_living(several, watch):
    steps = several.population()["step"].unique().sort().to_list()
    agents = several.agents()
    with serving(run_server(several.path)) as server:
        watched = watch(f"{server.link}#world=2")
        watched.until(f"hedon.source.series.step.length === {len(steps)} && hedon.source.loaded")
        watched.get("hedon.tab('plots')")
        title = "predator: weight of prey, distribution"
        for species, name, of in (("prey", "w_action", "action"), ("predator", "w_prey", "prey")):
            title = f"{species}: weight of {of}, distribution"
            watched.until(f"{plot(title)}.chart.data[1].at(-1) !== null")
            step, *columns = drawn(watched, title)
            assert step == steps
            own = agents.filter(seed=9, species=species)
            wanted = recorded_quantiles(own, steps, name)
            assert np.array(columns).T.tolist() == pytest.approx(np.array(wanted), abs=1e-12)
            with watched.page.expect_download() as download:
                watched.page.get_by_role("button", name=f"CSV of {title}").click()
            table = pl.read_csv(download.value.path())
            assert table.columns == ["seed", "species", "step", *(f"{name}_{each}" for each in NAMES)]
            assert table.drop("seed", "species", "step").rows() == [tuple(row) for row in np.array(columns).T.tolist()]


def test_a_split_that_the_mean_hides_is_seen(several, tmp_path, watch):
    """Half of the prey get a weight near +1, half near -1: the plot is dark at both and pale in between."""
    folder = tmp_path / "run"
    shutil.copytree(several.path, folder)
    for path in (folder / "agents").glob("*.parquet"):
        rows = pl.read_parquet(path)
        side = pl.when(pl.col("agent_id") % 2 == 0).then(1.0).otherwise(-1.0).cast(pl.Float32)
        rows.with_columns(w_normal=side + pl.col("w_normal") * 0.05).write_parquet(path, compression="zstd")
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.series.step.length > 1 && hedon.source.loaded")
        watched.get("hedon.tab('plots')")
        title = "prey: weight of normal food, distribution"
        find = plot(title)
        watched.until(f"{find}.chart.data[1].at(-1) !== null && {find}.content.drawn !== ''")
        darkness = watched.get(
            f"""[1, 0, -1].map((value) => {{
              const {{ chart, content: {{ heat }} }} = {find};
              const y = Math.round(chart.valToPos(value, 'y', true) - chart.bbox.top);
              const data = heat.getContext('2d').getImageData(0, y - 6, heat.width, 12).data;
              return data.filter((_, i) => i % 4 === 3).reduce((sum, each) => sum + each, 0) / data.length * 4 / 255;
            }})"""
        )
        assert min(darkness[0], darkness[2]) > 0.25
        assert darkness[1] < 0.02


def test_a_live_world_has_distributions_too(watch):
    with serving(live_server("small")) as server:
        watched = watch(server.link)
        watched.get("hedon.tab('plots')")
        for step in (256, 512, 768):
            run_live(watched, step)
        title = "weight of normal food, distribution"
        watched.until("hedon.plots.points === 3")
        watched.until(f"{plot(title)}.chart.data[1].length === 3")
        gene = watched.get("hedon.source.layout.genes.findIndex(({ name }) => name === 'w_normal')")
        genes = watched.get(
            f"[...hedon.source.lives.all()].filter(({{ death }}) => death < 0).map(({{ genome }}) => genome[{gene}])"
        )
        assert len(genes) == watched.get("hedon.source.series.get('alive').at(-1)")
        assert [column[-1] for column in drawn(watched, title)[1:]] == pytest.approx(
            np.quantile(genes, SHARES).tolist()
        )


def test_no_distribution_is_shown_if_lives_are_missing(several, tmp_path, watch):
    folder = tmp_path / "run"
    shutil.copytree(several.path, folder)
    (folder / "agents" / "living.parquet").unlink()
    with serving(run_server(folder)) as server:
        watched = watch(server.link)
        watched.until("hedon.source.series.step.length > 1 && hedon.source.loaded")
        watched.get("hedon.tab('plots')")
        watched.until("document.body.innerText.includes('The lives of some of the living are not known.')")
