"""`hedon reproduce`: the paper's figures and tables, each from one command."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console
from hedon.cli.run import Threads, parse_seeds
from hedon.error import HedonError
from hedon.experiment.argument import MAX_STEPS

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.jobs.run import RunJob
    from hedon.study.request import Request

LIST = "list"


class ReproduceError(HedonError):
    """Some runs failed; the items that do not need them have been made."""


def reproduce(
    items: Annotated[
        list[str] | None, typer.Argument(metavar="[ITEM]...", help="Items or groups; list ITEM... shows only these.")
    ] = None,
    seeds: Annotated[
        str | None,
        typer.Option(help="One world per seed, as in 1-5; by default, and for pictures, the item's own."),
    ] = None,
    steps: Annotated[
        int | None,
        typer.Option(help="Steps of each world; by default, and for pictures, the item's own.", min=1, max=MAX_STEPS),
    ] = None,
    fidelity: Annotated[str, typer.Option(help="corrected, released or text.")] = "corrected",
    threads: Threads = 0,
    runs: Annotated[
        Path, typer.Option(help="Folder of the runs: existing runs are used, missing ones are added.")
    ] = Path("runs"),
    out: Annotated[Path, typer.Option(help="Folder of the page, the figures and the tables.")] = Path("reproduction"),
) -> None:
    """Make the paper's figures and tables, and our own studies.

    `hedon reproduce list` shows the items, with what each needs and how long it takes on this machine. Existing runs
    are used, also longer ones and those of `hedon run`; runs that are too short are continued. Worlds that die out
    count and are never replaced. Ctrl-C ends all runs after their current windows, a second one immediately; the same
    command continues. Without an ITEM it makes all of the paper, at the paper's scale: check first how long that takes.

    Groups: paper (all figures and tables of the paper), studies, all.

    \b
    Examples:
      hedon reproduce list
      hedon reproduce hazard birth walk body parameters
      hedon reproduce weights-baseline --seeds 1-2 --steps 1024000
      hedon reproduce list paper --seeds 1-2 --steps 1024000
      hedon reproduce faults
    """
    # Imported here because this takes seconds: other commands must not wait for it.
    from hedon.config import FIDELITIES
    from hedon.config.problem import nearest
    from hedon.study.choice import choose_items
    from hedon.study.request import Request

    names = items or []
    if fidelity not in FIDELITIES:
        near = nearest(fidelity, FIDELITIES)
        hint = f"; did you mean {near}?" if near else ""
        raise ReproduceError(f"--fidelity: {fidelity!r} is not one of {', '.join(FIDELITIES)}{hint}")
    listed = names[:1] == [LIST]
    chosen = choose_items(names[1:] or ["all"] if listed else names)
    request = Request(chosen, fidelity, parse_seeds(seeds) if seeds is not None else None, steps)
    console = make_console()
    if listed:
        _list(request, runs, threads, console)
    else:
        _make(request, runs, out, threads, console)


def _list(request: "Request", runs: Path, threads: int, console: "Console") -> None:
    from hedon.cli.display.listing import listing
    from hedon.study.cost import request_cost

    console.print(listing(request, request_cost(request, runs, threads)))


def _make(request: "Request", runs: Path, out: Path, threads: int, console: "Console") -> None:
    from hedon.cli.display.job import JobDisplay
    from hedon.jobs.process import run_jobs
    from hedon.record.provenance import usable_cpus
    from hedon.report.study import write_items
    from hedon.study.gather import find_runs, gather
    from hedon.study.plan import plan_jobs
    from hedon.study.request import needs

    wanted = needs(request)
    found, _ = find_runs(runs, wanted)
    jobs = plan_jobs(wanted, found, runs)
    demanded = sum(len(need.steps) for need in wanted)
    console.print(
        f"hedon: {count(len(request.items), 'item')} ({request.fidelity}) from {count(demanded, 'world')}: "
        f"{count(len(jobs), 'run')} to make in {runs}, {sum(job.world_steps for job in jobs):,} world-steps",
        soft_wrap=True,
    )
    for job in jobs:
        verb = "continue" if job.begun else "begin"
        worlds = count(len(job.plan.seeds), "world")
        console.print(f"  {verb} {job.folder}: {worlds} to {job.plan.steps:,} steps", soft_wrap=True)
    _require_folders(out, *([runs] if jobs else []))
    with JobDisplay(console, jobs) as display:
        outcomes = run_jobs(jobs, threads or usable_cpus(), display)
    gathered = gather(request, runs)
    for fault in gathered.faults:
        typer.echo(f"hedon: note: left out: {fault}", err=True)
    page, made = write_items(gathered, out)
    for one in made:
        console.print(f"{one.item.name}: {one.item.title}", soft_wrap=True)
    console.print(f"wrote {page}, with all figures and tables next to it", soft_wrap=True)
    _say_what_is_missing(jobs, {folder: outcome.status for folder, outcome in outcomes.items()}, console)


def count(number: int, noun: str) -> str:
    """A number of things: "1 run", "2 runs".

    Args:
        number: How many.
        noun: In the singular.
    """
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def _require_folders(*folders: Path) -> None:
    """Makes the folders that will be written to, so that a problem with them shows before the runs.

    Raises:
        ReproduceError: one cannot be made or written.
    """
    for folder in folders:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ReproduceError(f"cannot write {folder}: {error.strerror}") from None
        if not os.access(folder, os.W_OK):
            raise ReproduceError(f"cannot write {folder}: no permission")


def _say_what_is_missing(jobs: "list[RunJob]", ends: dict[Path, str], console: "Console") -> None:
    """Prints which runs are not finished.

    Raises:
        ReproduceError: a run failed.
    """
    failed = [str(job.folder) for job in jobs if ends.get(job.folder) == "failed"]
    open_jobs = [job for job in jobs if ends.get(job.folder) not in ("finished", "failed")]
    if open_jobs:
        console.print(
            f"Interrupted: {len(open_jobs)} of {len(jobs)} runs are not finished. The same command continues."
        )
    if failed:
        raise ReproduceError(f"{len(failed)} of {len(jobs)} runs failed (see the reasons above): {', '.join(failed)}")
