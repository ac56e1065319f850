"""The items of the sequel, made from a small run of predators and prey: planned, run, found again and drawn."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest

from hedon.analysis.result import ResultTable
from hedon.analysis.world.population import death_rates
from hedon.ensemble.ensemble import Ensemble, find_ensemble
from hedon.ensemble.run_job import run_jobs
from hedon.figure.named import NamedFigure
from hedon.study.catalogue import choose
from hedon.study.gather import Gathered, gather
from hedon.study.item import ItemInputs
from hedon.study.request import Request, needs
from hedon_studies.fear.item import FRAMES, SEQUEL

ITEMS = ("sequel-history", "sequel-numbers", "sequel-deaths", "sequel-groups")
STEPS = 2 * FRAMES


@pytest.fixture(scope="module")
def request_(tmp_path_factory: pytest.TempPathFactory) -> tuple[Request, Path]:
    """A request for worlds of predators and prey, and the folder with the run that has them."""
    folder = tmp_path_factory.mktemp("sequel")
    request = Request(choose(ITEMS)[0].items, "corrected", (3,), STEPS)
    jobs = [job for job in run_jobs(Ensemble(needs(request), folder)) if job.plan.config.name == "predator"]
    assert [(job.plan.seeds, job.plan.steps, job.plan.frames) for job in jobs] == [((3,), STEPS, FRAMES)]
    jobs[0].make(1, None)
    return request, folder


@pytest.fixture(scope="module")
def gathered(request_: tuple[Request, Path]) -> Gathered:
    return gather(*request_)


def made(gathered: Gathered, name: str) -> list[NamedFigure | ResultTable]:
    (item,) = choose([name])[0].items
    return list(item.make(gathered.inputs(item)))


def test_a_run_of_two_species_is_found_and_serves_each_of_them(gathered: Gathered) -> None:
    (item,) = choose(["sequel-numbers"])[0].items
    worlds = gathered.inputs(item).worlds
    assert {label: [(world.species, world.seed) for world in group] for label, group in worlds.items()} == {
        "prey": [("prey", 3)],
        "predators": [("predator", 3)],
    }
    names = [world.condition for world in gathered.demanded()]
    assert names == ["prey", "predators"], "the labels of the conditions"
    assert gathered.faults == ()


def test_only_worlds_that_lack_positions_are_run_again(request_: tuple[Request, Path]) -> None:
    request, folder = request_
    assert [job.plan.config.name for job in run_jobs(find_ensemble(needs(request), folder))] == ["predator-square"]
    (job,) = (job for job in run_jobs(Ensemble(needs(request), folder)) if job.plan.config.name == "predator")
    finer = next(need for need in needs(request) if need.config == job.plan.config)
    finer.frames = FRAMES // 2
    assert [job.plan.frames for job in run_jobs(find_ensemble([finer], folder))] == [FRAMES // 2]
    finer.frames = 0
    assert run_jobs(find_ensemble([finer], folder)) == []


def test_each_species_has_its_own_history(gathered: Gathered) -> None:
    figures = [part for part in made(gathered, "sequel-history") if isinstance(part, NamedFigure)]
    titles = {figure.name: [axes.get_title("left") for axes in figure.figure.axes] for figure in figures}
    assert titles["sequel-history-prey"][:4] == [
        "weight of normal food",
        "weight of action",
        "weight of seeing prey",
        "weight of seeing predator",
    ]
    assert "weight of normal food" not in titles["sequel-history-predator"]
    assert "Not run yet: prey, square arena" in figures[0].caption


def test_the_figure_shows_the_numbers_of_the_table(gathered: Gathered) -> None:
    (figure,) = made(gathered, "sequel-numbers")
    assert isinstance(figure, NamedFigure)
    worlds = {world.species: world for world in gathered.demanded()}
    _, phase = figure.figure.axes
    line, end = phase.lines
    counts = [worlds[name].population["alive"].to_numpy() for name in ("prey", "predator")]
    assert np.array_equal(line.get_xydata(), np.transpose(counts))
    assert np.array_equal(end.get_xydata(), np.transpose(counts)[-1:])


def test_deaths_by_cause_add_up_to_all_deaths(gathered: Gathered) -> None:
    figure, table = made(gathered, "sequel-deaths")
    assert isinstance(figure, NamedFigure)
    assert isinstance(table, ResultTable)
    rows = table.rows.to_dicts()
    worlds = {world.species: world for world in gathered.demanded()}
    assert rows[0]["deaths"] == worlds["prey"].population["deaths"].sum() > 0
    assert rows[0]["eaten"] == worlds["predator"].population["eaten_prey"].sum() > 0
    for row in rows:
        assert row["age_energy"] + row["starved"] + row["eaten"] == row["deaths"]


def test_rates_of_death_are_counts_over_steps_lived() -> None:
    deaths = {"deaths": [5, 1, 0], "deaths_starved": [1, 0, 0], "deaths_eaten": [3, 1, 0]}
    lived = {"world": [0, 0, 0], "step": [100, 200, 300], "agent_steps": [2000, 500, 0]}
    rows = death_rates(pl.DataFrame(lived | deaths), points=3)
    assert rows["age_energy"].to_list() == [5.0, 0.0, None]
    assert rows["starved"].to_list() == [5.0, 0.0, None]
    assert rows["eaten"].to_list() == [15.0, 20.0, None]


def test_groups_come_from_the_recorded_positions(gathered: Gathered) -> None:
    figure, table = made(gathered, "sequel-groups")
    assert isinstance(figure, NamedFigure)
    assert isinstance(table, ResultTable)
    (row,) = table.rows.to_dicts()
    assert row["seed"] == 3
    assert 1 <= row["group"] <= row["alive"] <= 450
    assert 0 < row["distance"] < 1200


@pytest.mark.parametrize("item", SEQUEL, ids=lambda item: item.name)
def test_without_worlds_each_item_says_what_is_missing(item) -> None:
    parts = list(item.make(ItemInputs("corrected")))
    captions = [part.caption for part in parts if isinstance(part, NamedFigure)]
    notes = [part.note for part in parts if isinstance(part, ResultTable)]
    assert any("Not run yet" in text for text in (*captions, *notes))
