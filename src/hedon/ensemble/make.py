"""Runs jobs in processes on this machine or on a Ray cluster."""

from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

from hedon.ensemble.job import Job, Outcome
from hedon.ensemble.process import JobListener, make_here
from hedon.record.provenance import usable_cpus

T = TypeVar("T", bound=Job)


def make_jobs(
    jobs: Sequence[T], display: JobListener[T], threads: int = 0, ray: str | None = None
) -> dict[Path, Outcome]:
    """Runs jobs, each in its own process; runs that were started before are continued.

    Args:
        jobs: The jobs to run.
        display: Listener that is notified of each job's end and, on this machine, of its progress.
        threads: Threads on this machine, or processors of a local cluster; 0 for all.
        ray: Address of a Ray cluster; None to run on this machine.

    Returns:
        How each job ended, by the folder of its run; jobs that never started are missing.

    Raises:
        EnsembleError: Ray is not installed, or there is no cluster at the address.
    """
    if ray is None:
        return make_here(jobs, threads or usable_cpus(), display)
    from hedon.ensemble.cluster import make_on_ray

    return make_on_ray(jobs, ray, display, threads)
