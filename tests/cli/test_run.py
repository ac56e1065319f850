"""`hedon run` as a user runs it."""

import json
import signal
import subprocess
import time

import numpy as np
import polars as pl
import pytest
from command import hedon as answer_of

import hedon
from hedon.experiment.argument import parse_seeds

QUICK = ("--set", "world.rollout_steps=256", "--set", "learning.update_epochs=1")
LIVELY = ("--set", "birth.kappa=0.01", "--set", "hazard.kappa=0.1")


def call(*arguments, **options):
    return subprocess.run(["hedon", *map(str, arguments)], capture_output=True, text=True, check=False, **options)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A short run of two worlds, and the output of the command."""
    folder = tmp_path_factory.mktemp("run with spaces and ümläut") / "out"
    seeds = ("--seeds", "3,5", "--steps", 1300, "--frames", 100, "--out", folder)
    answer = call("run", "poison", *seeds, *QUICK, *LIVELY, "--fidelity", "released")
    assert answer.returncode == 0, answer.stderr
    return folder, answer.stdout


@pytest.mark.smoke
def test_a_run_writes_the_documented_files(finished):
    folder, printed = finished
    files = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    expected = {"config.toml", "manifest.json", "summary.json", "final.npz", "agents/living.parquet"}
    expected |= {f"figures/{name}.svg" for name in ("weights", "history", "population", "world")}
    assert expected <= files
    assert any(name.startswith("frames/part-") for name in files)
    assert "poison (released, modified): 2 worlds" in printed
    assert "step 1,300 of 1,300" in printed


def test_the_manifest_says_how_to_repeat_the_run(finished):
    folder, _ = finished
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["seeds"] == [3, 5]
    assert manifest["status"] == "finished"
    assert manifest["steps_done"] == [1300, 1300]
    assert manifest["backend"] in ("avx512", "avx2", "neon", "portable")
    assert manifest["fidelity"] == "released"
    assert manifest["name"] == "poison"
    assert manifest["modified"] is True
    config = hedon.load_config(folder / "config.toml")
    assert config.world.mutation_noise == "tabulated"
    simulation = hedon.Simulation(config, manifest["seeds"], backend=manifest["backend"])
    simulation.run(1300)
    run = hedon.open_run(folder)
    living = run.agents().filter(pl.col("world") == 1, pl.col("death_step").is_null()).sort("agent_id")
    np.testing.assert_array_equal(living["agent_id"], simulation.worlds[1].agents()["agent_id"])
    np.testing.assert_array_equal(living["w_poison"], simulation.worlds[1].agents()["genome"][:, 1])


def test_tables_agree_with_one_another(finished):
    run = hedon.open_run(finished[0])
    agents, population = run.agents(), run.population()
    for world in (0, 1):
        mine, rows = agents.filter(pl.col("world") == world), population.filter(pl.col("world") == world)
        assert rows["step"].to_list() == [256, 512, 768, 1024, 1280, 1300]
        assert rows["steps"].sum() == 1300
        assert mine.height == 50 + rows["births"].sum()
        assert mine["death_step"].drop_nulls().len() == rows["deaths"].sum() > 10
        assert mine["death_step"].null_count() == rows["alive"][-1]
        assert mine["agent_id"].sort().to_list() == list(range(mine.height))
        for kind in ("normal", "poison"):
            assert mine[f"eaten_{kind}"].sum() == rows[f"eaten_{kind}"].sum()
        lived = (mine["death_step"].fill_null(1300) - mine["birth_step"]).sum()
        assert lived == rows["agent_steps"].sum()
        sums = {name: rows[name].to_numpy().sum() for name in rows.columns if name.startswith("energy_")}
        held = 50 * 40 + sums["energy_eaten"] + sums["energy_forgiven"] - sums["energy_basic"]
        held -= sums["energy_action"] + sums["energy_capped"] + sums["energy_lost"]
        assert rows["energy_total"][-1] == pytest.approx(held, abs=1e-7)


def test_frames_hold_every_agent_and_food(finished):
    run = hedon.open_run(finished[0])
    frames = run.frames().collect()
    assert frames["step"].unique().sort().to_list() == list(range(100, 1301, 100))
    last = frames.filter(pl.col("step") == 1300, pl.col("world") == 0)
    rows = run.population().filter(pl.col("world") == 0)
    assert last.filter(pl.col("kind") == "agent").height == rows["alive"][-1]
    assert last.filter(pl.col("kind") == "poison").height == rows["food_poison"][-1]


def test_the_summary_has_its_keys(finished):
    summary = json.loads((finished[0] / "summary.json").read_text())
    for world in summary["worlds"]:
        keys = {"steps_per_second", "alive", "extinct", "births", "deaths", "mean_lifetime", "food_per_step"}
        assert keys <= world.keys()
        assert world["steps_per_second"] > 0


def test_a_folder_that_holds_a_run_is_left_alone(finished):
    folder, _ = finished
    before = (folder / "manifest.json").read_bytes()
    answer = answer_of("run", "baseline", "--steps", 10, "--out", folder)
    assert answer.returncode == 2
    assert "already holds a run" in answer.stderr
    assert answer.stdout == ""
    assert "Traceback" not in answer.stderr
    assert (folder / "manifest.json").read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("run", "basline"), ("basline", "baseline")),
        (("run", "baseline", "--set", "food.normal.growth=1"), ("food.normal.growth", "growth_rate")),
        (("run", "baseline", "--set", "learning.gamma=1.5"), ("learning.gamma", "1.5")),
        (("run", "baseline", "--set", "population.initial_count=300"), ("population.initial_count", "300")),
        (("run", "baseline", "--seeds", "5-1"), ("--seeds", "5-1")),
        (("run", "baseline", "--seeds", "1,1"), ("appears twice",)),
        (("run", "baseline", "--fidelity", "correct"), ("correct", "corrected")),
        (("run", "baseline", "--steps", "0"), ("--steps",)),
        (("run", "nowhere.toml"), ("nowhere.toml",)),
        (("report", "nowhere"), ("nowhere",)),
        (("rnu",), ("rnu", "run")),
    ],
)
def test_mistakes_get_one_clear_message(tmp_path, arguments, words):
    answer = answer_of(*arguments, cwd=tmp_path)
    assert answer.returncode == 2
    assert "Traceback" not in answer.stderr
    for word in words:
        assert word in answer.stderr
    assert not list(tmp_path.iterdir())


def test_an_unknown_kernel_is_named(tmp_path):
    answer = answer_of("run", "baseline", "--out", tmp_path / "out", HEDON_BACKEND="sse9")
    assert answer.returncode == 2
    assert "sse9" in answer.stderr
    assert "portable" in answer.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_ends_after_the_window_and_keeps_everything(tmp_path, name):
    folder = tmp_path / "out"
    command = ["hedon", "run", "baseline", "--steps", "10000000", "--out", str(folder), *QUICK, "--checkpoint", "0"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    process = subprocess.Popen(command, **pipes, preexec_fn=heed_signals)  # the test process itself may ignore some
    try:
        wait_for(folder / "population" / "part-000000.parquet", 120.0)
        process.send_signal(getattr(signal, name))
        printed, errors = process.communicate(timeout=120)
    finally:
        process.kill()
    assert process.returncode == 128 + getattr(signal, name), errors
    assert "Interrupted after step" in printed
    assert f"hedon resume {folder}" in printed
    assert "Traceback" not in errors
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["status"] == "interrupted"
    done = manifest["steps_done"][0]
    assert done > 0
    assert done % 256 == 0
    population = hedon.open_run(folder).population()
    assert population["step"].max() == done
    assert (folder / "figures" / "population.svg").exists()


def test_nohup_keeps_a_run_alive(tmp_path):
    folder = tmp_path / "out"
    command = ["nohup", "hedon", "run", "baseline", "--steps", "2048", "--out", str(folder), "--no-report"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for(folder / "manifest.json")
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=120)
    assert process.returncode == 0
    assert json.loads((folder / "manifest.json").read_text())["status"] == "finished"


def test_names_are_printed_as_they_are(tmp_path):
    for name in ("m[/b]", "h[lr=0.1]", "w:dog:1", "[bold]x"):
        answer = answer_of("run", "baseline", "--steps", "64", "--out", tmp_path / name, "--no-report")
        assert answer.returncode == 0, answer.stderr
        assert f"/{name}" in answer.stdout
        assert f"/{name}" in answer_of("report", tmp_path / name, "--figures", "none").stdout


def test_results_can_be_read_during_the_run(tmp_path):
    folder = tmp_path / "out"
    command = ["hedon", "run", "baseline", "--steps", "10000000", "--out", str(folder), *QUICK, "--no-report"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wait_for(folder / "agents" / "living.parquet")
        assert hedon.open_run(folder).agents().height >= 50
        assert answer_of("report", folder, "--figures", "none").returncode == 0
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=60)


def test_extinction_is_reported_and_recorded(tmp_path):
    lethal = ("--set", "hazard.kappa=1", "--set", "energy.initial=0", "--set", "birth.kappa=0")
    answer = answer_of("run", "baseline", "--steps", 20_000, "--out", tmp_path / "out", *lethal, "--no-report")
    assert answer.returncode == 0, answer.stderr
    assert "died out at step" in answer.stdout
    assert answer_of("report", tmp_path / "out", "--figures", "none").returncode == 0
    world = json.loads((tmp_path / "out" / "summary.json").read_text())["worlds"][0]
    assert world["extinct"] is True
    assert world["alive"] == 0
    assert world["deaths"] == 50


def heed_signals():
    """Restores the default signal handlers in a new process, even if this one ignores some."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def wait_for(path, seconds=30.0):
    """Waits until a file exists."""
    end = time.monotonic() + seconds
    while not path.exists():
        assert time.monotonic() < end, f"{path} did not appear"
        time.sleep(0.05)


@pytest.mark.parametrize(
    ("text", "seeds"), [("7", (7,)), ("1-3", (1, 2, 3)), ("1, 4,7-8", (1, 4, 7, 8)), ("0-0", (0,)), ("[3, 5]", (3, 5))]
)
def test_seeds_are_read(text, seeds):
    assert parse_seeds(text) == seeds


@pytest.mark.parametrize(
    "text", ["", "a", "3-1", "-1", "1,,2", "1-", "9223372036854775808", "1,1-2", "0-99999", "1,000", "1-010"]
)
def test_invalid_seeds_are_refused(text):
    with pytest.raises(hedon.ArgumentError, match="seeds: "):
        parse_seeds(text)


def test_a_report_says_how_to_watch_a_run_that_has_frames(tmp_path):
    for name, frames in (("seen", ("--frames", "16")), ("unseen", ())):
        answer = answer_of("run", "small", "--steps", "64", *frames, "--out", name, cwd=tmp_path)
        assert answer.returncode == 0, answer.stderr
        page = (tmp_path / name / "report.md").read_text(encoding="utf-8")
        assert ("run hedon view with this folder" in page) == (name == "seen")
