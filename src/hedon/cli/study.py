"""`hedon study`: questions, the worlds that answer them, and pages with the results."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.cluster import ClusterOptions
from hedon.cli.console import make_console
from hedon.cli.make import make_worlds, require_finished, require_folder, tell_few_seeds, tell_left_out
from hedon.cli.option import with_options
from hedon.cli.run import Threads
from hedon.error import HedonError
from hedon.experiment.argument import MAX_STEPS, parse_seeds
from hedon.text import count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from hedon.study.request import Request
    from hedon.study.study import Study

QUICK = ((1,), 2048)
"""Seeds and steps of a trial that only checks that everything works."""

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Run studies: questions with their claims, figures and tables. docs/guide/study.md explains it.",
)


class RunsError(HedonError):
    """Invalid arguments of a study's command."""


Names = Annotated[list[str], typer.Argument(metavar="NAME...", help="Studies, items of them, or all.")]
Seeds = Annotated[
    str | None, typer.Option(help="One world per seed, as in 1-5; by default, and for pictures, the item's own.")
]
Steps = Annotated[
    int | None,
    typer.Option(help="Steps of each world; by default, and for pictures, the item's own.", min=1, max=MAX_STEPS),
]
FidelityName = Annotated[str, typer.Option("--fidelity", help="corrected, released or as_printed.")]
Quick = Annotated[bool, typer.Option("--quick", help="One seed and 2,048 steps, only to check that everything works.")]
Runs = Annotated[Path, typer.Option(help="Folder of the runs: existing runs are used, missing ones are added.")]
Out = Annotated[
    Path | None, typer.Option(help="Folder of the page, the figures and the tables; by default studies/NAME.")
]


@app.command("list")
def list_studies() -> None:
    """List the studies and their items, including studies from other packages.

    \b
    Example:
      hedon study list
    """
    from hedon.cli.display.listing import catalogue
    from hedon.study.catalogue import installed

    studies, faults = installed()
    make_console().print(catalogue(studies.values()))
    for fault in faults.values():
        typer.echo(f"hedon: note: left out: {fault}", err=True)


@app.command()
def plan(
    names: Names,
    seeds: Seeds = None,
    steps: Steps = None,
    fidelity: FidelityName = "corrected",
    quick: Quick = False,
    threads: Threads = 0,
    runs: Runs = Path("runs"),
) -> None:
    """Show what each item needs, and measure how long it takes on this machine; makes no runs.

    \b
    Examples:
      hedon study plan kanagawa-doya-2024
      hedon study plan weights-baseline history-baseline --seeds 1-2 --steps 1024000
    """
    from hedon.cli.display.listing import listing
    from hedon.cli.display.step import StepDisplay
    from hedon.study.cost import request_cost

    _, request = _request(names, seeds, steps, fidelity, quick=quick)
    if not quick:
        _tell_few_seeds(request)
    with StepDisplay("planning") as tell:
        tell(0, 1, "measuring the speed of this machine takes some seconds")
        cost = request_cost(request, runs, threads)
    make_console().print(listing(request, cost))


@app.command()
@with_options(ClusterOptions)
def run(
    names: Names,
    seeds: Seeds = None,
    steps: Steps = None,
    fidelity: FidelityName = "corrected",
    quick: Quick = False,
    threads: Threads = 0,
    runs: Runs = Path("runs"),
    out: Out = None,
    *,
    options: ClusterOptions,
) -> None:
    """Make the runs that are missing, then the report.

    Existing runs are used, including longer ones and those from `hedon run`; shorter runs are continued. Worlds
    that die out count and are never replaced. Ctrl-C ends all runs after their current windows, a second one
    immediately; the same command continues. At the scale of a paper this takes days: run `hedon study plan` first.
    With --part, it makes a part of the worlds and no report, so that machines can share a folder of runs. With --slurm,
    it writes a job array that does so; afterwards, `hedon study report` reads the runs.

    \b
    Examples:
      hedon study run hazard birth walk body parameters
      hedon study run weights-baseline --seeds 1-2 --steps 1024000
      hedon study run fear --quick
      hedon study run fear --runs /shared/runs --slurm --jobs 100
    """
    studies, request = _request(names, seeds, steps, fidelity, quick=quick)
    if not quick:
        _tell_few_seeds(request)
    if options.slurm:
        _script(studies, request, names, threads or 1, runs, options)
    else:
        _make(studies, request, runs, out or _folder(studies), threads, options.ray, options.part, make_console())


