"""The command `hedon report`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from hedon.cli.console import make_console
from hedon.text import printable

if TYPE_CHECKING:
    from rich.console import Console

Figures = Literal["svg", "pdf", "png", "none"]


def report(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN…", help="Folders of runs, finished or not.")],
    out: Annotated[
        Path | None, typer.Option(help="Folder of the report; by default RUN itself, or report for several runs.")
    ] = None,
    figures: Annotated[
        Figures,
        typer.Option(help="Files of figures: svg; pdf or png as well; none draws none, which saves most of the time."),
    ] = "svg",
) -> None:
    """Summarize runs on one page, with figures, tables and the claims of studies about them.

    Writes report.html (one file that holds everything, for any browser), report.md, figures/*.svg and analysis/
    (every number, as JSON and CSV), and RUN/summary.json for each run. Existing files are replaced. Prints the
    results next to those that studies report for the preset. Also works on runs in progress, and on runs that were
    interrupted or have damaged files; the report points these out.

    \b
    Examples:
      hedon report runs/baseline
      hedon report runs/small runs/large --out comparison
    """
    show_report(runs[0], make_console(), *runs[1:], out=out, figures=figures)


def show_report(run: Path, console: "Console", *others: Path, out: Path | None = None, figures: str = "svg") -> None:
    """Writes a report on one or more runs, and prints their summaries and the paths of the files."""
    # Imported here because this takes seconds, and neither other commands nor the start of a run must wait for it.
    import json

    from hedon.cli.display.step import StepDisplay
    from hedon.cli.display.summary import answer_lines, summary_table
    from hedon.record.reader import open_run
    from hedon.report.run import write_report

    runs = [open_run(path) for path in (run, *others)]
    with StepDisplay("writing the report") as tell:
        files = write_report(*runs, folder=out, figures=figures, tell=tell)
    for file in files[: len(runs)]:
        console.print(summary_table(json.loads(file.read_text(encoding="utf-8"))))
    made = next(file for file in files if file.name == "analysis.json")
    found = json.loads(made.read_text(encoding="utf-8"))
    console.print(*answer_lines(found["answers"]), sep="\n")
    for sentence in found["unfinished"]:
        console.print(printable(sentence), soft_wrap=True)
    for file in files:
        console.print(f"wrote {printable(str(file))}", soft_wrap=True)
