"""The command `hedon report`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console

if TYPE_CHECKING:
    from rich.console import Console


def report(
    run: Annotated[Path, typer.Argument(help="Folder of a run, finished or not.")],
) -> None:
    """Summarize a run and draw its figures.

    Writes RUN/summary.json and RUN/figures/*.png, over those that are there, and prints the figures beside
    the paper's. Works on a run that goes on, was interrupted or has damaged files; the summary then says so.

    Examples:

        hedon report runs/baseline

        hedon report runs/small && jq .mean_lifetime runs/small/summary.json
    """
    show_report(run, make_console())


def show_report(run: Path, console: "Console") -> None:
    """Writes a run's summary and figures, and prints the table and where the files are."""
    # Imported here: they take seconds, for which neither another command nor the start of a run should wait.
    import json

    from hedon.analysis.report import write_report
    from hedon.analysis.summary_table import summary_table
    from hedon.record.reader import open_run

    files = write_report(open_run(run))
    console.print(summary_table(json.loads(files[0].read_text(encoding="utf-8"))))
    for file in files:
        console.print(f"wrote {file}", soft_wrap=True)
