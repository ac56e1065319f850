"""Makes jobs on a Ray cluster: a task for each, begun again on another node when its node dies.

A task goes on from its job's last checkpoint. It finds that in a folder that all nodes share, or behind a URL.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

from hedon.ensemble.error import EnsembleError
from hedon.ensemble.job import Job, Outcome, attempt
from hedon.ensemble.process import JobListener
from hedon.experiment.interrupt import count_interrupts

T = TypeVar("T", bound=Job)

LOCAL = "local"
"""The address of a cluster that is started on this machine, for these jobs alone."""
IN_FLIGHT = 4
"""Jobs for each processor that Ray is given at a time: it needs memory and time for each that it knows."""
TRIES = 5
"""How often in a row a job may be begun without getting further. One that writes a checkpoint may be lost again."""
_LOOK_SECONDS = 0.5


@dataclass
class RetryLimit:
    """Counts how often each job was lost, with its node or alone, without getting further."""

    _seen: dict[Path, tuple[str, int]] = field(default_factory=dict)

    def may_go_on(self, job: Job) -> bool:
        """Notes that a job was lost. Whether it is worth another try."""
        place = job.newest()
        before, count = self._seen.get(job.folder, (place, 0))
        count = count + 1 if place == before else 1
        self._seen[job.folder] = place, count
        return count < TRIES

    def reason(self, job: Job, error: Exception) -> str:
        """Why a job is given up: which worlds, what was seen last, and what to do."""
        first = str(error).strip().partition("\n")[0]
        return (
            f"its process was lost {TRIES} times in a row without a new checkpoint, the last time with: {first} Its "
            f"worlds: {job.describe()}. If memory runs out, take nodes with more, or fewer `worlds` in a batch; if "
            "nodes live too briefly, lower --checkpoint"
        )


def make_on_ray(jobs: Sequence[T], address: str, display: JobListener[T], workers: int = 0) -> dict[Path, Outcome]:
    """Makes jobs on a cluster; one processor each. Ctrl-C ends it after the current windows.

    Returns:
        How each job ended, by its run's folder; jobs that never began are missing.

    Raises:
        EnsembleError: Ray is not installed, or no cluster is at the address.
    """
    ray = import_ray()
    try:
        if address == LOCAL:
            # A new one, also where another runs. It answers here alone.
            settings = {"num_cpus": workers or None, "include_dashboard": False, "_node_ip_address": "127.0.0.1"}
            ray.init(address="local", log_to_driver=False, **settings)
        else:
            ray.init(address=address, log_to_driver=False)
    except (ConnectionError, ValueError, RuntimeError) as error:
        raise EnsembleError(f"--ray = {address!r}: no cluster answers there: {error}") from error
    try:
        return _see_through(ray, jobs, RetryLimit(), display)
    finally:
        ray.shutdown()


def import_ray() -> Any:
    """Ray, told what is wanted of it; its settings count when it is imported.

    Raises:
        EnsembleError: It is not installed.
    """
    # It reports to nobody unless asked to.
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    # Each node has its own hedon. Else, under `uv run`, Ray copies the current folder to each node and builds it there.
    os.environ.setdefault("RAY_ENABLE_UV_RUN_RUNTIME_ENV", "0")
    try:
        return import_module("ray")
    except ImportError:
        raise EnsembleError('--ray needs the optional packages: pip install "hedon[ray]"') from None


def _see_through(ray: Any, jobs: Sequence[T], limit: RetryLimit, display: JobListener[T]) -> dict[Path, Outcome]:
    """Submits jobs and awaits them; those whose process is lost again, as long as that leads further."""
    lost = (ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError, ray.exceptions.OutOfMemoryError)
    # Ray's own tries have no end where memory runs out, and do not see whether a job gets further.
    remote = ray.remote(num_cpus=1, max_retries=0)(attempt)
    room = IN_FLIGHT * max(1, int(ray.cluster_resources().get("CPU", 1)))
    left, waiting = iter(jobs), dict[Any, T]()
    outcomes: dict[Path, Outcome] = {}
    with count_interrupts() as interrupted:
        told = 0
        while True:
            free = 0 if interrupted.count else room - len(waiting)
            waiting |= {remote.remote(job, 1): job for job in islice(left, free)}
            if not waiting:
                break
            for done in ray.wait(list(waiting), num_returns=len(waiting), timeout=_LOOK_SECONDS)[0]:
                job = waiting.pop(done)
                try:
                    outcome = ray.get(done)
                except ray.exceptions.RayError as error:
                    if interrupted.count:  # it was called off
                        continue
                    if isinstance(error, lost) and limit.may_go_on(job):
                        waiting[remote.remote(job, 1)] = job
                        continue
                    outcome = Outcome("failed", limit.reason(job, error) if isinstance(error, lost) else str(error))
                outcomes[job.folder] = outcome
                display.end(job, outcome)
            if told < interrupted.count:
                told = interrupted.count
                for each in waiting:  # those that have not begun are dropped, others get Ctrl-C
                    ray.cancel(each, force=told > 1)
    return outcomes
