"""Makes the runs that a command needs, and shows how they go on and end."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hedon.text import printable

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.jobs.run import RunJob


def count(number: int, noun: str) -> str:
    """A number of things: "1 run", "2 runs".

    Args:
        number: How many.
        noun: In the singular.
    """
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def make_runs(
    jobs: "Sequence[RunJob]", console: "Console", threads: int = 0, ray: str | None = None
) -> dict[Path, str]:
    """Makes runs: says what they are, and shows them.

    Args:
        jobs: In the order in which they begin.
        console: To print on.
        threads: To use in total; 0 for all processors.
        ray: Address of a Ray cluster; None for this machine.

    Returns:
        The status of each that ended, by its folder.

    Raises:
        JobError: There is no such cluster.
    """
    from hedon.cli.display.job import JobDisplay
    from hedon.jobs.make import make_jobs

    for job in jobs:
        verb, worlds = "continue" if job.begun else "begin", count(len(job.plan.seeds), "world")
        folder = printable(str(job.folder))
        console.print(f"  {verb} {folder}: {worlds} to {job.plan.steps:,} steps", soft_wrap=True)
    with JobDisplay(console, jobs) as display:
        outcomes = make_jobs(jobs, display, threads, ray)
    return {folder: outcome.status for folder, outcome in outcomes.items()}


def all_finished(jobs: "Sequence[RunJob]", ends: Mapping[Path, str], console: "Console") -> bool:
    """Whether all runs are finished; says so if some were interrupted.

    Args:
        jobs: All of them.
        ends: As `make_runs` gives them.
        console: To print on.

    Raises:
        JobError: One failed.
    """
    from hedon.jobs.error import JobError

    failed = [str(job.folder) for job in jobs if ends.get(job.folder) == "failed"]
    left = [job for job in jobs if ends.get(job.folder) not in ("finished", "failed")]
    if left:
        console.print(
            f"Interrupted: {len(left)} of {count(len(jobs), 'run')} are not finished; all results so far are kept. "
            "The same command goes on."
        )
    if failed:
        raise JobError(f"{len(failed)} of {len(jobs)} runs failed (see the reasons above): {', '.join(failed)}")
    return not left
