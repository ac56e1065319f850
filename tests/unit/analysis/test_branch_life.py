"""Lives in a branch: the agents alive at its start are survivors and must not make lives look longer."""

from pathlib import Path

import polars as pl
import pytest
from worlds import QUICK

from hedon import RunPlan, branch, load_config, open_run, resume, run
from hedon.analysis import read_worlds
from hedon.analysis.topic.life import lifetime, reproductive_success
from hedon.analysis.topic.selection import price_topic
from hedon.check.difference import compare_runs
from hedon.measure.summary import summarize

STEPS, MIDDLE = 1024, 512
LIVELY = (
    *QUICK,
    "birth.kappa=0.02",
    "hazard.alpha_age=0.005",
    "population.capacity=120",
    "population.initial_count=60",
)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A run, and the second half of the same world as a branch without changes."""
    folder = tmp_path_factory.mktemp("branch")
    config = load_config("baseline", overrides=LIVELY)
    run(RunPlan(config, (1,), MIDDLE, folder / "half", 1))
    branch(folder / "half", folder / "branch", steps=STEPS, threads=1)
    run(RunPlan(config, (1,), STEPS, folder / "whole", 1))
    return folder / "whole", folder / "branch"


def test_lives_of_a_branch_are_those_of_the_run_born_after_its_start(runs):
    (whole,), (later,) = (read_worlds([open_run(folder)]) for folder in runs)
    assert (whole.first_step, later.first_step) == (0, MIDDLE)
    assert whole.born.equals(whole.agents)
    expected = whole.agents.filter(pl.col("birth_step") > MIDDLE)
    assert later.born["agent_id"].to_list() == expected["agent_id"].to_list()
    assert 20 < later.born.height < later.agents.height
    dead = expected.filter(pl.col("death_step").is_not_null())
    mean = float((dead["death_step"] - dead["birth_step"]).to_numpy().mean())
    row = lifetime({"a": [later]})[1].rows.row(0, named=True)
    assert (row["agents"], row["died"]) == (expected.height, dead.height)
    assert row["mean_of_dead"] == pytest.approx(mean)
    (world,) = summarize(open_run(runs[1]))["worlds"]
    assert world["mean_lifetime"] == pytest.approx(mean)


def test_cohorts_of_a_branch_exclude_agents_born_before_it(runs):
    (later,) = read_worlds([open_run(runs[1])])
    rows = reproductive_success({later.condition: [later]})[1].rows
    assert rows["agents"].sum() == later.born.height
    assert all(table.rows.height for table in price_topic({later.condition: [later]}))


def test_a_resumed_branch_of_two_species_is_still_a_branch(tmp_path: Path) -> None:
    lively = ("species.prey.birth.kappa=0.02", "species.prey.hazard.alpha_age=0.004")
    config = load_config("predator", overrides=[*QUICK, *lively])
    run(RunPlan(config, (1,), 128, tmp_path / "half", 1))
    branch(tmp_path / "half", tmp_path / "branch", steps=192, threads=1)
    resume(tmp_path / "branch", steps=256, threads=1)
    run(RunPlan(config, (1,), 256, tmp_path / "whole", 1))
    whole, later = ({w.species: w for w in read_worlds([open_run(tmp_path / name)])} for name in ("whole", "branch"))
    assert {world.first_step for world in later.values()} == {128}
    for name, world in later.items():
        expected = whole[name].agents.filter(pl.col("birth_step") > 128)["agent_id"].to_list()
        assert world.born["agent_id"].to_list() == expected
    assert later["prey"].born.height > 0
    assert compare_runs(tmp_path / "whole", tmp_path / "branch").same
