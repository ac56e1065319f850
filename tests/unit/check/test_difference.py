"""Comparing two runs: their settings, and the first window and quantity in which their worlds diverge."""

import shutil
from dataclasses import replace
from pathlib import Path

import polars as pl
import pytest
from resumed_run import WINDOW, small_run
from typer.testing import CliRunner

from hedon import branch, open_run
from hedon.check.difference import compare_runs
from hedon.cli.main import app
from hedon.record.manifest import load_manifest, save_manifest


def said(*folders: Path) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["check", str(folders[0]), "--against", str(folders[1])])
    assert done.exception is None or isinstance(done.exception, SystemExit), repr(done.exception)
    return done.exit_code, done.output


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs")
    small_run(folder / "a", 4 * WINDOW)
    small_run(folder / "again", 4 * WINDOW)
    small_run(folder / "longer", 6 * WINDOW)
    return folder


def test_equal_runs_are_equal_even_if_one_is_longer(runs):
    code, text = said(runs / "a", runs / "again")
    assert code == 0, text
    assert f"seed 1: equal up to step {4 * WINDOW}" in text
    code, text = said(runs / "a", runs / "longer")
    assert code == 0, text
    assert f"seed 2: equal up to step {4 * WINDOW}" in text


@pytest.mark.parametrize("steps", [2 * WINDOW, 2 * WINDOW + 20])
def test_an_unchanged_branch_is_equal_from_its_start_on(runs, tmp_path, steps):
    small_run(tmp_path / "part", steps)
    branch(tmp_path / "part", tmp_path / "branch", steps=4 * WINDOW, threads=1)
    assert open_run(runs / "a").agents().filter(pl.col("death_step") <= steps).height, "some die before it starts"
    for pair in ((runs / "a", tmp_path / "branch"), (tmp_path / "branch", runs / "a")):
        code, text = said(*pair)
        assert code == 0, text
        assert f"seed 1: equal from step {steps} up to step {4 * WINDOW}" in text
    code, text = said(tmp_path / "part", tmp_path / "branch")
    assert code == 0, text
    assert f"seed 1: no step in common: one has records up to {steps}, the other from {steps} on" in text


def change(folder: Path, table: str, rows: pl.Expr, column: str, value: float) -> None:
    """Changes a column of some rows in the parts of a table."""
    for part in (folder / table).glob("*.parquet"):
        read = pl.read_parquet(part)
        kind = read.schema[column]
        changed = pl.when(rows).then(pl.lit(value).cast(kind)).otherwise(pl.col(column)).alias(column)
        read.with_columns(changed).write_parquet(part)


@pytest.mark.parametrize("steps", [3 * WINDOW - 20, 20])
def test_runs_that_end_within_a_window_are_equal_as_far_as_they_go(runs, tmp_path, steps):
    small_run(tmp_path / "cut", steps)
    for pair in ((runs / "a", tmp_path / "cut"), (tmp_path / "cut", runs / "a")):
        found = compare_runs(*pair)
        assert found.same
        assert {each.until for each in found.partings} == {steps}


def test_the_first_window_and_quantity_that_differ_are_named(runs, tmp_path):
    shutil.copytree(runs / "a", tmp_path / "changed")
    late = (pl.col("world") == 1) & (pl.col("step") >= 3 * WINDOW)
    change(tmp_path / "changed", "population", late, "births", 77)
    found = {each.seed: each for each in compare_runs(runs / "a", tmp_path / "changed").partings}
    assert found[1].step is None
    assert (found[2].step, found[2].agent) == (3 * WINDOW, None)
    assert [(name, after) for name, (_, after) in found[2].values.items()] == [("births", 77)]
    code, text = said(runs / "a", tmp_path / "changed")
    assert code == 1
    assert f"seed 2: part in the window that ends at step {3 * WINDOW}: births " in text


def test_a_life_that_differs_is_found_even_if_all_windows_agree(runs, tmp_path):
    shutil.copytree(runs / "a", tmp_path / "changed")
    change(tmp_path / "changed", "agents", (pl.col("world") == 0) & (pl.col("agent_id") == 3), "w_action", 0.25)
    (first, second) = compare_runs(runs / "a", tmp_path / "changed").partings
    assert (first.agent, list(first.values)) == (3, ["w_action"])
    assert second.values == {}
    assert "at agent 3, born at step 0; all windows are equal: w_action " in said(runs / "a", tmp_path / "changed")[1]


def test_settings_versions_seeds_and_ends_are_reported(runs, tmp_path):
    small_run(tmp_path / "other", 2 * WINDOW, seeds=(2, 5), overrides=("food.normal.growth_rate=0.5",))
    code, text = said(runs / "a", tmp_path / "other")
    assert code == 1
    assert "  food.normal.growth_rate: 0.2 -> 0.5" in text or "food.normal.growth_rate" in text
    assert "seed 2: part in the window that ends at step" in text
    assert "only one of them has seed 1, 5" in text
    shutil.copytree(runs / "a", tmp_path / "later")
    manifest = load_manifest(tmp_path / "later")
    save_manifest(tmp_path / "later", replace(manifest, hedon_version="9.9"))
    code, text = said(runs / "a", tmp_path / "later")
    assert code == 0, "versions are listed but are no difference by themselves"
    assert '-> "9.9"' in text
    digests = ("0" * len(manifest.world_digests[0]), *manifest.world_digests[1:])
    save_manifest(tmp_path / "later", replace(manifest, world_digests=digests))
    code, text = said(runs / "a", tmp_path / "later")
    assert code == 1
    assert "seed 1: equal up to step 256, but their states at the end differ" in text


def test_species_are_compared_separately(tmp_path):
    from hedon.config import load_config
    from hedon.experiment.plan import RunPlan
    from hedon.experiment.run import run

    small = [f"world.rollout_steps={WINDOW}", "learning.minibatch_size=32", "learning.update_epochs=1"]
    run(RunPlan(load_config("predator", overrides=small), [1], 2 * WINDOW, tmp_path / "a", 1))
    shutil.copytree(tmp_path / "a", tmp_path / "b")
    change(tmp_path / "b", "population", pl.col("species") == "predator", "births", 99)
    (found,) = compare_runs(tmp_path / "a", tmp_path / "b").partings
    assert (found.species, found.step, found.values["births"][1]) == ("predator", WINDOW, 99)


def test_a_folder_without_a_run_is_an_error(runs, tmp_path):
    done = CliRunner().invoke(app, ["check", str(runs / "a"), "--against", str(tmp_path)])
    assert "RecordError" in repr(done.exception), "the command exits with code 2"
