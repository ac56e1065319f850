"""Summaries, reports, sweeps and notebooks treat the species of a world separately if they differ."""

import io
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import polars as pl
import pytest
from mechanism_world import CROWDED, WORLDS, mechanism_config, mechanism_run
from project_files import ROOT
from rich.console import Console

from hedon.analysis.agent.lifetime import mean_lifetime
from hedon.analysis.gene.weight import last_lived_step, last_living
from hedon.analysis.world.budget import energy_budget
from hedon.analysis.world.ledger import interval_residuals
from hedon.analysis.world.population import extinct_step, history, last_generation, mean_alive, mean_energy
from hedon.analysis.world.record import read_worlds
from hedon.analysis.world.regime import regimes
from hedon.analysis.world.species import by_species
from hedon.assay.end import read_ends
from hedon.cli.display.summary import summary_table
from hedon.compare.response import responses
from hedon.config.load import load_config
from hedon.ensemble.row import world_rows
from hedon.error import ArgumentError
from hedon.measure.summary_key import CAUSE_KEYS, FARE_KEYS, HUNT_KEYS, MEAN_KEYS, SEVERAL_KEYS, WORLD_SEVERAL_KEYS
from hedon.record.reader import Run, open_run
from hedon.report.run import run_summary, write_report

DIFFERENT = "species that differ in everything"


@pytest.fixture(scope="module", params=WORLDS)
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("told") / "run"
    mechanism_run(mechanism_config(request.param), folder)
    return open_run(folder)


