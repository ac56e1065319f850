"""Estimates how long the items of a request take on this machine, in total and for missing runs."""

from dataclasses import dataclass, replace
from pathlib import Path

from hedon.ensemble.ensemble import Ensemble, find_ensemble
from hedon.ensemble.run_job import run_jobs
from hedon.record.provenance import usable_cpus
from hedon.study.request import Request, needs
from hedon.study.speed import Speed, measure_speed


@dataclass(frozen=True)
class Cost:
    """The time that some items take.

    Attributes:
        total: Time for all runs that they need [s].
        left: Time for the runs that are still missing [s].
    """

    total: float
    left: float


@dataclass(frozen=True)
class RequestCost:
    """The time that a request takes.

    Attributes:
        items: Cost of each item by itself, in order.
        together: Cost of all items, with shared worlds counted once.
        speeds: Measured speeds, by number of food kinds.
    """

    items: tuple[Cost, ...]
    together: Cost
    speeds: dict[int, Speed]


def request_cost(request: Request, folder: Path, threads: int) -> RequestCost:
    """Measures the speed of this machine, which takes seconds, and estimates the time for the runs of a request.

    Args:
        request: The items with their scale.
        folder: Folder of existing runs.
        threads: Number of threads that the runs will use; 0 for all.
    """
    threads = threads or usable_cpus()
    speeds: dict[int, Speed] = {}

    def seconds(ensemble: Ensemble) -> float:
        total = 0.0
        for job in run_jobs(ensemble):
            kinds = len(job.plan.config.food)  # the size of networks depends on the number of food kinds
            if kinds not in speeds:
                speeds[kinds] = measure_speed(job.plan.config, threads)
            total += job.world_steps / speeds[kinds].rate
        return total

    def cost(requested: Request) -> Cost:
        demands = needs(requested)
        return Cost(seconds(Ensemble(demands, folder)), seconds(find_ensemble(demands, folder)))

    items = tuple(cost(replace(request, items=(item,))) for item in request.items)
    return RequestCost(items, cost(request), speeds)
