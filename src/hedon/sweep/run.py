"""Runs a sweep: a process per batch, as many at a time as there are workers, here or on a cluster."""

import hashlib
import tempfile
from collections.abc import Iterable
from pathlib import Path

from hedon.jobs.lock import lock
from hedon.jobs.make import make_jobs
from hedon.jobs.process import Display
from hedon.jobs.store import Store
from hedon.jobs.work import Outcome
from hedon.sweep.plan import Batch, SweepPlan
from hedon.sweep.work import RESULTS, WORK, Task, make_task


def open_batches(plan: SweepPlan, store: Store, part: tuple[int, int] = (1, 1)) -> list[Batch]:
    """The batches without a result, in their order.

    Args:
        plan: of the sweep.
        store: where it lives.
        part: number, from 1 on, and count of parts into which batches are dealt out in turn; the first of one.
    """
    number, count = part
    done = set(store.names(RESULTS))
    return [batch for batch in plan.batches()[number - 1 :: count] if f"{batch.name}.json" not in done]


def tasks(
    plan: SweepPlan, store: Store, batches: Iterable[Batch], scratch: Path, checkpoint_seconds: float
) -> list[Task]:
    """What a process is given for each batch: runs are made in the sweep's folder, or else in `scratch`.

    Args:
        plan: Of the sweep.
        store: Where the sweep lives.
        batches: Those that are not done.
        scratch: A local folder, for a sweep that lives at a URL.
        checkpoint_seconds: Time between two checkpoints [s].
    """
    place = scratch if store.folder is None else store.folder.absolute() / WORK
    where = store.location if store.folder is None else str(store.folder.absolute())
    return [make_task(where, plan, batch, place / batch.name, checkpoint_seconds) for batch in batches]


def run_sweep(
    plan: SweepPlan,
    store: Store,
    display: Display[Task],
    checkpoint_seconds: float,
    workers: int = 0,
    part: tuple[int, int] = (1, 1),
    ray: str | None = None,
) -> dict[str, Outcome]:
    """Makes all batches that have no result, one thread each; here the last one gets all that are free.

    Ctrl-C or SIGTERM ends it after the current windows, a second one immediately; what was done is kept. A batch that
    fails does not end the others.

    Args:
        plan: Of the sweep.
        store: Where it lives.
        display: Shows every moment, and how each batch ends.
        checkpoint_seconds: Between two checkpoints of a batch [s].
        workers: Processes at a time; 0 for all processors.
        part: Which batches, as `open_batches`.
        ray: Address of a cluster; see `hedon.jobs.make.make_jobs`.

    Returns:
        How each batch ended, by name; those that never began are missing.

    Raises:
        JobError: Another process makes these batches, or there is no such cluster.
    """
    with lock(store, part), tempfile.TemporaryDirectory(prefix="hedon-sweep-") as passing:
        # Of this place and plan alone: what another sweep left on a node must not be gone on with.
        own = hashlib.sha256(f"{store.location} {plan.steps} {plan.digests}".encode()).hexdigest()[:16]
        on_node = Path(tempfile.gettempdir()) / f"hedon-sweep-{plan.name}-{own}"
        scratch = Path(passing) if ray is None else on_node
        jobs = tasks(plan, store, open_batches(plan, store, part), scratch, checkpoint_seconds)
        outcomes = make_jobs(jobs, display, workers, ray)
    names = {job.folder: job.batch.name for job in jobs}
    return {names[folder]: outcome for folder, outcome in outcomes.items()}
