"""The sentence of a report, its figures and the summary describe the same agents: those alive at the end."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.measure.summary import summarize
from hedon.record.reader import open_run
from hedon.report.analysis import analyze
from hedon.report.condition import condition_figures


@pytest.mark.parametrize("extinct", [0, None])
def test_sentence_figure_and_summary_are_about_the_same_agents(tmp_path: Path, extinct: int | None):
    run = open_run(write_run(tmp_path / "run", intervals=12, worlds=1, extinct=extinct, selection=1.0))
    analysis = analyze([run], ["drift"])
    (worlds,) = analysis.conditions.values()
    rows = worlds[0].population.filter(pl.col("alive") > 0)
    mean, generation = rows["w_normal_mean"][-1], rows["generation_mean"][-1]
    said = next(iter(analysis.answers.values()))[0]
    assert f"the mean weight of normal food is {mean:+z.2f}" in said
    assert f"(mean generation {generation:.1f})" in said
    assert ("at the last record of a world that died out" in said) == (extinct is not None)
    assert summarize(run)["worlds"][0]["weights"]["w_normal"]["mean"] == pytest.approx(mean, abs=1e-5)
    figures = condition_figures(worlds, {})
    history, weights = next(figures), next(figures)
    line = next(line for line in history.figure.axes[0].lines if line.get_linewidth() == 2.0)
    assert np.asarray(line.get_ydata())[-1] == pytest.approx(mean, abs=1e-5)
    points = np.asarray(weights.figure.axes[0].collections[0].get_offsets())
    assert (len(points), points[:, 0].mean()) == (rows["alive"][-1], pytest.approx(mean, abs=1e-5))
