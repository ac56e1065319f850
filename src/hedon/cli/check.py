"""`hedon check`: checks a run's files, repeats the run, or explains why two runs differ."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.run import Threads
from hedon.error import ArgumentError
from hedon.record.error import RecordError
from hedon.text import count


def check(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="Folders of runs, finished or not; only read.")],
    replay: Annotated[
        bool,
        typer.Option("--replay", help="Also compute the run again, from its oldest checkpoint, and compare."),
    ] = False,
    against: Annotated[
        Path | None,
        typer.Option(
            metavar="RUN",
            help="Instead show why another run differs: settings, versions, and the step at which worlds part.",
        ),
    ] = None,
    fault: Annotated[
        bool,
        typer.Option(
            "--fault",
            help="Instead compute again from the last checkpoint before the run's fault: does it happen again?",
        ),
    ] = False,
    threads: Threads = 0,
) -> None:
    """Check that every file of a run is there, is not damaged, and agrees with the others.

    Prints what is wrong and what can still be used. Exit code 0 if nothing is wrong, if two runs agree or if a fault
    happens again; 1 if not; 2 if a folder holds no run.

    \b
    Examples:
      hedon check runs/*
      hedon check runs/baseline --replay
      hedon check runs/baseline-corrected-s1 --against runs/baseline-corrected-s1-run2
      hedon check runs/broken --fault
    """
    asked = [name for name, is_asked in (("--replay", replay), ("--against", against), ("--fault", fault)) if is_asked]
    if len(asked) > 1:
        raise ArgumentError(f"{asked[0]} and {asked[1]}: give one of them")
    if against is None and not fault:
        _check(runs, replay=replay, threads=threads)
    elif len(runs) > 1:
        raise ArgumentError(f"{asked[0]} is of one run, not of {len(runs)}")
    elif not (_replay_fault(runs[0], threads) if against is None else _compare(runs[0], against)):
        raise typer.Exit(1)


def _compare(run: Path, other: Path) -> bool:
    from hedon.cli.display.difference import show_difference

    return show_difference(run, other)


def _replay_fault(run: Path, threads: int) -> bool:
    """Repeats the steps before a fault. Returns whether it recurs; if not, the machine or a new source is the cause."""
    from hedon.experiment.fault import replay_fault

    found = replay_fault(run, threads)
    typer.echo(f"recorded: {found.recorded}")
    typer.echo(f"from step {found.start:,} on: {found.recurred or 'no fault'}")
    again = found.recurred == found.recorded
    causes = "Likely causes: bad memory in the machine, or a change of hedon's source."
    typer.echo("The same fault happened again." if again else f"It did not happen again. {causes}")
    return again


def _check(runs: list[Path], *, replay: bool, threads: int) -> None:
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
                found, note = replay_run(run, callbacks=[display.update])
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
