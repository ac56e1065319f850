"""Runs a sweep on one machine: a process per batch, as many at a time as there are workers."""

import tempfile
from collections.abc import Iterable
from pathlib import Path

from hedon.experiment.plan import Moment
from hedon.jobs.process import Display, conduct
from hedon.jobs.work import Outcome
from hedon.sweep.hold import hold
from hedon.sweep.plan import Batch, SweepPlan
from hedon.sweep.store import Store
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
    workers: int,
    display: Display[Task],
    checkpoint_seconds: float,
    part: tuple[int, int] = (1, 1),
) -> dict[str, Outcome]:
    """Makes all batches that have no result, one thread each; the last one gets all that are free.

    Ctrl-C or SIGTERM ends it after the current windows, a second one immediately; what was done is kept. A batch that
    fails does not end the others.

    Args:
        plan: of the sweep.
        store: where it lives.
        workers: processes at a time.
        display: shows every moment, and how each batch ends.
        checkpoint_seconds: between two checkpoints of a batch [s].
        part: which batches, as `open_batches`.

    Returns:
        How each batch ended, by name; those that never began are missing.

    Raises:
        SweepError: another process makes these batches.
    """
    with hold(store, part), tempfile.TemporaryDirectory(prefix="hedon-sweep-") as scratch:
        jobs = tasks(plan, store, open_batches(plan, store, part), Path(scratch), checkpoint_seconds)
        outcomes = conduct(jobs, workers, display)
    names = {job.folder: job.batch.name for job in jobs}
    return {names[folder]: outcome for folder, outcome in outcomes.items()}


class Silent:
    """A display that shows nothing."""

    def update(self, job: Task, moment: Moment) -> None:
        """Shows nothing.

        Args:
            job: That goes on.
            moment: How far it is.
        """

    def end(self, job: Task, outcome: Outcome) -> None:
        """Shows nothing.

        Args:
            job: That ended.
            outcome: How it ended.
        """
