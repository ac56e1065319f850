"""`hedon study` as a user runs it."""

import json
import re
from pathlib import Path
from subprocess import CompletedProcess

import pytest
from command import hedon as command

import hedon
from hedon.study.catalogue import choose

NAME = "kanagawa-doya-2024"
LAWS = ("hazard", "birth", "walk", "body", "parameters")


def call(folder: Path, *arguments: str) -> "CompletedProcess[str]":
    return command("study", *arguments, cwd=folder)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which two items of the baseline were made from two worlds of 1024 steps."""
    folder = tmp_path_factory.mktemp("study")
    answer = call(folder, "run", "weights-baseline", "history-baseline", "--seeds", "1-2", "--steps", "1024")
    assert answer.returncode == 0, answer.stderr
    assert "2 items (corrected), 2 worlds: 1 run to make, 2,048 world-steps, in runs" in answer.stdout
    return folder


@pytest.mark.smoke
def test_items_that_depend_only_on_settings_need_no_run(tmp_path: Path) -> None:
    answer = call(tmp_path, "run", *LAWS, "--fidelity", "released")
    assert answer.returncode == 0, answer.stderr
    assert "0 worlds: none is needed" in answer.stdout
    assert not (tmp_path / "runs").exists()
    found = json.loads((tmp_path / "studies" / NAME / "study.json").read_text(encoding="utf-8"))
    assert {item["name"] for item in found["items"]} == set(LAWS)
    assert found["fidelity"] == "released"
    growth = [row for row in found["tables"]["parameters_food"]["rows"] if row["setting"] == "food.normal.growth_rate"]
    assert growth[0]["value"] == "1.0"
    for name in ("hazard", "birth", "walk", "body"):
        assert (tmp_path / "studies" / NAME / "figures" / f"{name}.svg").stat().st_size > 10_000


def test_the_page_contains_its_figures_and_describes_their_data(made: Path) -> None:
    text = (made / "studies" / NAME / "study.html").read_text(encoding="utf-8")
    assert text.count("data:image/svg+xml;base64,") == 2
    assert not re.search(r'(src|href)="(?!data:|#)', text), "the page must be self-contained"
    assert "Asked for: 2 worlds of 1,024 steps; the study has 5 of 10,240,000." in text
    assert "Claims about these conditions" in text
    markdown = (made / "studies" / NAME / "study.md").read_text(encoding="utf-8")
    for path in re.findall(r"\]\((figures/[^)]+)\)", markdown):
        assert (made / "studies" / NAME / path).is_file()
    numbers = json.loads((made / "studies" / NAME / "study.json").read_text(encoding="utf-8"))
    assert numbers["items"][0]["worlds"][0]["worlds"] == "2 of 2"
    assert numbers["runs"][0]["manifest"]["seeds"] == [1, 2]
    assert (made / "studies" / NAME / "tables" / "verdict.csv").is_file()


def test_existing_worlds_are_reused_and_more_are_added(made: Path) -> None:
    again = call(made, "run", "weights-baseline", "--seeds", "1-2", "--steps", "1024")
    assert "all are there" in again.stdout
    more = call(made, "run", "weights-baseline", "--seeds", "2-3", "--steps", "2048")
    assert more.returncode == 0, more.stderr
    assert "2 runs to make, 4,096 world-steps, in runs" in more.stdout
    assert hedon.open_run(made / "runs" / "baseline-corrected-s1-2").manifest.steps_done == (2048, 2048)
    assert hedon.open_run(made / "runs" / "baseline-corrected-s3").manifest.steps_done == (2048,)


def test_the_plan_names_every_item_with_a_measured_time(tmp_path: Path) -> None:
    answer = call(tmp_path, "plan", "all", "--threads", "1")
    assert answer.returncode == 0, answer.stderr
    for name in (item.name for study in choose(["all"]) for item in study.items):
        assert re.search(rf"^ {re.escape(name)} ", answer.stdout, re.MULTILINE)
    assert re.search(r"Measured now: [\d,]+ world-steps/s on 1 thread with \d+ agents", answer.stdout)
    assert re.search(r"^ together .* \d+ h \d\d min", answer.stdout, re.MULTILINE)
    # Two species in one setting count as one setting.
    assert re.search(r"^ sequel-numbers .* 1 setting, ", answer.stdout, re.MULTILINE)


def test_the_list_names_every_study_and_item(tmp_path: Path) -> None:
    answer = call(tmp_path, "list")
    assert answer.returncode == 0, answer.stderr
    for study in choose(["all"]):
        assert f"{study.name}: " in answer.stdout
        for item in study.items:
            assert re.search(rf"^ {re.escape(item.name)} ", answer.stdout, re.MULTILINE)


def test_a_report_uses_existing_worlds_and_runs_nothing(made: Path) -> None:
    before = sorted((made / "runs").iterdir())
    answer = call(made, "report", "weights-baseline", "fear", "--seeds", "1-2", "--steps", "1024")
    assert answer.returncode == 0, answer.stderr
    numbers = json.loads((made / "studies" / "several" / "study.json").read_text(encoding="utf-8"))
    worlds = {item["name"]: [row["worlds"] for row in item["worlds"]] for item in numbers["items"]}
    assert worlds["weights-baseline"] == ["2 of 2"]
    assert set(worlds["sequel-fear"]) == {"0 of 2"}
    assert sorted((made / "runs").iterdir()) == before


def test_a_quick_trial_is_one_short_world_of_each_setting(tmp_path: Path) -> None:
    answer = call(tmp_path, "run", "history-poor", "--quick")
    assert answer.returncode == 0, answer.stderr
    assert hedon.open_run(tmp_path / "runs" / "poor-corrected-s1").manifest.steps_done == (2048,)


def test_parts_on_several_machines_make_all_worlds_and_the_script_calls_them(tmp_path: Path) -> None:
    words = ("weights-baseline", "--seeds", "1-2", "--steps", "64")
    for part in ("1/2", "2/2"):
        answer = call(tmp_path, "run", *words, "--part", part)
        assert answer.returncode == 0, answer.stderr
    assert not (tmp_path / "studies").exists(), "a report needs all parts"
    assert "all are there" in call(tmp_path, "run", *words).stdout
    answer = call(tmp_path, "run", *words, "--slurm", "--jobs", "9", "--runs", "shared runs")
    assert answer.returncode == 0, answer.stderr
    script = (tmp_path / f"{NAME}.sh").read_text(encoding="utf-8")
    assert "#SBATCH --array=1-2\n" in script, "no more tasks than worlds"
    assert f"study run weights-baseline --fidelity corrected --threads 1 --runs '{tmp_path}/shared runs'" in script
    assert '--seeds 1,2 --steps 64 --part "$SLURM_ARRAY_TASK_ID/2"' in script


def test_the_former_command_names_the_new_one(tmp_path: Path) -> None:
    answer = command("reproduce", "list", cwd=tmp_path)
    assert answer.returncode == 2
    assert answer.stderr.startswith("hedon: there is no command 'reproduce': call `hedon study`")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("run", "weigths-poor"), "there is no study or item 'weigths-poor'; did you mean weights-poor?"),
        (("plan", "faer"), "there is no study or item 'faer'; did you mean fear?"),
        (
            ("run", "hazard", "--fidelity", "relesed"),
            "--fidelity: 'relesed' is not one of corrected, released, as_printed",
        ),
        (("run", "hazard", "--out", "/proc/none"), "cannot write /proc/none"),
        (("report", "hazard", "--out", "/proc/none"), "cannot write /proc/none"),
        (("run", "weights-poor", "--seeds", "5-1"), "seeds: '5-1' is not a range of seeds"),
        (("run", "fear", "--slurm", "--part", "1/2"), "--slurm: its tasks are parts of the work"),
        (("run", "hazard", "--slurm"), "--slurm: no worlds are needed"),
        (("run", "fear", "--part", "3/2"), "--part = '3/2': must be I/N"),
        (("run", "weights-poor", "--quick", "--steps", "9"), "--quick: has seeds and steps of its own"),
    ],
)
def test_a_wrong_argument_is_named(tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    answer = call(tmp_path, *arguments)
    assert answer.returncode == 2
    assert answer.stderr.startswith("hedon: ")
    assert message in answer.stderr
    assert list(tmp_path.iterdir()) == []
