from pathlib import Path

import typer
from synthetic_run import write_run
from typer.testing import CliRunner

from hedon.cli.report import report
from hedon.record.error import RecordError

APP = typer.Typer()
APP.command()(report)


def test_report_prints_figures_and_files(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=3, worlds=1)
    result = CliRunner().invoke(APP, [str(folder)])
    assert result.exit_code == 0
    assert " lifetime of the dead [step]" in result.output
    assert f"wrote {folder}/figures/weights.svg" in result.output
    assert (folder / "summary.json").is_file()


def test_report_without_a_run_raises_a_hedon_error(tmp_path: Path) -> None:
    result = CliRunner().invoke(APP, [str(tmp_path)])
    assert isinstance(result.exception, RecordError)
