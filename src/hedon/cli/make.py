"""Makes the runs that a command needs, and shows how they go on and end."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from hedon.text import count, printable

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.jobs.work import Job


def make_runs(jobs: "Sequence[Job]", console: "Console", threads: int = 0, ray: str | None = None) -> dict[Path, str]:
    """Makes runs: says what they are if they are few, and shows them.

    Returns:
        The status of each that ended, by its folder.

    Raises:
        JobError: There is no such cluster.
    """
    from hedon.cli.display.job import MOST_TOLD, JobDisplay
    from hedon.jobs.make import make_jobs

    for job in jobs if len(jobs) <= MOST_TOLD else ():
        verb, worlds = "continue" if job.newest() else "begin", count(len(job.seeds), "world")
        folder = printable(str(job.folder))
        console.print(f"  {verb} {folder}: {worlds} to {job.steps:,} steps", soft_wrap=True)
    with JobDisplay(console, jobs) as display:
        outcomes = make_jobs(jobs, display, threads, ray)
    return {folder: outcome.status for folder, outcome in outcomes.items()}


def tell_left_out(faults: Sequence[str]) -> None:
    """Says which runs are not used and why, before others are made in their stead."""
    for fault in faults:
        typer.echo(f"hedon: note: left out: {fault}", err=True)


def require_finished(
    jobs: "Sequence[Job]", ends: Mapping[Path, str], console: "Console", again: str = "The same command goes on."
) -> None:
    """Ends the command, and says why, unless all runs are finished.

    Raises:
        JobError: A run failed.
        typer.Exit: Some were interrupted.
    """
    from hedon.experiment.interrupt import interrupted_code
    from hedon.jobs.error import JobError

    failed = [str(job.folder) for job in jobs if ends.get(job.folder) == "failed"]
    left = [job for job in jobs if ends.get(job.folder) not in ("finished", "failed")]
    if left:
        console.print(
            f"Interrupted: {len(left)} of {count(len(jobs), 'run')} are not finished; all results so far are kept.\n"
            + again,
            soft_wrap=True,
        )
    if failed:
        shown = ", ".join(failed[:5])
        raise JobError(f"{len(failed)} of {len(jobs)} runs failed (see the reasons above): {shown}. {again}")
    if left:
        raise typer.Exit(interrupted_code())
