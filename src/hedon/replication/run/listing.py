"""What each item needs, which runs are still missing, and how long they take on this machine."""

from dataclasses import replace
from pathlib import Path

from rich.console import Group
from rich.text import Text

from hedon.experiment.progress import duration
from hedon.printed_table import PrintedTable
from hedon.record.provenance import usable_cpus
from hedon.replication.gather import find_runs
from hedon.replication.request import Request, needs
from hedon.replication.run.plan import Job, plan_jobs
from hedon.replication.run.speed import Speed, measure_speed


def listing(request: Request, folder: Path, threads: int) -> Group:
    """The items of a request as a table. First measures how fast this machine is, which takes seconds.

    Args:
        request: the items, with their scale.
        folder: of the runs.
        threads: to use; 0 for all processors.
    """
    threads = threads or usable_cpus()
    speeds: dict[int, Speed] = {}

    def seconds(jobs: list[Job]) -> float:
        total = 0.0
        for job in jobs:
            kinds = len(job.config.food)  # networks grow with the kinds of food
            if kinds not in speeds:
                speeds[kinds] = measure_speed(job.config, threads)
            total += job.world_steps / speeds[kinds].rate
        return total

    rows = []
    for item in request.items:
        one = replace(request, items=(item,))
        whole, left = map(seconds, _jobs(one, folder))
        rows.append((item.name, item.kind, item.title, _needs(one), _time(whole), _time(left)))
    whole, left = map(seconds, _jobs(request, folder))
    rows.append(("together", "", "shared worlds are counted once", "", _time(whole), _time(left)))
    headers = ("item", "kind", "what it is", "needs", "total", "still to run")
    table = PrintedTable(headers, rows, text=range(4), total=True)
    notes = [
        f"Measured now: {speed.rate:,.0f} world-steps/s on {speed.threads} thread{'s' if speed.threads > 1 else ''}"
        f" with {speed.agents:.0f} agents a world and {kinds} kind{'s' if kinds > 1 else ''} of food;"
        " worlds with more agents take longer, worlds with fewer take less time."
        for kinds, speed in speeds.items()
    ]
    return Group(table, *(Text(note, style="dim") for note in notes))


def _jobs(request: Request, folder: Path) -> tuple[list[Job], list[Job]]:
    """All runs that a request needs, and those that are still missing."""
    wanted = needs(request)
    found, _ = find_runs(folder, wanted)
    return plan_jobs(wanted, [], folder), plan_jobs(wanted, found, folder)


def _needs(request: Request) -> str:
    (item,) = request.items
    if not item.arms:
        return "only settings"
    scale = request.scale(item)
    settings, worlds = len(item.arms), len(scale.seeds)
    parts = [f"{settings} setting{'s' if settings > 1 else ''}", f"{worlds} world{'s' if worlds > 1 else ''}"]
    return ", ".join([*parts, f"{scale.steps:,} steps"])


def _time(seconds: float) -> str:
    return duration(seconds) if seconds >= 1 else "-"
