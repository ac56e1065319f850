import json
from pathlib import Path

from synthetic_run import write_run
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.record.error import RecordError
from hedon.report.topic import TopicError


def test_analyze_prints_and_writes(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=20, worlds=3, snapshot=False)
    result = CliRunner().invoke(app, ["analyze", str(folder), "--only", "lifetime,regime"])
    assert result.exit_code == 0, result.output
    assert "Lifetimes, means over worlds" in result.output
    assert "Price" not in result.output
    assert {file.stem for file in (folder / "analysis").iterdir()} >= {"analysis", "lifetime", "regime_time"}


def test_analyze_takes_several_runs_together(tmp_path: Path) -> None:
    runs = [str(write_run(tmp_path / name, intervals=5, worlds=n, snapshot=False)) for name, n in (("a", 1), ("b", 2))]
    out = tmp_path / "out"
    result = CliRunner().invoke(app, ["analyze", *runs, "--only", "food", "--out", str(out)])
    assert result.exit_code == 0, result.output
    content = json.loads((out / "analysis.json").read_text())
    assert len(content["runs"]) == 2
    assert [world["condition"] for world in content["worlds"]].count("baseline (corrected) [b]") == 2


def test_wrong_arguments_raise_hedon_errors(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=2, worlds=1, snapshot=False)
    assert isinstance(CliRunner().invoke(app, ["analyze", str(folder), "--only", "life"]).exception, TopicError)
    assert isinstance(CliRunner().invoke(app, ["analyze", str(tmp_path)]).exception, RecordError)
