"""Runs a sweep on a Ray cluster: a task per batch, begun again on another node when its node dies.

A task goes on from its batch's last checkpoint. It finds that in the sweep's folder, which all nodes must share, or
behind the sweep's URL.
"""

import hashlib
import os
import tempfile
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from hedon.experiment.interrupt import count_interrupts
from hedon.jobs.process import Display
from hedon.jobs.work import Outcome, attempt
from hedon.sweep.conduct import open_batches, tasks
from hedon.sweep.error import SweepError
from hedon.sweep.hold import hold
from hedon.sweep.loss import Losses
from hedon.sweep.plan import SweepPlan
from hedon.sweep.store import Store
from hedon.sweep.work import Task

LOCAL = "local"
"""The address of a cluster that is started on this machine, for the sweep alone."""
_LOOK_SECONDS = 0.5


def run_on_ray(
    plan: SweepPlan,
    store: Store,
    address: str,
    display: Display[Task],
    checkpoint_seconds: float,
    part: tuple[int, int] = (1, 1),
    workers: int = 0,
) -> dict[str, Outcome]:
    """Makes all batches that have no result; one processor each. Ctrl-C ends it after the current windows.

    Args:
        plan: of the sweep.
        store: where it lives: a folder that all nodes share, or a URL that all reach.
        address: of the cluster, or `LOCAL`.
        display: shows how each batch ends.
        checkpoint_seconds: between two checkpoints of a batch [s].
        part: which batches, as `hedon.sweep.conduct.open_batches`.
        workers: processors of a local cluster; 0 for all.

    Returns:
        How each batch ended, by name; those that never began are missing.

    Raises:
        SweepError: Ray is not installed, there is no cluster at the address, or another process makes these batches.
    """
    ray = import_ray()
    # Of this place and plan alone: what another sweep left on a node must not be gone on with.
    own = hashlib.sha256(f"{store.location} {plan.steps} {plan.digests}".encode()).hexdigest()[:16]
    scratch = Path(tempfile.gettempdir()) / f"hedon-sweep-{plan.name}-{own}"
    try:
        if address == LOCAL:
            # A new one, also where another runs. It answers here alone.
            settings = {"num_cpus": workers or None, "include_dashboard": False, "_node_ip_address": "127.0.0.1"}
            ray.init(address="local", log_to_driver=False, **settings)
        else:
            ray.init(address=address, log_to_driver=False)
    except (ConnectionError, ValueError, RuntimeError) as error:
        raise SweepError(f"--ray = {address!r}: no cluster answers there: {error}") from error
    try:
        with hold(store, part):
            jobs = tasks(plan, store, open_batches(plan, store, part), scratch, checkpoint_seconds)
            return _see_through(ray, jobs, Losses(store), display)
    finally:
        ray.shutdown()


def import_ray() -> Any:
    """Ray, told what a sweep wants of it; its settings count when it is imported.

    Raises:
        SweepError: It is not installed.
    """
    # It reports to nobody unless asked to.
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    # Each node has its own hedon. Else, under `uv run`, Ray copies the current folder to each node and builds it there.
    os.environ.setdefault("RAY_ENABLE_UV_RUN_RUNTIME_ENV", "0")
    try:
        return import_module("ray")
    except ImportError:
        raise SweepError('--ray needs the optional packages: pip install "hedon[ray]"') from None


def _see_through(ray: Any, jobs: Sequence[Task], losses: Losses, display: Display[Task]) -> dict[str, Outcome]:
    """Submits batches and awaits them; those whose process is lost again, as long as that leads further."""
    lost = (ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError, ray.exceptions.OutOfMemoryError)
    # Ray's own tries have no end where memory runs out, and do not see whether a batch gets further.
    remote = ray.remote(num_cpus=1, max_retries=0)(attempt)
    waiting = {remote.remote(job, 1): job for job in jobs}
    outcomes: dict[str, Outcome] = {}
    with count_interrupts() as interrupted:
        told = 0
        while waiting:
            for done in ray.wait(list(waiting), num_returns=len(waiting), timeout=_LOOK_SECONDS)[0]:
                job = waiting.pop(done)
                try:
                    outcome = ray.get(done)
                except ray.exceptions.RayError as error:
                    if interrupted.count:  # it was called off
                        continue
                    if isinstance(error, lost) and losses.may_go_on(job):
                        waiting[remote.remote(job, 1)] = job
                        continue
                    outcome = Outcome("failed", losses.reason(job, error) if isinstance(error, lost) else str(error))
                outcomes[job.batch.name] = outcome
                display.end(job, outcome)
            if told < interrupted.count:
                told = interrupted.count
                for each in waiting:  # those that have not begun are dropped, others get Ctrl-C
                    ray.cancel(each, force=told > 1)
    return outcomes
