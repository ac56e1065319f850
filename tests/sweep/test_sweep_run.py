"""A sweep gives the same table, no matter what runs it and how often it is killed."""

import json
import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import polars as pl
import pytest
from sweep_case import FACTORS, assert_same_table, planned, run_sweep, sweep_file, table_of
from typer.testing import CliRunner

from hedon import RunPlan, load_config, run
from hedon.cli.cluster import ClusterError
from hedon.cli.main import app
from hedon.ensemble.batch import RESULTS, WORK, batch_job
from hedon.ensemble.batches import open_batches
from hedon.ensemble.demand import parse_part
from hedon.ensemble.plan import load_plan
from hedon.ensemble.status import sweep_status
from hedon.ensemble.store import Store
from hedon.error import HedonError
from hedon.sweep.read import read_sweep

START = "from hedon.cli.start import main; main()"
STEPS = 6_400
"""Steps of each world, which take a few seconds."""


def make_all(location: str, file: Path) -> pl.DataFrame:
    """The table of a sweep whose batches are made in this process, one after the other."""
    plan, store = planned(file, location)
    assert store.folder is not None
    for batch in plan.batches():
        assert batch_job(location, plan, batch, store.folder / WORK / batch.name, 1e9).make(1, None) == "finished"
    return table_of(location)


def command(*words: str | Path) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-c", START, *map(str, words)], start_new_session=True)


def test_a_killed_sweep_continues_to_the_same_table(tmp_path):
    """Killed by SIGKILL with all its processes, in the middle of its first batch."""
    file = sweep_file(tmp_path, STEPS)
    whole = make_all(str(tmp_path / "whole"), file)
    place = tmp_path / "killed"
    begun = command("sweep", "run", file, "--out", place, "--workers", "1", "--checkpoint", "0")
    deadline = time.monotonic() + 120
    while not (kept := list((place / WORK).glob("*/checkpoints/step-*[1-9]*.npz"))):
        assert time.monotonic() < deadline
        assert begun.poll() is None
        time.sleep(0.02)
    worker = int(kept[0].parents[1].joinpath(".lock").read_text().partition('"process": ')[2].rstrip("} \n"))
    os.kill(worker, signal.SIGKILL)
    os.killpg(begun.pid, signal.SIGKILL)
    begun.wait()
    assert not list((place / RESULTS).glob("*")), "it should have been killed before its first result"
    plan, store = load_plan(Store(str(place))), Store(str(place))
    assert 0 < max(sweep_status(plan, store).begun.values()) < 1
    outcomes = run_sweep(plan, store, 1e9, 2)
    assert {outcome.status for outcome in outcomes.values()} == {"finished"}
    assert_same_table(table_of(str(place)), whole)
    assert not list((place / WORK).glob("*"))
    assert run_sweep(plan, store, 1e9, 2) == {}, "nothing finished is done again"
    assert sorted(zip(whole["condition"], whole["repetition"], whole["seed"], strict=True)) == [
        (0, 1, 1), (0, 2, 2), (1, 1, 1), (1, 2, 2)
    ]  # fmt: skip
    assert whole["energy.basic_cost"].to_list() == [0.001, 0.001, 0.01, 0.01]
    assert whole["digest"].n_unique() == 4


def test_the_size_of_batches_changes_no_row(tmp_path):
    one = make_all(str(tmp_path / "one"), sweep_file(tmp_path, worlds=1))
    two = make_all(str(tmp_path / "two"), sweep_file(tmp_path, worlds=2))
    assert_same_table(one, two)


def test_worlds_that_die_out_have_a_row(tmp_path):
    file = sweep_file(tmp_path, 4096, rest='[factor]\n"hazard.alpha_age" = [0.001, 1.0]\n"birth.kappa" = [0.0]\n')
    text = file.read_text().replace("hazard.alpha_age=0.001\n", "").replace("birth.kappa=0.05\n", "")
    file.write_text(text)
    table = make_all(str(tmp_path / "doomed"), file)
    gone = table.filter(pl.col("hazard.alpha_age") == 1.0)
    assert gone["extinct"].all()
    assert gone["extinct_step"].is_not_null().all()
    assert gone["alive"].to_list() == [0, 0]


def test_requested_records_are_kept(tmp_path):
    file = sweep_file(tmp_path, seeds=1)
    file.write_text('keep = ["agents", "population", "run"]\n' + file.read_text())
    place = tmp_path / "kept"
    table = make_all(str(place), file)
    for condition, name in ((batch.condition, batch.name) for batch in load_plan(Store(str(place))).batches()):
        agents = pl.read_parquet(place / "tables" / "agents" / f"{name}.parquet")
        births = table.filter(pl.col("condition") == condition)["births"].item()
        assert agents.height == 16 + births
        assert (place / "runs" / name / "manifest.json").is_file()


