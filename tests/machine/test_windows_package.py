"""The Windows package under Wine: the published wheel in a Python for Windows."""

import json
from pathlib import Path

import pytest
from command import hedon
from sweep_case import assert_same_table, sweep_file, table_of
from windows_python import WindowsPython, make_windows_python, windows_path

from hedon.record.manifest import load_manifest

pytestmark = pytest.mark.long

RUN = ("appetite", "--seeds", "1-2", "--frames", "16", "--no-report")
SUITES = ("golden", "unit/record", "unit/config")


@pytest.fixture(scope="module")
def windows(tmp_path_factory: pytest.TempPathFactory) -> WindowsPython:
    return make_windows_python(tmp_path_factory.mktemp("windows"))


def same(folder: Path, other: Path) -> bool:
    a, b = load_manifest(folder), load_manifest(other)
    return (a.world_digests, a.records_digest) == (b.world_digests, b.records_digest)


@pytest.mark.parametrize("suite", SUITES)
def test_the_suite_passes(windows: WindowsPython, suite: str):
    how = ("-o", "addopts=", "-p", "no:cacheprovider", "-q", "-m", "not long")
    answer = windows.run("-m", "pytest", *how, f"tests/{suite}")
    assert answer.returncode == 0, answer.stdout[-5000:] + answer.stderr[-1000:]


def test_a_run_moves_between_windows_and_linux(windows: WindowsPython, tmp_path: Path):
    """Half of the run is made on each system, in a folder with an awkward name; the records must be equal."""
    whole, there, here = tmp_path / "whole", tmp_path / "Größe und 空間", tmp_path / "here"
    assert hedon("run", *RUN, "--steps", "600", "--out", str(whole)).returncode == 0
    windows.hedon("run", *RUN, "--steps", "300", "--out", there.name, folder=tmp_path)
    assert hedon("run", *RUN, "--steps", "300", "--out", str(here)).returncode == 0
    assert same(there, here)
    assert (load_manifest(there).platform or "").startswith("Windows")
    assert hedon("resume", str(there), "--steps", "600", "--no-report").returncode == 0
    windows.hedon("resume", windows_path(here), "--steps", "600", "--no-report", folder=tmp_path)
    assert same(there, whole)
    assert same(here, whole)
    assert "no problems" in windows.hedon("check", there.name, "--replay", folder=tmp_path)


def test_reports_pages_and_tables_are_made(windows: WindowsPython, tmp_path: Path):
    windows.hedon("run", "predator", "--steps", "1100", "--frames", "64", "--out", "run", folder=tmp_path)
    assert (tmp_path / "run" / "report.html").is_file()
    assert json.loads((tmp_path / "run" / "summary.json").read_text("utf-8"))
    windows.hedon("view", "run", "--export", "page", folder=tmp_path)
    assert (tmp_path / "page" / "hedon.wasm").is_file()
    windows.hedon("export", "agents", "run", "--out", "agents.csv", folder=tmp_path)
    assert hedon("export", "agents", tmp_path / "run", "--out", tmp_path / "here.csv").returncode == 0
    assert (tmp_path / "agents.csv").read_bytes() == (tmp_path / "here.csv").read_bytes()
    assert "kanagawa-doya-2024: " in windows.hedon("study", "list", folder=tmp_path)


def test_a_sweep_gives_the_same_table_as_on_linux(windows: WindowsPython, tmp_path: Path):
    """Two processes run it on Windows."""
    file = sweep_file(tmp_path)
    windows.hedon("sweep", "run", file.name, "--out", "there", "--workers", "2", folder=tmp_path)
    assert hedon("sweep", "run", file, "--out", tmp_path / "here", "--workers", "1").returncode == 0
    assert_same_table(table_of(str(tmp_path / "there")), table_of(str(tmp_path / "here")))
