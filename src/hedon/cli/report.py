"""The command `hedon report`."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.console import make_console


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
    # Imported here: they take a second, which no other command should wait for.
    import json

    from hedon.analysis.report import write_report
    from hedon.analysis.summary_table import summary_table
    from hedon.record.reader import open_run

    files = write_report(open_run(run))
    console = make_console()
    console.print(summary_table(json.loads(files[0].read_text(encoding="utf-8"))))
    for file in files:
        console.print(f"wrote {file}", soft_wrap=True)