def test_a_batch_that_fails_harms_no_other_and_is_tried_again(tmp_path):
    """Each preset has its own base config, and one of them is broken."""
    place, presets = tmp_path / "fails", '[factor]\npreset = ["baseline", "small"]\n'
    file = sweep_file(tmp_path, 64, seeds=1, rest=presets)
    plan, store = planned(file, str(place))
    good, bad = sorted(plan.batches(), key=lambda batch: batch.condition)
    config = place / "configs" / f"{plan.conditions[1].base}.toml"
    whole = config.read_text()
    config.write_text("broken = ")
    outcomes = run_sweep(plan, store, 1e9, 1)
    assert outcomes[good.name].status == "finished"
    assert outcomes[bad.name].status == "failed"
    assert config.name in outcomes[bad.name].fault
    config.write_text(whole.replace("basic_cost = ", "basic_cost = 1"))
    assert "is not the planned config" in run_sweep(plan, store, 1e9, 1)[bad.name].fault
    config.write_text(whole)
    assert {name: o.status for name, o in run_sweep(plan, store, 1e9, 1).items()} == {bad.name: "finished"}


def test_another_sweep_is_not_mixed_in(tmp_path):
    file, place = sweep_file(tmp_path, 64), str(tmp_path / "mixed")
    planned(file, place)
    planned(file, place)
    with pytest.raises(HedonError, match=r"holds a sweep of 64 steps, and .* asks for 128: .* do not get longer"):
        planned(sweep_file(tmp_path, 128), place)
    with pytest.raises(HedonError, match="holds another sweep"):
        planned(sweep_file(tmp_path, 64, rest='[factor]\n"energy.basic_cost" = [0.5]\n'), place)


def test_a_sweep_is_not_written_into_a_run(tmp_path):
    run(RunPlan(load_config("small"), (1,), 8, tmp_path / "run", 1))
    before = sorted((tmp_path / "run").rglob("*"))
    with pytest.raises(HedonError, match="holds a run: give the sweep another place with --out"):
        planned(sweep_file(tmp_path, 64), str(tmp_path / "run"))
    assert sorted((tmp_path / "run").rglob("*")) == before


def results(place: Path) -> dict[str, int]:
    """When each result was written."""
    return {path.name: path.stat().st_mtime_ns for path in (place / RESULTS).iterdir()}


def test_a_sweep_grows_by_seeds_and_values_and_makes_only_what_is_missing(tmp_path):
    few = '[factor]\n"energy.basic_cost" = [0.001, 0.01]\n'
    more = '[factor]\n"energy.basic_cost" = [0.005, 0.01, 0.001]\n'
    place = tmp_path / "grown"
    make_all(str(place), sweep_file(tmp_path, 96, seeds=2, rest=few))
    before = results(place)
    grown = make_all(str(place), sweep_file(tmp_path, 96, seeds=5, rest=more))
    assert {name: at for name, at in results(place).items() if name in before} == before
    assert_same_table(grown, make_all(str(tmp_path / "whole"), sweep_file(tmp_path, 96, seeds=5, rest=more)))
    assert grown.height == 15
    plan, store = planned(sweep_file(tmp_path, 96, seeds=1, rest=few), str(place))
    assert not (place / "table.parquet").exists(), "it was the table of the earlier sweep"
    assert open_batches(plan, store) == []
    assert table_of(str(place))["energy.basic_cost"].to_list() == [0.001, 0.01]
    again, store = planned(sweep_file(tmp_path, 96, seeds=5, rest=more), str(place))
    assert open_batches(again, store) == [], "finished batches are kept"


@pytest.mark.long
def test_a_sweep_that_grows_while_it_runs_is_completed(tmp_path):
    place, small = tmp_path / "running", sweep_file(tmp_path, 3_200, seeds=1)
    begun = command("sweep", "run", small, "--out", place, "--workers", "1")
    until = time.monotonic() + 300
    while not list((place / WORK).glob("*/manifest.json")):
        assert time.monotonic() < until
        time.sleep(0.02)
    planned(sweep_file(tmp_path, 3_200, seeds=2), str(place))
    assert begun.wait(300) == 0
    assert table_of(str(place)).height == 4


