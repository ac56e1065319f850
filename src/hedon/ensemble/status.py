"""The progress of a sweep and the time that it still needs."""

from dataclasses import dataclass
from typing import Any

from hedon.ensemble.batch import WORK
from hedon.ensemble.batches import open_batches
from hedon.ensemble.collect import read_results
from hedon.ensemble.condition import describe
from hedon.ensemble.plan import SweepPlan
from hedon.ensemble.store import Store
from hedon.error import HedonError
from hedon.record.reader import open_run


@dataclass(frozen=True)
class Status:
    """The progress of a sweep.

    Attributes:
        batches, done: Number of batches, and of those with a result.
        worlds: Number of finished worlds.
        extinct: Number of finished worlds that died out.
        begun: Batches in progress or interrupted, by settings and seeds, each with the share that is recorded.
        seconds: Time that the finished batches took, summed over batches [s].
        seconds_left: Time that one worker needs for the rest at the same speed [s]; None before the first result.
    """

    batches: int
    done: int
    worlds: int
    extinct: int
    begun: dict[str, float]
    seconds: float
    seconds_left: float | None


def sweep_status(plan: SweepPlan, store: Store) -> Status:
    """Reads the progress of a sweep from its results and, if they are in its folder, from its unfinished runs."""
    missing, done, seconds, worlds = open_batches(plan, store), 0, 0.0, list[dict[str, Any]]()
    for _, result in read_results(plan, store):
        done, seconds = done + 1, seconds + (result["seconds"] or 0.0)
        worlds += [{"extinct": world["extinct"]} for world in result["worlds"]]
    begun, worlds_left = {}, 0.0
    for batch in missing:
        share = None if store.folder is None else _share(store, batch.name, plan.steps)
        worlds_left += len(batch.seeds) * (1.0 - (share or 0.0))
        if share is not None:
            begun[describe(plan.conditions[batch.condition].settings, batch.seeds)] = share
    rate = seconds / len(worlds) if worlds else None  # time per world [s]
    return Status(
        batches=len(missing) + done,
        done=done,
        worlds=len(worlds),
        extinct=sum(world["extinct"] for world in worlds),
        begun=begun,
        seconds=seconds,
        seconds_left=None if rate is None else rate * worlds_left,
    )


def _share(store: Store, name: str, steps: int) -> float | None:
    assert store.folder is not None
    folder = store.folder / WORK / name
    if not folder.is_dir():
        return None
    try:
        population = open_run(folder).population(skip_damaged=True)
    except (HedonError, OSError):  # it is being created, or was removed after it finished
        return None
    last_step = population["step"].max() if population.height else 0
    return float(last_step) / steps if isinstance(last_step, int) else 0.0
