"""The guide's lines for reading records with other tools give the same results as hedon itself."""

import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

import duckdb
import pandas as pd
import pytest
from project_files import ROOT
from resumed_run import WINDOW, small_run

import hedon
from hedon.export.table import table_of, write_table

GUIDE = (ROOT / "docs" / "guide" / "export.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def most(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[int, int]]:
    """A folder in which `runs/mine` is a run of two species, and the most agents alive at any step, by seed."""
    place = tmp_path_factory.mktemp("tools")
    few = ("species.many.population.initial_count=16", "species.few.population.initial_count=8")
    small_run(place / "runs" / "mine", 8 * WINDOW, overrides=few)
    rows = hedon.open_run(place / "runs" / "mine").population()
    assert rows["species"].n_unique() == 2
    living: Counter[tuple[int, int]] = Counter()
    for row in rows.iter_rows(named=True):
        living[row["seed"], row["step"]] += row["alive"]
    return place, {seed: max(alive for (each, _), alive in living.items() if each == seed) for seed, _ in living}


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