def test_a_task_is_no_larger_in_a_large_sweep(tmp_path):
    """A cluster receives one for each batch."""
    many = f'[factor]\n"energy.basic_cost" = {[i / 1e6 for i in range(500)]}\n'
    sizes = []
    for name, rest in (("few", FACTORS), ("many", many)):
        (tmp_path / name).mkdir()
        plan = read_sweep(sweep_file(tmp_path / name, rest=rest)).plan
        batch = next(each for each in plan.batches() if each.condition == 1)
        sizes.append(len(pickle.dumps(batch_job("place", plan, batch, tmp_path, 1.0))))
    assert max(sizes) < min(sizes) + 20


def test_parts_share_a_sweep(tmp_path):
    plan, store = planned(sweep_file(tmp_path, 64, seeds=3), str(tmp_path / "parts"))
    parts = [open_batches(plan, store, parse_part(f"{i}/3")) for i in (1, 2, 3)]
    assert sorted(batch.name for part in parts for batch in part) == sorted(batch.name for batch in plan.batches())
    for wrong in ("0/3", "4/3", "x", "1/0"):
        with pytest.raises(HedonError, match="must be I/N"):
            parse_part(wrong)


def test_the_commands_report_what_was_made(tmp_path):
    file = sweep_file(
        tmp_path, 640, rest='[factor]\n"energy.basic_cost" = [0.001, 0.01]\n"birth.kappa" = [0.05, 0.1]\n'
    )
    file.write_text(file.read_text().replace("birth.kappa=0.05\n", "", 1))
    place = str(tmp_path / "told")
    assert "4 settings x 2 seeds x 640 steps = 5,120 world-steps" in said("sweep", "plan", str(file))
    table = make_all(place, file)
    assert "done: 4 of 4 batches, 8 worlds" in said("sweep", "status", place)
    assert "8 of 8 worlds" in said("sweep", "collect", place)
    ended = said("sweep", "run", str(file), "--out", place)
    assert "Sweep small" in ended
    assert "birth.kappa" in ended, "it ends with its table, headed by names of settings"
    assert_same_table(pl.read_parquet(f"{place}/table.parquet"), table)
    said("sweep", "report", place, "--only", "alive_mean,extinct")
    page = (Path(place) / "report" / "report.md").read_text()
    assert "8 of 8 worlds (4 settings x 2 seeds) of 640 steps" in page
    for name in ("curve-energy-basic-cost", "curve-birth-kappa", "map-energy-basic-cost-birth-kappa-alive_mean"):
        assert (Path(place) / "report" / f"{name}.svg").stat().st_size > 5000
        assert f"({name}.svg)" in page
    found = json.loads((Path(place) / "report" / "report.json").read_text())["tables"]["response"]["rows"]
    (row,) = (r for r in found if (r["energy.basic_cost"], r["birth.kappa"], r["measure"]) == (0.01, 0.1, "alive_mean"))
    own = table.filter((pl.col("energy.basic_cost") == 0.01) & (pl.col("birth.kappa") == 0.1))["alive_mean"]
    assert (row["mean"], row["worlds"]) == (pytest.approx(own.mean()), 2)
    said("sweep", "report", place, "--only", "extinct")
    left = {path.stem for path in (Path(place) / "report").glob("*.svg")}
    assert left == {"curve-energy-basic-cost", "curve-birth-kappa", "map-energy-basic-cost-birth-kappa-extinct"}
    done = CliRunner().invoke(app, ["sweep", "report", place, "--only", "alive_maen"])
    assert "did you mean alive_mean?" in str(done.exception)


def said(*words: str) -> str:
    done = CliRunner().invoke(app, list(words))
    assert done.exit_code == 0, done.output + str(done.exception)
    return done.output


def test_a_script_for_slurm_has_at_most_one_task_per_batch(tmp_path):
    place = tmp_path / "a sweep"
    words = ["sweep", "run", str(sweep_file(tmp_path)), "--slurm", "--out", str(place)]
    refused = CliRunner().invoke(app, [*words, "--ray", "local"])
    assert isinstance(refused.exception, ClusterError)
    assert "leave out --ray and --part" in str(refused.exception)
    done = CliRunner().invoke(app, [*words, "--jobs", "100", "--workers", "3", "--hours", "2"])
    assert done.exit_code == 0, done.output
    text = (tmp_path / "a sweep.sh").read_text()
    assert "#SBATCH --array=1-2\n#SBATCH --cpus-per-task=3\n#SBATCH --time=2:00:00\n" in text
    assert f"sweep resume '{place}' --workers 3 --checkpoint 180 --part \"$SLURM_ARRAY_TASK_ID/2\"" in text
    assert load_plan(Store(str(place))).steps == 320