@app.command()
def report(
    names: Names,
    seeds: Seeds = None,
    steps: Steps = None,
    fidelity: FidelityName = "corrected",
    runs: Runs = Path("runs"),
    out: Out = None,
) -> None:
    """Make figures, tables, verdicts and one page from existing runs.

    \b
    Example:
      hedon study report kanagawa-doya-2024
    """
    studies, request = _request(names, seeds, steps, fidelity)
    folder = out or _folder(studies)
    require_folder(folder)
    _report(studies, request, runs, folder, make_console())


def _request(
    names: "Sequence[str]", seeds: str | None, steps: int | None, fidelity: str, *, quick: bool = False
) -> "tuple[tuple[Study, ...], Request]":
    # Imported here because this takes seconds, and other commands must not wait for it.
    from hedon.config import FIDELITIES
    from hedon.config.problem import did_you_mean
    from hedon.study.catalogue import choose
    from hedon.study.request import Request

    if fidelity not in FIDELITIES:
        hint = did_you_mean(fidelity, FIDELITIES)
        raise RunsError(f"--fidelity: {fidelity!r} is not one of {', '.join(FIDELITIES)}{hint}")
    if quick and (seeds is not None or steps is not None):
        raise RunsError("--quick: has seeds and steps of its own: leave out --seeds and --steps")
    studies = choose(names)
    items = tuple(item for study in studies for item in study.items)
    own = QUICK if quick else (parse_seeds(seeds, "--seeds") if seeds is not None else None, steps)
    return studies, Request(items, fidelity, *own)


def _tell_few_seeds(request: "Request") -> None:
    """Reports what the item with the fewest seeds cannot show."""
    items = [item for item in request.items if item.conditions and not item.pictures]
    if items:
        fewest = min(items, key=lambda item: len(request.scale(item).seeds))
        of = fewest.name if len(items) > 1 else ""
        tell_few_seeds(len(request.scale(fewest).seeds), compared=True, of=of)


def _script(
    studies: "Sequence[Study]",
    request: "Request",
    names: "Sequence[str]",
    threads: int,
    runs: Path,
    options: ClusterOptions,
) -> None:
    """Writes the script of a job array. All nodes must share the folder of the runs."""
    from hedon.ensemble.demand import worlds_of
    from hedon.study.request import needs

    name = studies[0].name if len(studies) == 1 else "studies"
    asked = {"--fidelity": request.fidelity, "--threads": str(threads), "--runs": str(runs.absolute())}
    asked |= {} if request.seeds is None else {"--seeds": ",".join(map(str, request.seeds))}
    asked |= {} if request.steps is None else {"--steps": str(request.steps)}
    words = ["study", "run", *names, *(word for pair in asked.items() for word in pair)]
    path = options.write_script(Path(f"{name}.sh"), name, words, worlds_of(needs(request)), threads)
    make_console().print(f"wrote {path}. Next: sbatch {path}", soft_wrap=True)


def _folder(studies: "Sequence[Study]") -> Path:
    return Path("studies") / (studies[0].name if len(studies) == 1 else "several")


def _make(
    studies: "Sequence[Study]",
    request: "Request",
    runs: Path,
    out: Path,
    threads: int,
    ray: str | None,
    part: str | None,
    console: "Console",
) -> None:
    from hedon.ensemble.demand import parse_part, part_of
    from hedon.study.request import needs

    runs = runs if ray is None else runs.absolute()  # other nodes have another current folder
    demands = part_of(needs(request), parse_part(part))
    if part is None:
        require_folder(out)
    what = f"{count(len(request.items), 'item')} ({request.fidelity})"
    made = make_worlds(demands, runs, what, console, threads, ray)
    if part is None:
        _report(studies, request, runs, out, console)
    require_finished(*made, console)


def _report(studies: "Sequence[Study]", request: "Request", runs: Path, out: Path, console: "Console") -> None:
    from hedon.report.study import write_studies
    from hedon.study.gather import gather

    gathered = gather(request, runs)
    tell_left_out(gathered.faults)
    page = write_studies(studies, gathered, out)
    for item in request.items:
        console.print(f"{item.name}: {item.title}", soft_wrap=True)
    console.print(f"wrote {page}, with all figures and tables next to it", soft_wrap=True)
