"""Makes the runs that a command needs, and shows their progress and results."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from hedon.record.folder import CHECKPOINT_SECONDS
from hedon.statistic.minimum import few_seeds_note
from hedon.text import count, printable

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.ensemble.demand import Demand
    from hedon.ensemble.job import Job


def make_worlds(
    demands: "Sequence[Demand]",
    folder: Path,
    what: str,
    console: "Console",
    threads: int = 0,
    ray: str | None = None,
    checkpoint_seconds: float = CHECKPOINT_SECONDS,
) -> "tuple[Sequence[Job], dict[Path, str]]":
    """Makes the worlds that a folder lacks, and reports their number.

    Args:
        demands: Worlds that are needed.
        folder: Folder of the runs: existing ones are used, missing ones are added.
        what: Description of what needs them.
        console: Console to print on.
        threads: Number of threads on this machine, or on each node; 0 for all.
        ray: Address of a Ray cluster.
        checkpoint_seconds: Time between two checkpoints [s].

    Returns:
        The jobs that were needed, and the status of each that ended, by its folder.

    Raises:
        EnsembleError: The folder cannot be written, or there is no such cluster.
        RecordError: A folder holds a run with other settings.
    """
    from hedon.ensemble.ensemble import find_ensemble
    from hedon.ensemble.run_job import run_jobs

    ensemble = find_ensemble(demands, folder)
    jobs = run_jobs(ensemble, checkpoint_seconds)
    said = "all are there" if ensemble.size else "none is needed"
    if jobs:
        said = f"{count(len(jobs), 'run')} to make, {sum(job.world_steps for job in jobs):,} world-steps, in {folder}"
    console.print(f"hedon: {what}, {count(ensemble.size, 'world')}: {said}", soft_wrap=True)
    if jobs:
        tell_left_out(ensemble.faults)
        require_folder(folder)
    return jobs, make_runs(jobs, console, threads, ray)


def require_folder(folder: Path) -> None:
    """Creates an output folder, so that problems with it appear before anything is run.

    Raises:
        EnsembleError: The folder cannot be created or written.
    """
    from hedon.ensemble.error import EnsembleError

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise EnsembleError(f"cannot write {folder}: {error.strerror}") from None
    if not os.access(folder, os.W_OK):
        raise EnsembleError(f"cannot write {folder}: no permission")


def make_runs(jobs: "Sequence[Job]", console: "Console", threads: int = 0, ray: str | None = None) -> dict[Path, str]:
    """Makes runs and shows their progress; lists them first if they are few.

    Returns:
        The status of each that ended, by its folder.

    Raises:
        EnsembleError: There is no such cluster.
    """
    from hedon.cli.display.job import MOST_TOLD, JobDisplay
    from hedon.ensemble.process import make_jobs

    for job in jobs if len(jobs) <= MOST_TOLD else ():
        verb, worlds = "continue" if job.newest() else "begin", count(len(job.seeds), "world")
        console.print(f"  {verb} {printable(job.label)}: {worlds} to {job.steps:,} steps", soft_wrap=True)
    with JobDisplay(console, jobs) as display:
        outcomes = make_jobs(jobs, display, threads, ray)
    return {folder: outcome.status for folder, outcome in outcomes.items()}


def tell_left_out(faults: Sequence[str]) -> None:
    """Reports which runs are not used and why, before others are made in their place."""
    for fault in faults:
        typer.echo(f"hedon: note: left out: {fault}", err=True)


def tell_few_seeds(seeds: int, *, compared: bool, of: str = "") -> None:
    """Reports what so few seeds cannot show, before hours are spent on them; silent if there are enough.

    Args:
        seeds: Number of seeds of each condition.
        compared: Whether conditions are compared.
        of: The part of the experiment that has so few seeds; empty for all of it.
    """
    if note := few_seeds_note(seeds, compared=compared):
        typer.echo(f"hedon: note: {of and f'{of}: '}{note}", err=True)


def require_finished(
    jobs: "Sequence[Job]", ends: Mapping[Path, str], console: "Console", again: str = "The same command continues."
) -> None:
    """Ends the command with the reason unless all runs are finished.

    Raises:
        EnsembleError: A run failed.
        typer.Exit: Some runs were interrupted.
    """
    from hedon.ensemble.error import EnsembleError
    from hedon.experiment.interrupt import interrupted_code

    failed = [job.label for job in jobs if ends.get(job.folder) == "failed"]
    left = [job for job in jobs if ends.get(job.folder) not in ("finished", "failed")]
    if left:
        console.print(
            f"Interrupted: {len(left)} of {count(len(jobs), 'run')} are not finished; all results so far are kept.\n"
            + again,
            soft_wrap=True,
        )
    if failed:
        shown = ", ".join(failed[:5])
        raise EnsembleError(f"{len(failed)} of {len(jobs)} runs failed (see the reasons above): {shown}. {again}")
    if left:
        raise typer.Exit(interrupted_code())
