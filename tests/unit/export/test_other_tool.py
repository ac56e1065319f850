"""The lines of the guide with which other tools read records give what hedon itself gives."""

import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import duckdb
import pandas as pd
import polars as pl
import pytest
from project_files import ROOT
from synthetic_run import write_run

import hedon
from hedon.export.table import table_of, write_table

GUIDE = (ROOT / "docs" / "guide" / "export.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def most(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[int, int]]:
    """A folder in which `runs/mine` is a run, and the most agents that lived at a time, by seed."""
    place = tmp_path_factory.mktemp("tools")
    run = hedon.open_run(write_run(place / "runs" / "mine", intervals=12, worlds=2))
    return place, dict(run.population().group_by("seed").agg(pl.col("alive").max()).iter_rows())


def lines(language: str) -> list[str]:
    return [block.strip() for block in re.findall(rf"```{language}\n(.*?)```", GUIDE, re.DOTALL)]


def test_duckdb(most: tuple[Path, dict[int, int]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(most[0])
    (query,) = lines("sql")
    assert dict(duckdb.execute(query).fetchall()) == most[1]


@pytest.mark.parametrize("line", lines("py"))
def test_pandas(line: str, most: tuple[Path, dict[int, int]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(most[0])
    found: Any = eval(line, {"pd": pd, "hedon": hedon})
    assert found.to_dict() == most[1]
    assert len(lines("py")) == 2


@pytest.mark.skipif(shutil.which("Rscript") is None, reason="needs R: apt-get install r-base-core")
def test_r(most: tuple[Path, dict[int, int]], tmp_path: Path) -> None:
    (line,) = lines("r")
    write_table(
        table_of(hedon.open_run(most[0] / "runs" / "mine"), "population"), "csv", tmp_path / "mine-population.csv"
    )
    script = f"found <- {line}; cat(sprintf('%d %d', found$seed, found$alive), sep = '\\n')"
    done = subprocess.run(["Rscript", "-e", script], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert {int(seed): int(alive) for seed, alive in map(str.split, done.stdout.splitlines())} == most[1]
