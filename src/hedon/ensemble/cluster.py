"""Runs jobs on a Ray cluster, each as a task that is restarted on another node if its node dies.

A task continues from the last checkpoint of its job, which it finds in a folder that all nodes share, or behind a URL.
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
"""The address that starts a cluster on this machine for these jobs only."""
IN_FLIGHT = 4
"""Jobs per processor that are submitted to Ray at a time; more would cost it memory and time."""
TRIES = 5
"""How often in a row a job may be started without progress. Each new checkpoint resets the count."""
_LOOK_SECONDS = 0.5


@dataclass
class RetryLimit:
    """Counts how often each job's process or node was lost without progress."""

    _seen: dict[Path, tuple[str, int]] = field(default_factory=dict)

    def may_go_on(self, job: Job) -> bool:
        """Records that a job was lost, and returns whether to try it again."""
        checkpoint = job.newest()
        previous, count = self._seen.get(job.folder, (checkpoint, 0))
        count = count + 1 if checkpoint == previous else 1
        self._seen[job.folder] = checkpoint, count
        return count < TRIES

    def reason(self, job: Job, error: Exception) -> str:
        """Why a job is abandoned: its worlds, the last error, and what to do."""
        message = str(error).strip().partition("\n")[0]
        return (
            f"its process was lost {TRIES} times in a row without a new checkpoint, the last time with: {message} Its "
            f"worlds: {job.describe()}. If memory runs out, take nodes with more, or fewer `worlds` in a batch; if "
            "nodes live too briefly, lower --checkpoint"
        )


def make_on_ray(jobs: Sequence[T], address: str, display: JobListener[T], workers: int = 0) -> dict[Path, Outcome]:
    """Runs jobs on a cluster, with one processor for each. Ctrl-C stops them after their current windows.

    Args:
        jobs: The jobs to run.
        address: Address of the cluster, or `LOCAL`.
        display: Listener that is notified when a job ends.
        workers: Processors of a local cluster; 0 for all.

    Returns:
        How each job ended, by the folder of its run; jobs that never started are missing.

    Raises:
        EnsembleError: Ray is not installed, or there is no cluster at the address.
    """
    ray = import_ray()
    try:
        if address == LOCAL:
            # A new cluster, even if another is running; it accepts connections from this machine only.
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
    """Imports Ray with the settings that it reads on import.

    Raises:
        EnsembleError: Ray is not installed.
    """
    # No usage statistics unless the user asks for them.
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    # Nodes have hedon installed. Otherwise, under `uv run`, Ray would copy this folder to each node and build it there.
    os.environ.setdefault("RAY_ENABLE_UV_RUN_RUNTIME_ENV", "0")
    try:
        return import_module("ray")
    except ImportError:
        raise EnsembleError('--ray needs the optional packages: pip install "hedon[ray]"') from None


def _see_through(ray: Any, jobs: Sequence[T], limit: RetryLimit, display: JobListener[T]) -> dict[Path, Outcome]:
    """Submits jobs and waits for them; lost jobs are submitted again as long as they make progress."""
    lost_errors = (ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError, ray.exceptions.OutOfMemoryError)
    # Ray's own retries never end if memory runs out, and ignore whether a job makes progress.
    remote = ray.remote(num_cpus=1, max_retries=0)(attempt)
    capacity = IN_FLIGHT * max(1, int(ray.cluster_resources().get("CPU", 1)))
    remaining, waiting = iter(jobs), dict[Any, T]()
    outcomes: dict[Path, Outcome] = {}
    with count_interrupts() as interrupted:
        handled_count = 0
        while True:
            free = 0 if interrupted.count else capacity - len(waiting)
            waiting |= {remote.remote(job, 1): job for job in islice(remaining, free)}
            if not waiting:
                break
            for finished in ray.wait(list(waiting), num_returns=len(waiting), timeout=_LOOK_SECONDS)[0]:
                job = waiting.pop(finished)
                try:
                    outcome = ray.get(finished)
                except ray.exceptions.RayError as error:
                    if interrupted.count:  # the job was canceled
                        continue
                    if isinstance(error, lost_errors) and limit.may_go_on(job):
                        waiting[remote.remote(job, 1)] = job
                        continue
                    outcome = Outcome(
                        "failed", limit.reason(job, error) if isinstance(error, lost_errors) else str(error)
                    )
                outcomes[job.folder] = outcome
                display.end(job, outcome)
            if handled_count < interrupted.count:
                handled_count = interrupted.count
                for reference in waiting:  # jobs that have not started are dropped; the others receive Ctrl-C
                    ray.cancel(reference, force=handled_count > 1)
    return outcomes
