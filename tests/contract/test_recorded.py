"""How records, checks, exports, topics and forecasts handle two parents, obstacles and stores."""

import shutil
from pathlib import Path

import polars as pl
import pytest
from two_stores import FED
from worlds import QUICK

from hedon.analysis.world.record import by_condition, read_worlds
from hedon.check.run import check_run
from hedon.config import Config, load_config
from hedon.demography.forecast import setting_warnings
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.export.phylogeny import alife_table, newick, pedigree
from hedon.export.table import ExportError
from hedon.record.reader import Run, open_run
from hedon.report.topic import ONE_PARENT, run_topics

MATING = ("birth.mating=pairs", "birth.mating_range=60", "birth.kappa=0.02", "birth.beta=10")
WORLD = ("obstacle.count=6", "obstacle.damage=0.2", *FED)


def config() -> Config:
    return load_config("baseline", overrides=[*QUICK, *MATING, *WORLD])


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("recorded") / "run"
    run(RunPlan(config(), [1, 2], 640, folder, 1))
    return open_run(folder)


def test_the_check_finds_nothing_and_the_ledger_has_the_damage(recorded: Run) -> None:
    assert not check_run(recorded.path).findings
    rows = recorded.population()
    assert rows["energy_damage"].sum() == pytest.approx(0.2 * float(rows["obstacles_touched"].sum()))
    assert rows["obstacles_touched"].sum() > 0
    assert rows["nutrient_mean"].is_between(0, 400).all()
    places = recorded.manifest.obstacle_places
    assert [len(world) for world in places] == [6, 6]
    assert places[0] != places[1]


def test_a_child_whose_two_parents_are_one_is_found(recorded: Run, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(recorded.path, copy)
    path = copy / "agents" / "living.parquet"
    rows = pl.read_parquet(path)
    child = rows.filter(pl.col("mate_id").is_not_null())["agent_id"][0]
    mine = pl.col("agent_id") == child
    rows.with_columns(mate_id=pl.when(mine).then("parent_id").otherwise("mate_id")).write_parquet(path)
    assert any("its two parents are one" in str(each) for each in check_run(copy).findings)


def test_pedigrees_of_two_parents_are_not_trees(recorded: Run) -> None:
    agents = pedigree(recorded, 1)
    both = alife_table(agents, ())["ancestor_list"].str.count_matches(",")
    assert both.to_list() == agents["mate_id"].is_not_null().cast(pl.UInt32).to_list()
    assert both.sum() > 0
    with pytest.raises(ExportError, match="two parents"):
        newick(agents, 640)


def test_topics_that_follow_one_parent_leave_such_worlds_out(recorded: Run) -> None:
    conditions = by_condition(read_worlds([recorded]))
    assert run_topics(conditions, ONE_PARENT) == []
    assert run_topics(conditions, ("food",)) != []


def test_the_forecast_names_what_it_leaves_out() -> None:
    said = " ".join(setting_warnings(config()))
    for word in ("Obstacles cost 0.2 energy", "Without nutrient", "two parents", "Toxin"):
        assert word in said
    assert "parents" not in " ".join(setting_warnings(load_config("baseline")))
