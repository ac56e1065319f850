"""Lists the unfinished batches of a sweep and makes their jobs; each batch runs in its own process."""

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
    """The batches without a result, in order.

    Args:
        plan: Plan of the sweep.
        store: Where the sweep is stored.
        part: Number of a part, from 1, and the number of parts; only batches of this part are returned.
    """
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
    """The jobs of all batches without a result, one thread each; they are locked within the context (see `lock`).

    Args:
        plan: Plan of the sweep.
        store: Where the sweep is stored.
        checkpoint_seconds: Time between two checkpoints of a batch [s].
        part: Which batches to include, as for `open_batches`.
        on_cluster: Whether the jobs run on other machines.

    Raises:
        EnsembleError: Another process is running these batches.
    """
    with lock(store, part), tempfile.TemporaryDirectory(prefix="hedon-sweep-") as scratch:
        work_folder, location = Path(scratch), store.location
        if store.folder is not None:
            work_folder, location = store.folder.absolute() / WORK, str(store.folder.absolute())
        elif on_cluster:
            # Unique to this store; the name of a batch contains its config, steps and seeds.
            store_digest = hashlib.sha256(store.location.encode()).hexdigest()[:16]
            work_folder = Path(tempfile.gettempdir()) / f"hedon-sweep-{plan.name}-{store_digest}"
        batches = open_batches(plan, store, part)
        yield [batch_job(location, plan, batch, work_folder / batch.name, checkpoint_seconds) for batch in batches]
