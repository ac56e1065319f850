"""How far a sweep is, and how long it will still take."""

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
    """How far a sweep is.

    Attributes:
        batches, done: how many there are, and have a result.
        worlds: with a row in the table.
        extinct: of them, died out.
        begun: batches in progress or interrupted, by their settings and seeds, with the share of each that is recorded.
        seconds: that the batches so far took, summed over them [s].
        seconds_left: of one worker for all the rest, if it goes as fast as so far [s]; None before the first result.
    """

    batches: int
    done: int
    worlds: int
    extinct: int
    begun: dict[str, float]
    seconds: float
    seconds_left: float | None


def sweep_status(plan: SweepPlan, store: Store) -> Status:
    """Reads how far a sweep is, from its results and, where they are in its folder, from its runs under way."""
    missing, done, seconds, worlds = open_batches(plan, store), 0, 0.0, list[dict[str, Any]]()
    for _, result in read_results(plan, store):
        done, seconds = done + 1, seconds + (result["seconds"] or 0.0)
        worlds += [{"extinct": world["extinct"]} for world in result["worlds"]]
    begun, left = {}, 0.0
    for batch in missing:
        share = None if store.folder is None else _share(store, batch.name, plan.steps)
        left += len(batch.seeds) * (1.0 - (share or 0.0))
        if share is not None:
            begun[describe(plan.conditions[batch.condition].settings, batch.seeds)] = share
    rate = seconds / len(worlds) if worlds else None  # [s] of each world
    return Status(
        batches=len(missing) + done,
        done=done,
        worlds=len(worlds),
        extinct=sum(world["extinct"] for world in worlds),
        begun=begun,
        seconds=seconds,
        seconds_left=None if rate is None else rate * left,
    )


def _share(store: Store, name: str, steps: int) -> float | None:
    assert store.folder is not None
    folder = store.folder / WORK / name
    if not folder.is_dir():
        return None
    try:
        population = open_run(folder).population(skip_damaged=True)
    except (HedonError, OSError):  # it is being made, or removed since it is done
        return None
    last = population["step"].max() if population.height else 0
    return float(last) / steps if isinstance(last, int) else 0.0
