"""`python -m benchmarks` as a user runs it."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks import bench
from benchmarks.__main__ import app
from benchmarks.check import CheckError

ROOT = Path(__file__).parents[2]
HERE = tuple(name for name in bench.PARTS if name != "device")


def call(*arguments):
    words = [sys.executable, "-m", "benchmarks", *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, check=False, cwd=ROOT)


def numbers(value):
    """All numbers in a document, each with the name of its entry."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from ((name, each) if inner is None else (inner, each) for inner, each in numbers(item))
    elif isinstance(value, list):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield None, value


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """All parts at tiny sizes, and the printed output."""
    path = tmp_path_factory.mktemp("bench") / "here.json"
    answer = call("--quick", "--threads", "1,2", "--json", path, *HERE)
    assert answer.returncode == 0, answer.stderr
    return json.loads(path.read_text()), answer.stdout


def test_every_part_prints_a_table_and_what_the_machine_can_do(measured):
    document, printed = measured
    for name in HERE:
        assert f"\n{name}: " in printed
    assert printed.count("machine: ") == len(HERE)
    assert document["machine"]["processor"] in printed
    assert document["machine"]["date"] in printed


def test_the_file_has_finite_numbers_for_every_part(measured):
    document, _ = measured
    assert document["format_version"] == bench.FORMAT_VERSION == 1
    assert list(document["parts"]) == list(HERE)
    assert document["plan"]["threads"] == [1, 2]
    found = list(numbers(document["parts"])) + list(numbers(document["calibration_after"]))
    assert len(found) > 200
    assert all(math.isfinite(value) for _, value in found)
    times = [(name, value) for name, value in found if name is not None and "seconds" in name]
    assert len(times) > 100
    # The clock of the writing threads is coarse, and the tiny stream gives them little to do.
    assert [name for name, value in times if value <= 0 and name != "stream_thread_cpu_seconds"] == []


def test_the_file_has_a_row_for_each_case(measured):
    parts, kernels = measured[0]["parts"], measured[0]["plan"]["kernels"]
    for name in ("rays", "forward", "update"):
        assert [row["kernel"] for row in parts[name]] == kernels
    assert [row["threads"] for row in parts["physics"]] == [1, 2]
    assert [(row["discs"], row["threads"]) for row in parts["discs"]] == [(150, 1), (150, 2)]
    assert all(row["rebuilds_per_step"] > 0 for row in parts["discs"])
    assert [(row["threads"], row["worlds"]) for row in parts["world"][:3]] == [(1, 1), (2, 1), (2, 2)]
    assert [row["kernel"] for row in parts["world"][3:]] == kernels[1:]
    assert [(row["slots"], row["threads"]) for row in parts["growth"]] == [(200, 1), (200, 2), (400, 1), (400, 2)]
    one, two, both = (row["digests"] for row in parts["world"][:3])
    assert one == two == both[:1]  # neither threads nor other worlds change anything
    assert len(set(both)) == 2
    for row in parts["world"]:
        assert len(row["window_seconds"]) == measured[0]["plan"]["windows"]
        assert row["floor_learning_seconds"] > 0
        assert row["learners_per_window"] <= max(row["alive"])


def test_an_unknown_part_gets_the_list_of_parts_and_a_suggestion():
    answer = call("word")
    assert answer.returncode == 2
    assert answer.stderr == (
        "hedon: 'word' is not a part (there are rays, forward, update, physics, discs, world, records, startup, value, "
        "rule, device, growth, crowd); did you mean world?\n"
    )


def test_a_file_that_cannot_be_written_is_reported(tmp_path):
    answer = call("rays", "--quick", "--json", tmp_path / "none" / "a.json")
    assert answer.returncode == 2
    assert answer.stderr == f"hedon: --json: cannot write {tmp_path / 'none' / 'a.json'}: No such file or directory\n"
    assert answer.stdout == ""  # reported before anything was measured


def test_a_failed_check_ends_in_exit_code_1_and_names_the_part(monkeypatch):
    def measure(plan, calibration):
        raise CheckError("the world of seed 1 at step 3 has died out")

    monkeypatch.setitem(bench.PARTS, "rays", bench.Part("", measure, bench.PARTS["rays"].table))
    answer = CliRunner().invoke(app, ["--quick", "rays"])
    assert answer.exit_code == 1
    assert "rays is not reported, because its check failed: the world of seed 1 at step 3 has died out" in answer.output


def test_the_help_names_every_part():
    answer = call("--help")
    assert answer.returncode == 0
    for name, part in bench.PARTS.items():
        assert f"{name:9} {part.about}" in answer.stdout


def test_the_former_command_names_its_replacement():
    answer = subprocess.run(["hedon", "bench", "world"], capture_output=True, text=True, check=False)
    assert answer.returncode == 2
    assert answer.stderr == (
        "hedon: there is no command 'bench': the benchmarks are not in the package any more: "
        "call `uv run python -m benchmarks` in a checkout\n"
    )
