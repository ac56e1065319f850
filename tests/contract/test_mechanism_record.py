"""Records depend on the mechanisms of a world, not on its number of species, and every command accepts such runs.

The species of each world differ in their mechanisms: who eats whom, who starves, who mates and who has which genes.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from mechanism_world import STEPS, WORLDS, mechanism_config, mechanism_run
from resumed_run import assert_same_run

from hedon.analysis.world.ledger import interval_residuals
from hedon.check.run import check_run
from hedon.config.load import load_config
from hedon.experiment.branch import branch
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import resume
from hedon.record.error import RecordError
from hedon.record.reader import Run, open_run
from hedon.record.schema import Columns, run_tables

CUT = 150
HUNTS = {"deaths_eaten", "energy_hunted", "energy_prey"}


@pytest.fixture(scope="module", params=WORLDS)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An uninterrupted run of two worlds."""
    folder = tmp_path_factory.mktemp("mechanism") / "run"
    mechanism_run(mechanism_config(request.param), folder)
    return folder


def ledgers(run: Run) -> Iterator[tuple[pl.DataFrame, pl.DataFrame]]:
    """The rows of the tables `population` and `agents` for each species of each world."""
    population, agents = run.population(), run.agents()
    for seed in run.manifest.seeds:
        for species in run.columns.species:
            here = pl.col("seed") == seed
            if run.columns.several:
                here &= pl.col("species") == species
            yield population.filter(here), agents.filter(here)


def test_columns_follow_from_mechanisms(made: Path) -> None:
    run = open_run(made)
    config = load_config(made / "config.toml")
    eats = any(name in config.species for each in config.species.values() for name, _ in each.diet.eats)
    starves = any(each.energy.at_zero == "death" for each in config.species.values())
    assert ("cause" in run.agents().columns) == ("deaths_starved" in run.population().columns) == (eats or starves)
    assert (set(run.population().columns) & HUNTS == HUNTS) == eats
    assert bool(run.columns.prey) == eats


def test_causes_and_hunts_are_counted(made: Path) -> None:
    """The two tables agree, and the meals of the eaters match the agents that were eaten."""
    run = open_run(made)
    agents, population = run.agents(), run.population()
    if not run.columns.has_causes:
        return
    dead = agents.filter(pl.col("death_step").is_not_null())
    assert dead["cause"].null_count() == 0
    for cause, column in (("starved", "deaths_starved"), ("eaten", "deaths_eaten")):
        if column in population.columns:
            assert (dead["cause"] == cause).sum() == population[column].sum()
    each = load_config(made / "config.toml").world.prey_sharing == "each"
    for name in run.columns.prey:
        own = pl.col("species") == name if run.columns.several else pl.lit(value=True)
        eaten = population.filter(own)["deaths_eaten"].sum()
        assert eaten > 0, "the world has no hunt, so it tests nothing"
        assert agents[f"eaten_{name}"].sum() == population[f"eaten_{name}"].sum()
        assert agents[f"eaten_{name}"].sum() >= eaten if each else agents[f"eaten_{name}"].sum() == eaten


def test_the_ledger_of_each_species_closes(made: Path) -> None:
    for population, agents in ledgers(open_run(made)):
        assert np.nanmax(interval_residuals(population, agents)) < 1e-6


def test_a_check_and_a_replay_find_nothing(made: Path) -> None:
    assert check_run(made).findings == ()
    assert replay_run(made, threads=1)[0] == ()


def test_a_resumed_run_has_the_same_rows(made: Path, tmp_path: Path) -> None:
    mechanism_run(load_config(made / "config.toml"), tmp_path / "run", CUT)
    resume(tmp_path / "run", STEPS, 1)
    assert_same_run(tmp_path / "run", made)


def test_a_branch_keeps_its_counts_and_cannot_begin_to_starve(tmp_path: Path) -> None:
    mechanism_run(mechanism_config("one species that starves"), tmp_path / "run", CUT)
    branch(tmp_path / "run", tmp_path / "branch", ["hazard.kappa=0.1"], steps=STEPS)
    assert check_run(tmp_path / "branch").findings == ()
    with pytest.raises(RecordError, match=r"a branch cannot change energy\.at_zero"):
        branch(tmp_path / "run", tmp_path / "no", ['energy.at_zero="floor"'], steps=STEPS)


def test_an_older_manifest_has_the_columns_of_its_version() -> None:
    """Earlier versions recorded all columns of causes and hunts for several species, and none for one species."""
    several = run_tables(Columns(("normal",), 1, species=("a", "b")))
    assert {"cause"} < set(several["agents"].polars_schema)
    assert HUNTS | {"deaths_starved"} < set(several["population"].polars_schema)
    one = run_tables(Columns(("normal",), 1))
    assert not (HUNTS | {"deaths_starved", "cause"}) & {name for table in one.values() for name in table.polars_schema}
