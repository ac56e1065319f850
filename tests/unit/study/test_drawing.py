"""The figures of the study of same genes and another learner are drawn from its committed tables."""

import shutil
from pathlib import Path

import pytest

from hedon_studies.same_genes_another_learner import drawing

RESULTS = Path(__file__).parents[3] / "docs" / "results" / "learner"


def test_a_missing_table_of_a_figure_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        drawing.main([str(tmp_path)])
    assert ended.value.code == 2
    assert "founders.parquet: there is no such file" in capsys.readouterr().err


def test_each_part_has_its_figure_next_to_its_table(tmp_path: Path) -> None:
    folder = tmp_path / "learner"
    shutil.copytree(RESULTS, folder, ignore=shutil.ignore_patterns("*.svg"))
    drawing.main([str(folder)])
    drawn = {path.relative_to(folder) for path in folder.rglob("*.svg")}
    assert drawn == {path.relative_to(RESULTS) for path in RESULTS.rglob("*.svg")}
    assert len(drawn) == 5
    page = (RESULTS.parent / "learner.md").read_text(encoding="utf-8")
    for path in drawn:
        assert (folder / path).stat().st_size > 10_000
        assert f"(learner/{path.as_posix()})" in page
