"""How a run is displayed, and how it hands its tables to other libraries."""

import builtins
import re
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import polars as pl
import pytest
from synthetic_run import write_run

from hedon import ArgumentError, Run, open_run


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return open_run(write_run(tmp_path_factory.mktemp("shown") / "run", intervals=12, worlds=2))


def test_a_run_describes_itself_in_one_line(run: Run) -> None:
    assert repr(run) == f"<Run {run.path}: baseline (corrected), 2 worlds, finished at step 12,288 of 12,288>"


def test_a_notebook_shows_worlds_and_a_figure(run: Run) -> None:
    shown = ElementTree.fromstring(run._repr_html_().replace("<br>", "<br/>"))
    last = run.population().filter(pl.col("step") == 12_288)
    rows = [tuple(int(cell.text or "") for cell in row) for row in shown.findall("table/tbody/tr")]
    births = run.population().group_by("seed", maintain_order=True).agg(pl.col("births", "deaths").sum())
    assert rows == last.select("seed", "step", "alive").join(births, on="seed").rows()
    figure = shown.find("svg")
    assert figure is not None
    lines = [line.attrib["points"].split() for line in figure.findall("polyline")]
    assert [len(points) for points in lines] == [12, 12]
    # The highest point of all lines is the largest number alive, at the top of the axes.
    heights = np.array([[float(point.split(",")[1]) for point in points] for points in lines])
    alive = run.population()["alive"].to_numpy().reshape(2, 12)
    assert np.unravel_index(heights.argmin(), heights.shape) == np.unravel_index(alive.argmax(), alive.shape)


def test_text_from_a_manifest_is_escaped(run: Run) -> None:
    named = replace(run, path=Path("<img src=x>"), manifest=replace(run.manifest, name="<script>"))
    object.__setattr__(named, "population", run.population)
    assert not re.search("<img|<script", named._repr_html_())


def test_an_empty_run_has_no_figure(tmp_path: Path) -> None:
    empty = open_run(write_run(tmp_path / "run", intervals=0, worlds=1))
    assert "<svg" not in empty._repr_html_()
    assert "<td>0</td>" in empty._repr_html_()


@pytest.mark.parametrize("table", ["agents", "population"])
def test_pandas_has_the_same_rows(table: str, run: Run) -> None:
    ours: pl.DataFrame = getattr(run, table)()
    theirs: pd.DataFrame = getattr(run, table)(frame="pandas")
    assert list(theirs.columns) == ours.columns
    assert len(theirs) == ours.height
    for name in ours.columns:
        assert theirs[name].isna().tolist() == ours[name].is_null().to_list(), name
        assert theirs[name].dropna().tolist() == ours[name].drop_nulls().to_list(), name
    theirs.loc[0, "seed"] = 5  # a copy, so it can be changed


def test_other_libraries_are_refused(run: Run) -> None:
    asked: Any = "panda"
    with pytest.raises(ArgumentError, match=r"frame = 'panda': must be one of polars, pandas; did you mean 'pandas'\?"):
        run.agents(frame=asked)


def test_without_pandas_the_message_says_what_to_install(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *arguments: Any, **options: Any) -> Any:
        if name == "pandas":
            raise ModuleNotFoundError("No module named 'pandas'", name="pandas")
        return real(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ArgumentError, match=r'needs pandas: pip install "hedon\[pandas\]"'):
        run.agents(frame="pandas")
