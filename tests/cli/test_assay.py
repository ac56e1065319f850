"""`hedon assay` as a user runs it: an effect of known sign, interruption, starts, and every invalid input."""

import json
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from command import hedon

from hedon.assay.report_contingency import CAUTION
from hedon.check.run import check_run
from hedon.record.reader import open_run

COSTLY = (
    "world.rollout_steps=64",
    "learning.minibatch_size=32",
    "learning.learning_rate=0.003",
    "learning.gamma=0",
    "reward.action_coef=1.0",
    "energy.action_cost=3e-4",
    "energy.basic_cost=0",
    'energy.at_zero="death"',
    "food.normal.growth_rate=0",
    "food.normal.initial_count=0",
    "birth.kappa=0",
    "hazard.kappa=0",
    "hazard.alpha_age=0",
)
"""A world without food or births in which only motion kills: agents rewarded for moving die first."""
SET = tuple(part for setting in COSTLY for part in ("--set", setting))
SHORT = ("--seeds", "1-5", "--steps", "3072", *SET)
BRIEF = ("--seeds", "1-2", "--steps", "1536", *SET)


def call(folder: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    return hedon("assay", *arguments, cwd=folder)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a landscape assay of the costly world."""
    path = tmp_path_factory.mktemp("assay")
    answer = call(path, "landscape", "baseline", *BRIEF, "--out", "whole")
    assert answer.returncode == 0, answer.stderr
    assert "Fitness over two genes" in answer.stdout
    return path


def effects(path: Path) -> dict[tuple[str, str], dict]:
    rows = json.loads(path.read_text(encoding="utf-8"))["tables"]["gene"]["rows"]
    return {(row["fitness"], row["gene"]): row for row in rows}


def worlds(path: Path) -> list[dict]:
    return json.loads((path / "landscape.json").read_text(encoding="utf-8"))["tables"]["world"]["rows"]


def test_parts_on_several_machines_make_the_same_worlds(folder: Path) -> None:
    words = ("landscape", "baseline", *BRIEF, "--out", "parts")
    for part in ("1/2", "2/2"):
        answer = call(folder, *words, "--part", part)
        assert answer.returncode == 0, answer.stderr
        assert "the same command without --part answers" in answer.stdout
    assert not (folder / "parts" / "landscape.json").exists()
    answer = call(folder, *words)
    assert "to make" not in answer.stdout
    assert worlds(folder / "parts") == worlds(folder / "whole")


def test_a_script_for_slurm_has_a_task_for_each_world_at_most(folder: Path) -> None:
    words = ("landscape", "baseline", *BRIEF, "--out", "an array")
    answer = call(folder, *words, "--slurm", "--jobs", "9", "--hours=2")
    assert "Next: sbatch 'an array.sh'" in answer.stdout
    assert "#SBATCH --array=1-2\n" in (folder / "an array.sh").read_text(encoding="utf-8")
    for task in ("1", "2"):
        environment = os.environ | {"SLURM_ARRAY_TASK_ID": task}
        subprocess.run(["sh", "an array.sh"], cwd=folder, env=environment, check=True, capture_output=True)
    assert "to make" not in call(folder, *words).stdout
    assert worlds(folder / "an array") == worlds(folder / "whole")


@pytest.mark.long
def test_reward_for_motion_is_selected_against_if_motion_kills(folder: Path) -> None:
    assert call(folder, "landscape", "baseline", *SHORT, "--out", "costly").returncode == 0
    found = effects(folder / "costly" / "landscape.json")
    for measure in ("descendants", "lifespan"):
        action, food = found[measure, "action"], found[measure, "normal"]
        assert action["high"] < 0
        assert action["p slope"] < 0.01
        assert action["z slope"] < -3
        assert food["p slope"] > 0.001
    assert not check_run(folder / "costly" / "run").findings
    assert (folder / "costly" / "landscape.svg").stat().st_size > 10_000
    assert "| descendants" in (folder / "costly" / "landscape.md").read_text(encoding="utf-8")


def test_an_interrupted_assay_goes_on_to_the_same_summary(folder: Path) -> None:
    command = ["hedon", "assay", "landscape", "baseline", *BRIEF, "--out", "broken"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True)
    for _ in range(600):
        if any((folder / "broken" / "run" / "population").glob("*.parquet")):
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    printed, _ = process.communicate(timeout=120)
    assert process.returncode == 130
    assert "The same command continues." in printed
    assert not (folder / "broken" / "landscape.json").exists()
    answer = call(folder, *command[2:])
    assert answer.returncode == 0, answer.stderr
    whole, broken = ((folder / name / "landscape.json").read_text(encoding="utf-8") for name in ("whole", "broken"))
    assert whole == broken
    before = (folder / "broken" / "run" / "manifest.json").stat().st_mtime_ns
    answer = call(folder, *command[2:])
    assert answer.returncode == 0, answer.stderr
    assert (folder / "broken" / "run" / "manifest.json").stat().st_mtime_ns == before, "a finished run is only read"


def test_seeds_can_be_added_to_an_assay_without_repeating_runs(folder: Path) -> None:
    command = ("landscape", "baseline", *BRIEF[2:], "--out", "grown")
    assert call(folder, *command, "--seeds", "1").returncode == 0
    before = (folder / "grown" / "run" / "manifest.json").read_bytes()
    answer = call(folder, *command, "--seeds", "1-2")
    assert answer.returncode == 0, answer.stderr
    assert "2 worlds: 1 run to make, 1,536 world-steps" in answer.stdout
    assert (folder / "grown" / "run" / "manifest.json").read_bytes() == before
    whole, grown = (json.loads((folder / name / "landscape.json").read_text()) for name in ("whole", "grown"))
    assert [run["seeds"] for run in grown["runs"]] == [[1], [2]]
    assert grown["tables"] == whole["tables"], "worlds are the same whether made together or separately"
    (folder / "grown" / "landscape.json").unlink()
    assert call(folder, *command, "--seeds", "1").returncode == 0, "fewer seeds are read from the finished runs"
    assert "1 world, 1,536 steps" in (folder / "grown" / "landscape.md").read_text(encoding="utf-8")


@pytest.mark.long
def test_the_better_group_wins_and_a_knockout_shows_the_worth_of_a_gene(folder: Path) -> None:
    answer = call(folder, "compete", "action=-8", "action=8", *SHORT, "--out", "compete")
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "compete" / "compete.json").read_text(encoding="utf-8"))
    assert found["share"]["low"] > 0.5
    assert found["p"] < 0.01
    assert found["start"] == 0.5
    rows = {row["seed"]: row for row in found["tables"]["world"]["rows"]}
    assert set(rows) == {1, 2, 3, 4, 5}
    # The founders of the competition serve as a frozen stock; without their action weight, their lifespans change.
    answer = call(folder, "knockout", "compete/run@0", "action", *SHORT[:4], "--out", "knockout")
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "knockout" / "knockout.json").read_text(encoding="utf-8"))
    assert found["groups"] == ["action = 0", "run@0"]
    assert not check_run(folder / "knockout" / "run").findings
    answer = call(folder, "invade", "action=8", "action=-8", "--share", "0.2", *SHORT, "--out", "invade")
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "invade" / "invade.json").read_text(encoding="utf-8"))
    assert found["groups"] == ["action=-8", "action=8"]
    assert found["start"] == pytest.approx(0.2)
    assert found["share"]["value"] > 0.2


@pytest.mark.long
def test_fitness_against_frequency_is_reported_at_each_share(folder: Path) -> None:
    command = ("frequency", "action=-8", "action=8", *SHORT, "--out", "frequency")
    answer = call(folder, *command, "--shares", "0.5,0.2")
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "frequency" / "frequency.json").read_text(encoding="utf-8"))
    assert f"{found['verdict']}:" in answer.stdout
    rows = found["tables"]["frequency_share"]["rows"]
    assert [row["share at the start"] for row in rows] == [0.2, 0.5]
    assert all(row["share at the end"] > row["share at the start"] for row in rows)
    runs = {run["folder"]: folder / "frequency" / run["folder"] for run in found["runs"]}
    assert list(runs) == ["share-0.2", "share-0.5"]
    assert not [finding for path in runs.values() for finding in check_run(path).findings]
    before = {path: (path / "manifest.json").stat().st_mtime_ns for path in runs.values()}
    answer = call(folder, *command, "--shares", "0.2,0.5,0.8")
    assert answer.returncode == 0, answer.stderr
    assert {path: (path / "manifest.json").stat().st_mtime_ns for path in runs.values()} == before
    again = json.loads((folder / "frequency" / "frequency.json").read_text(encoding="utf-8"))
    assert again["tables"]["frequency_share"]["rows"][:2] == rows, "adding a share leaves the others unchanged"


def test_groups_of_one_of_several_species_compete(folder: Path) -> None:
    options = ("--in", "predator", "--species", "predator", "--seeds", "1-3", "--steps", "512")
    answer = call(folder, "frequency", "action=5", "action=-5", *options, "--shares", "0.2,0.5", "--out", "species")
    assert answer.returncode == 0, answer.stderr
    assert not check_run(folder / "species" / "share-0.2").findings
    table = (folder / "species" / "share-0.2" / "founders.csv").read_text(encoding="utf-8")
    assert table.splitlines()[0] == "group,share,predator.w_action"
    answer = call(folder, "compete", "action=5", "action=-5", *options, "--out", "species-compete")
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "species-compete" / "compete.json").read_text(encoding="utf-8"))
    agents = open_run(folder / "species-compete" / "run").agents()
    living = agents.filter((agents["species"] == "predator") & agents["death_step"].is_null())
    for row in found["tables"]["world"]["rows"]:
        mine = living.filter(living["seed"] == row["seed"])["w_action"].to_list()
        assert (row["action=5"], row["action=-5"]) == (mine.count(5.0), mine.count(-5.0))


def test_groups_with_two_parents_are_told_apart_by_their_genes(folder: Path) -> None:
    pairs = ("birth.mating=pairs", "birth.kappa=0.02", "birth.mating_range=200", "hazard.kappa=0.1")
    options = [part for setting in pairs for part in ("--set", setting)]
    answer = call(
        folder, "compete", "action=1", "action=-1", *options, "--seeds", "1", "--steps", "1024", "--out", "pairs"
    )
    assert answer.returncode == 0, answer.stderr
    agents = open_run(folder / "pairs" / "run").agents()
    mates = agents["mate_id"].drop_nulls()
    assert len(mates)
    living = agents.filter(agents["death_step"].is_null())["w_action"].to_list()
    found = json.loads((folder / "pairs" / "compete.json").read_text(encoding="utf-8"))
    row = found["tables"]["world"]["rows"][0]
    assert (row["action=1"], row["action=-1"]) == (living.count(1.0), living.count(-1.0))


def test_a_stability_assay_starts_at_the_given_point(folder: Path) -> None:
    lively = ("--set", "world.rollout_steps=64", "--set", "learning.minibatch_size=32", "--set", "birth.kappa=0.002")
    options = (*lively, "--set", "hazard.kappa=0.1", "--steps", "1024", "--seeds", "1-3", "--out", "start")
    answer = call(folder, "stability", "baseline", "--at", "food=5,action=-4", "--beside", "food=0", *options)
    assert answer.returncode == 0, answer.stderr
    found = json.loads((folder / "start" / "stability.json").read_text(encoding="utf-8"))
    assert [each["point"] for each in found["starts"]] == [
        {"w_normal": 5.0, "w_action": -4.0},
        {"w_normal": 0.0, "w_action": 0.0},
    ]
    courses = [row for row in found["tables"]["course"]["rows"] if row["step"] == 0 and row["run"] == "start"]
    means = {row["gene"]: row["mean"] for row in courses}
    assert means["normal"] == pytest.approx(5, abs=0.1)
    assert means["action"] == pytest.approx(-4, abs=0.1)
    assert len(means) == 18
    for each in found["starts"]:
        assert each["verdicts"].keys() >= {"w_normal", "w_action"}
        assert {"held", "leaves", "as drift"} >= set(each["verdicts"].values())


LIVELY = (
    "world.rollout_steps=64",
    "learning.minibatch_size=32",
    "hazard.kappa=0.1",
    "birth.kappa=0.002",
    "population.initial_count=60",
)


@pytest.fixture(scope="module")
def past(folder: Path) -> Path:
    """Two worlds with many births and deaths, as the past of other worlds."""
    settings = tuple(part for setting in LIVELY for part in ("--set", setting))
    made = hedon("run", "baseline", "--seeds", "1-2", "--steps", "896", *settings, "--out", "past", cwd=folder)
    assert made.returncode == 0, made.stderr
    return folder / "past"


@pytest.mark.more
def test_futures_that_diverge_late_end_closer_together_than_fresh_worlds(folder: Path, past: Path) -> None:
    words = ("contingency", "past", "--steps", "1024", "--seeds", "101-106", "--out", "replayed")
    for part in ("1/2", "2/2", None):
        answer = call(folder, *words, *(("--part", part) if part else ()))
        assert answer.returncode == 0, answer.stderr
    assert "all are there" in answer.stdout, "the two parts made every world"
    found = json.loads((folder / "replayed" / "contingency.json").read_text(encoding="utf-8"))
    assert found["cautions"] == [CAUTION]
    assert found["pasts"] == [{"seed": 1, "step": 896}, {"seed": 2, "step": 896}]
    rows = {row["measure"]: row for row in found["tables"]["contingency"]["rows"]}
    assert rows["neutral genes"]["high"] < 1
    assert rows["neutral genes"]["result"] == "partly settled"
    assert {row["futures"] for row in rows.values()} == {12}
    assert rows.keys() >= {"w_normal_mean", "w_action_mean", "alive_mean", "generation", "lineages"}
    shared = found["tables"]["contingency_lineage"]["rows"]
    assert [(row["past"], row["step"]) for row in shared] == [(1, 896), (2, 896)]
    assert all(row["overlap"] > row["by chance"] for row in shared)
    kinds = {row["past"] for row in found["tables"]["world"]["rows"]}
    assert kinds == {"fresh", "seed 1 at 896", "seed 2 at 896"}
    for run in ("seed-1-at-896-1", "fresh-1"):
        assert check_run(folder / "replayed" / run).findings == ()


@pytest.mark.more
def test_futures_that_are_too_short_are_continued(folder: Path, past: Path) -> None:
    words = ("contingency", "past", "--of", "2", "--steps", "960", "--seeds", "101-102", "--fresh", "201")
    assert call(folder, *words, "--out", "at once").returncode == 0
    branch = ("branch", "past", "--of", "2", "--seeds", "101-102", "--steps", "928")
    assert hedon(*branch, "--out", "in two/seed-2-at-896", cwd=folder).returncode == 0
    answer = call(folder, *words, "--out", "in two")
    assert answer.returncode == 0, answer.stderr
    assert "continue in two/seed-2-at-896: 2 worlds to 960 steps" in answer.stdout
    once, two = (json.loads((folder / name / "contingency.json").read_text()) for name in ("at once", "in two"))
    assert once["tables"] == two["tables"]
    assert [run["world_digests"] for run in once["runs"]] == [run["world_digests"] for run in two["runs"]]


@pytest.mark.more
def test_comparisons_say_which_worlds_share_a_past(folder: Path, past: Path) -> None:
    made = hedon("branch", "past", "--of", "1", "--seeds", "21-26", "--steps", "960", "--out", "futures", cwd=folder)
    assert made.returncode == 0, made.stderr
    said = "The worlds of futures are futures of one world (seed 1 of past) from step 896 on."
    for command in (("compare", "past", "futures"), ("power", "futures", "--effect", "0.1")):
        answer = hedon(*command, cwd=folder)
        assert answer.returncode == 0, answer.stderr
        assert said in " ".join(answer.stdout.split())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("landscape", "basline"), "there is no such preset"),
        (("landscape", "baseline", "--genes", "food,acton"), "did you mean action?"),
        (
            ("landscape", "predator", "--species", "predator", "--genes", "normal,action"),
            "no gene 'normal' (predator has prey, action, see_prey, see_predator, neutral_1 to neutral_16)",
        ),
        (
            ("knockout", "action=1", "normal", "--in", "predator", "--species", "predator"),
            "no gene 'normal' (predator has prey, action, see_prey, see_predator, neutral_1 to neutral_16)",
        ),
        (("landscape", "baseline", "--genes", "food"), "must be two different genes"),
        (("landscape", "baseline", "--range", "-20:3"), "must be LOW:HIGH around 0, within -10:10"),
        (("landscape", "baseline", "--sd", "-1"), "--sd -1: must be a number of at least 0"),
        (("landscape", "baseline", "--ends", "nowhere"), "--ends nowhere: cannot be read"),
        (("landscape", "baseline", "--out", "whole"), "holds a run with other settings, founders or seeds"),
        (("frequency", "food=1", "food=2", "--shares", "0.5"), "must be two or more different shares between 0 and 1"),
        (("frequency", "food=1", "food=2", "--set", "population.initial_count=9"), "0.05 leaves a group without any"),
        (("frequency", "food=1", "food=2", "--species", "prey"), "there is no such species"),
        (("compete", "food=1", "action=2", "--set", "birth.mating=pairs"), "two points that name the same genes"),
        (("compete", "predator.action=1", "action=2", "--in", "predator"), "has no gene of the species prey"),
        (("compete", "food=1", "fod=2"), "there is no gene 'fod'"),
        (("compete", "food=1", "nowhere"), "there is no such file or folder"),
        (("knockout", "whole/run", "acton"), "did you mean action?"),
        (("knockout", "whole/run@99999999", "action"), "has only 1,536 steps"),
        (("stability", "baseline", "--at", "food=50"), "must be one number from -10 to 10"),
        (("stability", "baseline", "--at", "neutral_1=1"), "a neutral gene is the control"),
        (
            ("stability", "predator", "--at", "action=1"),
            "needs a world of one species, and predator has prey",
        ),
        (("stability", "baseline", "--at", "food=1", "--set", "birth.mating=pairs"), "needs children of one parent"),
        (("contingency", "whole/run", "--seeds", "2,3"), "seed 2: is that of a world of whole/run"),
        (("contingency", "whole/run@9"), "has no checkpoint of step 9"),
        (("contingency", "whole/run@x"), "x is not a step: give RUN or RUN@STEP"),
        (("contingency", "whole/run", "--of", "9"), "the run has no such world of the seeds 1, 2"),
        (("contingency", "whole/run", "--steps", "1000"), "a branch needs more total steps than that"),
        (("contingency", "nowhere"), "nowhere"),
    ],
)
def test_bad_input_ends_in_one_message(folder: Path, arguments: tuple[str, ...], message: str) -> None:
    answer = call(folder, *arguments)
    assert answer.returncode == 2
    assert message in answer.stderr
    assert "Traceback" not in answer.stderr
    assert not answer.stdout


def test_an_unreadable_run_is_reported_before_another_is_made(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "whole", tmp_path / "lacking")
    config = tmp_path / "lacking" / "run" / "config.toml"
    lines = config.read_text(encoding="utf-8").splitlines(keepends=True)
    config.write_text("".join(line for line in lines if "reward_scaling" not in line), encoding="utf-8")
    answer = call(tmp_path, "landscape", "baseline", *BRIEF, "--out", "lacking")
    assert answer.returncode == 0, answer.stderr
    assert re.search(r"note: left out: .*config\.toml.*reward_scaling", answer.stderr), answer.stderr
    assert (tmp_path / "lacking" / "run-run2").is_dir()
