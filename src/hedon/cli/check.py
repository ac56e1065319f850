"""`hedon check`: checks whether the files of runs are complete and agree."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.record.error import RecordError
from hedon.text import count


def check(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="Folders of runs, finished or not; only read.")],
    replay: Annotated[
        bool,
        typer.Option("--replay", help="Also compute the run again, from its oldest checkpoint, and compare."),
    ] = False,
) -> None:
    """Check that every file of a run is there, is not damaged, and agrees with the others.

    Prints what is wrong and what can still be used. Exit code 0 if nothing is wrong, 1 if something is wrong, 2 if a
    folder holds no run.

    \b
    Examples:
      hedon check runs/*
      hedon check runs/baseline --replay
    """
    from hedon.check.run import check_run

    code = 0
    for run in runs:
        try:
            verdict = check_run(run)
        except RecordError as error:
            typer.echo(f"hedon: {error}", err=True)
            code = 2
            continue
        findings, notes = list(verdict.findings), list(verdict.notes)
        if replay and not findings:
            from hedon.cli.console import make_console
            from hedon.cli.display.run import RunDisplay
            from hedon.experiment.replay import replay_run
            from hedon.record.reader import open_run

            opened = open_run(run)
            with RunDisplay(make_console(stderr=True), opened.columns, opened.manifest.seeds) as display:
                found, note = replay_run(run, display=display)
            findings += found
            notes.append(note)
        elif replay:
            notes.append("not computed again, because of the problems")
        typer.echo(f"{run}: " + (count(len(findings), "problem") if findings else "no problems"))
        for finding in findings:
            typer.echo(f"  wrong: {finding.where}: {finding.what}")
        for note in notes:
            typer.echo(f"  note: {note}")
        for usable in verdict.usable if findings else ():
            typer.echo(f"  usable: {usable}")
        code = max(code, 1 if findings else 0)
    if code:
        raise typer.Exit(code)
