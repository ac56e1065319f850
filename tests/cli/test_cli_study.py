"""`hedon reproduce` as a user calls it."""

import json
import re
from pathlib import Path
from subprocess import CompletedProcess

import pytest
from command import hedon as command

import hedon
from hedon.study.catalogue import ITEMS

LAWS = ("hazard", "birth", "walk", "body", "parameters")


def call(folder: Path, *arguments: str) -> "CompletedProcess[str]":
    return command("reproduce", *arguments, cwd=folder)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which two items of the baseline were made, on two worlds of 1024 steps, and what was printed."""
    folder = tmp_path_factory.mktemp("reproduce")
    answer = call(folder, "weights-baseline", "history-baseline", "--seeds", "1-2", "--steps", "1024")
    assert answer.returncode == 0, answer.stderr
    assert "2 items (corrected) from 2 worlds: 1 run to make in runs, 2,048 world-steps" in answer.stdout
    return folder


def test_items_of_settings_alone_need_no_run(tmp_path: Path) -> None:
    answer = call(tmp_path, *LAWS, "--fidelity", "released")
    assert answer.returncode == 0, answer.stderr
    assert "from 0 worlds: 0 runs to make" in answer.stdout
    assert not (tmp_path / "runs").exists()
    found = json.loads((tmp_path / "reproduction" / "reproduction.json").read_text(encoding="utf-8"))
    assert {item["name"] for item in found["items"]} == set(LAWS)
    assert found["fidelity"] == "released"
    growth = [row for row in found["tables"]["parameters_food"]["rows"] if row["setting"] == "food.normal.growth_rate"]
    assert growth[0]["value"] == "1.0"
    for name in ("hazard", "birth", "walk", "body"):
        assert (tmp_path / "reproduction" / "figures" / f"{name}.png").stat().st_size > 10_000


def test_the_page_holds_its_figures_and_says_what_they_are_made_of(made: Path) -> None:
    text = (made / "reproduction" / "reproduction.html").read_text(encoding="utf-8")
    assert text.count("data:image/svg+xml;base64,") == 2
    assert not re.search(r'(src|href)="(?!data:|#)', text), "the page must stand alone"
    assert "Asked for: 2 worlds of 1,024 steps; the paper has 5 of 10,240,000." in text
    assert "The paper&#39;s claims" in text
    markdown = (made / "reproduction" / "reproduction.md").read_text(encoding="utf-8")
    for path in re.findall(r"\]\((figures/[^)]+)\)", markdown):
        assert (made / "reproduction" / path).is_file()
    numbers = json.loads((made / "reproduction" / "reproduction.json").read_text(encoding="utf-8"))
    assert numbers["items"][0]["worlds"][0]["worlds"] == "2 of 2"
    assert numbers["runs"][0]["manifest"]["seeds"] == [1, 2]
    assert (made / "reproduction" / "tables" / "verdict.csv").is_file()


def test_what_is_there_is_used_and_more_is_added(made: Path) -> None:
    again = call(made, "weights-baseline", "--seeds", "1-2", "--steps", "1024")
    assert "0 runs to make" in again.stdout
    more = call(made, "weights-baseline", "--seeds", "2-3", "--steps", "2048")
    assert more.returncode == 0, more.stderr
    assert "2 runs to make in runs, 4,096 world-steps" in more.stdout
    assert hedon.open_run(made / "runs" / "baseline-corrected-s1-2").manifest.steps_done == (2048, 2048)
    assert hedon.open_run(made / "runs" / "baseline-corrected-s3").manifest.steps_done == (2048,)


def test_the_list_names_every_item_with_a_measured_time(tmp_path: Path) -> None:
    answer = call(tmp_path, "list", "--threads", "1")
    assert answer.returncode == 0, answer.stderr
    for name in ITEMS:
        assert re.search(rf"^ {re.escape(name)} ", answer.stdout, re.MULTILINE)
    assert re.search(r"Measured now: [\d,]+ world-steps/s on 1 thread with \d+ agents", answer.stdout)
    assert re.search(r"^ together .* \d+ h \d\d min", answer.stdout, re.MULTILINE)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("weigths-poor",), "there is no item 'weigths-poor'; did you mean weights-poor?"),
        (("hazard", "--fidelity", "relesed"), "--fidelity: 'relesed' is not one of corrected, released, text"),
        (("hazard", "list"), "there is no item 'list'; `list` comes first"),
        (("hazard", "--out", "/proc/none"), "cannot write /proc/none"),
        (("weights-poor", "--seeds", "5-1"), "--seeds: '5-1' is not a range of seeds"),
    ],
)
def test_a_wrong_word_is_named(tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    answer = call(tmp_path, *arguments)
    assert answer.returncode == 2
    assert answer.stderr.startswith("hedon: ")
    assert message in answer.stderr
    assert list(tmp_path.iterdir()) == []
