"""Makes jobs where it is asked: in processes on this machine, or on a Ray cluster."""

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
    """Makes jobs, each in a process of its own; those whose runs are begun go on.

    Returns:
        How each job ended, by its run's folder; jobs that never began are missing.

    Raises:
        EnsembleError: Ray is not installed, or no cluster is at the address.
    """
    if ray is None:
        return make_here(jobs, threads or usable_cpus(), display)
    from hedon.ensemble.cluster import make_on_ray

    return make_on_ray(jobs, ray, display, threads)
