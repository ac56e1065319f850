"""How long the items of a request take on this machine, and how much of that is still to run."""

from dataclasses import dataclass, replace
from pathlib import Path

from hedon.ensemble.ensemble import Ensemble, find_ensemble
from hedon.ensemble.run_job import run_jobs
from hedon.record.provenance import usable_cpus
from hedon.study.request import Request, needs
from hedon.study.speed import Speed, measure_speed


@dataclass(frozen=True)
class Cost:
    """How long some items take.

    Attributes:
        total: of all runs that they need [s].
        left: of those that are still missing [s].
    """

    total: float
    left: float


@dataclass(frozen=True)
class RequestCost:
    """How long a request takes.

    Attributes:
        items: of each item by itself, in their order.
        together: of all of them, where shared worlds are counted once.
        speeds: that were measured, by number of food kinds.
    """

    items: tuple[Cost, ...]
    together: Cost
    speeds: dict[int, Speed]


def request_cost(request: Request, folder: Path, threads: int) -> RequestCost:
    """Measures how fast this machine is, which takes seconds, and how long the runs of a request take."""
    threads = threads or usable_cpus()
    speeds: dict[int, Speed] = {}

    def seconds(ensemble: Ensemble) -> float:
        total = 0.0
        for job in run_jobs(ensemble):
            kinds = len(job.plan.config.food)  # networks grow with the kinds of food
            if kinds not in speeds:
                speeds[kinds] = measure_speed(job.plan.config, threads)
            total += job.world_steps / speeds[kinds].rate
        return total

    def cost(asked: Request) -> Cost:
        demands = needs(asked)
        return Cost(seconds(Ensemble(demands, folder)), seconds(find_ensemble(demands, folder)))

    items = tuple(cost(replace(request, items=(item,))) for item in request.items)
    return RequestCost(items, cost(request), speeds)