@pytest.fixture(scope="module")
def different(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("different") / "run"
    mechanism_run(mechanism_config(DIFFERENT), folder)
    return open_run(folder)


def fares(summary: dict[str, Any]) -> list[dict[str, Any]]:
    """The numbers of each species in each world of a summary."""
    return [fare for world in summary["worlds"] for fare in world.get("species", {"": world}).values()]


def test_each_species_has_its_own_numbers(run: Run) -> None:
    summary, agents, population = run_summary(run), run.agents(), run.population()
    for index, world in enumerate(summary["worlds"]):
        here = pl.col("world") == index
        lives, rows = (by_species(table.filter(here), run.columns) for table in (agents, population))
        mine = world.get("species", {run.columns.species[0]: world})
        assert list(mine) == list(run.columns.species)
        for name, fare in mine.items():
            assert fare["alive"] == lives[name]["death_step"].null_count() == rows[name]["alive"][-1]
            assert fare["births"] == lives[name]["parent_id"].count()
            assert fare["deaths"] == lives[name]["death_step"].count()
            assert fare["mean_lifetime"] == mean_lifetime(lives[name])
            assert fare["eaten"] == {meal: lives[name][f"eaten_{meal}"].sum() for meal in fare["eaten"]}
            ends = lives[name]["death_step"]
            gone = None if fare["alive"] else int(ends.to_numpy().max(initial=0))
            assert (fare["extinct"], fare["extinct_step"]) == (gone is not None, gone)
        if run.columns.several:
            for key in ("alive", "births", "deaths"):
                assert world["total"][key] == sum(fare[key] for fare in mine.values())


def test_the_guide_counts_the_living_of_each_species_as_the_summary_does(different: Run) -> None:
    (block,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs/guide/species.md").read_text(), re.DOTALL)
    scope: dict[str, Any] = {}
    exec(block, scope)
    for world in run_summary(different)["worlds"]:
        told = scope["alive"](str(different.path), world["seed"])
        assert told == {name: fare["alive_mean"] for name, fare in world["species"].items()}


def test_every_ledger_closes_and_its_sums_agree(run: Run) -> None:
    for fare in fares(run_summary(run)):
        ledger = fare["ledger"]
        assert ledger["residual"] < 1e-6
        gained = ledger["initial"] + ledger["eaten"] + ledger.get("hunted", 0.0) + ledger["forgiven"]
        spent = ledger["basic"] + ledger["action"] + ledger.get("damage", 0.0) + ledger["capped"] + ledger["lost"]
        assert ledger["final"] == pytest.approx(gained - spent, abs=1e-6)


def test_every_key_is_documented(run: Run) -> None:
    summary = run_summary(run)
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary
    if run.columns.several:
        assert set(summary) == set(SEVERAL_KEYS)
        assert all(set(world) == set(WORLD_SEVERAL_KEYS) for world in summary["worlds"])
    hunts = set(HUNT_KEYS) if run.columns.prey else set()
    causes = set(CAUSE_KEYS) if run.columns.prey else {"deaths_starved"} if run.columns.has_causes else set()
    for means in summary.get("species", {}).values():
        assert set(means) == set(MEAN_KEYS) | hunts
    for fare in fares(summary):
        assert set(fare) - {"seed", "steps", "steps_per_second"} == set(FARE_KEYS) | causes


def test_the_table_at_the_end_has_every_species(run: Run) -> None:
    console = Console(width=140, record=True, file=io.StringIO())
    console.print(summary_table(run_summary(run)))
    printed = console.export_text()
    for name in run.columns.species if run.columns.several else ():
        assert f"{name}: weights of those alive at the end" in printed


def test_a_report_fits_what_each_species_eats(different: Run, tmp_path: Path) -> None:
    paths = write_report(different, folder=tmp_path)
    assert all(path.exists() for path in paths)
    text = (tmp_path / "report.md").read_text()
    assert "pays for 0 of" not in text
    assert "It eats no food, but prey" in text
    assert "It eats nothing" in text
    assert "| energy.at_zero |" not in text, "the hunters' value is not a change in the run's own section"
    food = pl.read_csv(tmp_path / "analysis/food_world.csv")
    kinds = {name: set(food.filter(pl.col("condition").str.ends_with(name))["kind"]) for name in ("prey", "hunter")}
    assert kinds == {"prey": {"normal", "poison"}, "hunter": {"prey"}}
    hunted = pl.read_csv(tmp_path / "analysis/energy_world.csv").group_by("condition").agg(pl.col("hunted").sum())
    assert {name.rpartition(" ")[2]: total > 0 for name, total in hunted.iter_rows()}["hunter"]


def test_rows_of_several_species_are_refused_where_they_would_be_mixed(different: Run) -> None:
    agents, population = different.agents(), different.population()
    one = population.filter(pl.col("world") == 0)
    for mixing in (
        lambda: mean_alive(one),
        lambda: mean_energy(one),
        lambda: last_generation(one),
        lambda: extinct_step(one),
        lambda: energy_budget(one),
        lambda: interval_residuals(one, None),
        lambda: history(population, ()),
        lambda: regimes(one, mechanism_config(DIFFERENT)),
        lambda: last_living(agents, one.filter(pl.col("species") == "prey")),
        lambda: last_lived_step(one),
    ):
        with pytest.raises(ArgumentError, match=r"rows are of several species \(.*\): choose one"):
            mixing()


def test_a_world_knows_what_its_species_eat_and_inherit(different: Run) -> None:
    worlds = {world.species: world for world in read_worlds([different]) if world.seed == 1}
    assert worlds["prey"].food_kinds == ("normal", "poison")
    assert (worlds["hunter"].food_kinds, worlds["hunter"].prey) == ((), ("prey",))
    assert len(worlds["prey"].neutral_names) == 3 < len(worlds["hunter"].neutral_names)
    assert worlds["late"].extinct_step == 0, "the species was never present"
    assert all(worlds[name].apart_step == 0 for name in ("prey", "hunter", "idle"))
    regime = regimes(worlds["hunter"].population, worlds["hunter"].config, species="hunter")
    assert np.isnan([each["uptake"] for each in regime]).all(), "a species that eats no food takes up none"


def test_a_sweep_has_columns_per_species(different: Run) -> None:
    summary = run_summary(different)
    rows = world_rows(summary, ("a", "b"))
    table = pl.DataFrame(rows, infer_schema_length=None)
    assert table["prey.alive"].to_list() == [world["species"]["prey"]["alive"] for world in summary["worlds"]]
    assert table["total_alive"].to_list() == [world["total"]["alive"] for world in summary["worlds"]]
    assert "alive" not in table.columns
    assert table["hunter.ledger_residual"].to_numpy().max() < 1e-6
    shown = responses(table, (), ("energy.initial",))
    assert shown["prey.alive_mean"] == "agents alive, last tenth: prey"
    assert shown["hunter.w_see_prey_mean"] == "mean of w_see_prey: hunter"
    assert not any(name.startswith("total") for name in shown)


def test_a_notebook_shows_each_species(different: Run) -> None:
    shown = ElementTree.fromstring(different._repr_html_().replace("<br>", "<br/>"))
    rows = [[cell.text for cell in row] for row in shown.findall("table/tbody/tr")]
    last = different.population().filter(pl.col("step") == pl.col("step").max())
    assert [row[:2] for row in rows] == [[str(seed), name] for seed in (1, 2) for name in different.columns.species]
    assert [int(row[3] or "") for row in rows] == last.sort("world", maintain_order=True)["alive"].to_list()
    figure = shown.find("svg")
    assert figure is not None
    assert len(figure.findall("polyline")) == len(rows)


def test_ends_are_those_of_one_species(different: Run, tmp_path: Path) -> None:
    config = mechanism_config(DIFFERENT)
    (tmp_path / "summary.json").write_text(json.dumps(run_summary(different)))
    for source in (different.path, tmp_path / "summary.json"):
        ends = read_ends(source, config, "hunter")
        assert len(ends) == 2
        assert all("w_see_prey" in end.weights and "w_normal" not in end.weights for end in ends)


def test_one_species_keeps_the_keys_that_tools_read(tmp_path: Path) -> None:
    config = load_config("baseline", overrides=CROWDED)
    mechanism_run(replace(config), tmp_path / "run")
    summary = run_summary(open_run(tmp_path / "run"))
    assert set(MEAN_KEYS) < set(summary)
    assert "species" not in summary
    ledger = ["initial", "eaten", "forgiven", "basic", "action", "capped", "lost", "shared", "final", "residual"]
    assert list(summary["worlds"][0]["ledger"]) == ledger
