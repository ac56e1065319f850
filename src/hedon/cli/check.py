"""`hedon check`: whether runs hold what they say."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.record.error import RecordError


def check(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="Folders of runs, finished or not; only read.")],
    replay: Annotated[
        bool,
        typer.Option("--replay", help="Also compute the run again, from the oldest checkpoint that it keeps."),
    ] = False,
) -> None:
    """Check runs: that every file is there, whole, and agrees with all others.

    Says what is wrong and what can still be used. Exit code 0 where all is well, 1 where something is wrong, 2 where a
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
            from hedon.experiment.replay import replay_run

            found, note = replay_run(run)
            findings += found
            notes.append(note)
        elif replay:
            notes.append("not computed again, since something is wrong already")
        typer.echo(f"{run}: " + (f"{len(findings)} wrong" if findings else "all well"))
        for finding in findings:
            typer.echo(f"  wrong: {finding.where}: {finding.what}")
        for note in notes:
            typer.echo(f"  note: {note}")
        for usable in verdict.usable if findings else ():
            typer.echo(f"  usable: {usable}")
        code = max(code, 1 if findings else 0)
    if code:
        raise typer.Exit(code)
