"""Runs a sweep: a process per batch, as many at a time as there are workers, here or on a cluster."""

import hashlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hedon.ensemble.batch import RESULTS, WORK, BatchJob, batch_job
from hedon.ensemble.lock import lock
from hedon.ensemble.plan import Batch, SweepPlan, done_seeds
from hedon.ensemble.store import Store


def open_batches(plan: SweepPlan, store: Store, part: tuple[int, int] = (1, 1)) -> list[Batch]:
    """The batches without a result, in their order."""
    return plan.left(done_seeds(store.names(RESULTS)), part)


@contextmanager
def batch_jobs(
    plan: SweepPlan,
    store: Store,
    checkpoint_seconds: float,
    part: tuple[int, int] = (1, 1),
    *,
    on_cluster: bool = False,
) -> Iterator[list[BatchJob]]:
    """The jobs of all batches that have no result, while no other process makes them; one thread each.

    Args:
        plan: Of the sweep.
        store: Where it lives.
        checkpoint_seconds: Between two checkpoints of a batch [s].
        part: Which batches, as `open_batches`.
        on_cluster: Whether other machines make them.

    Raises:
        EnsembleError: Another process makes these batches.
    """
    with lock(store, part), tempfile.TemporaryDirectory(prefix="hedon-sweep-") as passing:
        place, where = Path(passing), store.location
        if store.folder is not None:
            place, where = store.folder.absolute() / WORK, str(store.folder.absolute())
        elif on_cluster:
            # Of this place alone; a batch's name says its config, steps and seeds.
            own = hashlib.sha256(store.location.encode()).hexdigest()[:16]
            place = Path(tempfile.gettempdir()) / f"hedon-sweep-{plan.name}-{own}"
        batches = open_batches(plan, store, part)
        yield [batch_job(where, plan, batch, place / batch.name, checkpoint_seconds) for batch in batches]
