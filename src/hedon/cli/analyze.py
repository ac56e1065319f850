"""The command `hedon analyze`."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.console import make_console
from hedon.text import printable


def analyze(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN…", help="Folders of runs, finished or not.")],
    only: Annotated[
        str | None, typer.Option(metavar="TOPIC,…", help="Only these topics, as in lifetime,selection.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder of the results; by default RUN/analysis, or analysis for several runs.")
    ] = None,
) -> None:
    """Answer statistical questions about runs, and write every number.

    Runs of equal configs are replicates of one condition, and worlds are the units of analysis. Prints short
    tables and writes analysis.json and one CSV file per table. docs/guide/analysis.md explains them.

    \b
    Topics:
      verdict     claims of studies about these conditions: holds, fails or undecided
      regime      starving, limited by food, or full and idle, over time
      lifetime, food, energy, reproduction, generation   single lives
      genealogy   common descent, founder families, lines of the survivors
      genome      weights by birth cohort
      selection   differentials and gradients; price splits the change
      curvature   stabilizing or disruptive: quadratic gradients
      drift       weights against neutral walks and neutral genes
      reversion   held near a value? Ornstein-Uhlenbeck against drift
      mode        one mode or two, over worlds
      mutation    what a child's own mutation does to its life, among siblings

    \b
    Examples:
      hedon analyze runs/baseline
      hedon analyze runs/a runs/b --only lifetime,selection --out answers
    """
    # Imported here because this takes seconds, and other commands must not wait for it.
    from hedon.cli.display.analysis import analysis_group
    from hedon.cli.display.step import StepDisplay
    from hedon.record.reader import open_run
    from hedon.report.analysis import ANALYSIS, write_analysis
    from hedon.report.analysis import analyze as answer
    from hedon.report.topic import choose_topics

    topics = choose_topics(only)
    with StepDisplay("analyzing") as tell:
        analysis = answer([open_run(run) for run in runs], topics, tell)
    folder = out or (runs[0] / ANALYSIS if len(runs) == 1 else Path(ANALYSIS))
    console = make_console()
    console.print(analysis_group(analysis.tables))
    for sentence in analysis.unfinished:
        console.print(printable(sentence), soft_wrap=True)
    files = write_analysis(analysis, folder)
    console.print(f"wrote {files[0]} and {len(files) - 1} tables next to it", soft_wrap=True)
