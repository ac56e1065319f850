"""`hedon sweep`: runs many conditions and seeds, and collects the results in one table."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.cluster import ClusterOptions
from hedon.cli.console import make_console
from hedon.cli.make import make_runs, require_finished, tell_few_seeds
from hedon.cli.option import with_options
from hedon.cli.run import Checkpoint
from hedon.record.folder import CHECKPOINT_SECONDS
from hedon.text import command_word, count, printable

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.ensemble.plan import SweepFile, SweepPlan
    from hedon.ensemble.store import Store

PRINTED = 40
"""Maximum number of conditions printed at the end of a sweep."""
app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Run many settings and seeds, and collect the results in one table. docs/guide/sweep.md explains it.",
)

File = Annotated[Path, typer.Argument(metavar="SWEEP.toml", help="The file of a sweep.")]
Place = Annotated[str, typer.Argument(metavar="FOLDER", help="Folder or URL (s3://…) of the sweep.")]
Out = Annotated[
    str | None,
    typer.Option(metavar="FOLDER|URL", help="Folder or URL of the sweep; by default sweeps/ and the file's name."),
]
SkipInvalid = Annotated[
    bool, typer.Option("--skip-invalid", help="List invalid combinations of settings, and leave them out.")
]
Workers = Annotated[int, typer.Option(help="Processes at a time; 0 for all processors. Changes no result.", min=0)]


@app.command()
def plan(file: File, skip_invalid: SkipInvalid = False) -> None:
    """Show what a sweep would run; writes nothing.

    \b
    Example:
      hedon sweep plan cost.toml
    """
    from hedon.config.problem import format_value
    from hedon.sweep.read import read_sweep

    console, asked = make_console(), read_sweep(file, skip_invalid=skip_invalid)
    made = asked.plan
    _say_left_out(asked, console)
    _say_size(made, console)
    _tell_few_seeds(made)
    for name in made.factors:
        values = list(dict.fromkeys(format_value(each.settings[name]) for each in made.conditions))
        shown = ", ".join(values[:8]) + (f", … {values[-1]}" if len(values) > 8 else "")
        console.print(f"  {name}: {len(values)} values: {shown}", soft_wrap=True)


@app.command()
@with_options(ClusterOptions)
def run(
    file: File,
    out: Out = None,
    workers: Workers = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
    skip_invalid: SkipInvalid = False,
    *,
    options: ClusterOptions,
) -> None:
    """Run a sweep, then print its table. The same command continues an unfinished sweep.

    Worlds of one condition share a process, and conditions take turns. Each finished batch is written to disk at once;
    Ctrl-C or a kill loses only what unfinished batches did after their last checkpoint. If the file now has more
    seeds or values, only missing worlds are run, also by a process that is already running the sweep.

    \b
    Examples:
      hedon sweep run cost.toml --workers 2
      hedon sweep run cost.toml --out s3://bucket/cost
      hedon sweep run cost.toml --out /shared/cost --slurm --jobs 100
    """
    _run_or_script(*_written(file, out, skip_invalid=skip_invalid), workers, checkpoint, options)


@app.command()
@with_options(ClusterOptions)
def resume(
    place: Place,
    workers: Workers = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
    *,
    options: ClusterOptions,
) -> None:
    """Continue a sweep from its folder or URL; the sweep file is not needed.

    \b
    Example:
      hedon sweep resume sweeps/cost --workers 2
    """
    _run_or_script(*_opened(place), workers, checkpoint, options)


@app.command()
def status(place: Place) -> None:
    """Show how far a sweep is, and how long the rest will take.

    \b
    Example:
      hedon sweep status sweeps/cost
    """
    from hedon.cli.display.run import duration
    from hedon.ensemble.status import sweep_status

    (made, store), console = _opened(place), make_console()
    _say_size(made, console)
    found = sweep_status(made, store)
    batches, worlds = count(found.batches, "batch"), count(found.worlds, "world")
    console.print(f"  done: {found.done} of {batches}, {worlds}, {found.extinct} extinct")
    for name, share in found.begun.items():
        console.print(f"  begun: {name}, {100 * share:.0f} %")
    if found.seconds_left is not None and found.done < found.batches:
        console.print(f"  left: {duration(found.seconds_left)} of one worker; so far {duration(found.seconds)}")


@app.command()
def collect(place: Place) -> None:
    """Write one table, a row per world: FOLDER/table.parquet. Works while the sweep runs.

    Columns: condition, number of the replicate, seed, the settings that vary, digest of the world's end, and its
    part of summary.json. Worlds that died out have a row too.

    \b
    Example:
      hedon sweep collect sweeps/cost
    """
    from hedon.ensemble.collect import collect as write_table
    from hedon.ensemble.plan import TABLE

    made, store = _opened(place)
    table = write_table(made, store)
    make_console().print(
        f"wrote {store.location}/{TABLE}: {table.height} of {count(made.worlds, 'world')}", soft_wrap=True
    )


@app.command()
def report(
    place: Place,
    only: Annotated[
        str | None, typer.Option(metavar="COLUMN,…", help="Columns of the table to show; by default the usual ones.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Folder of the report; by default FOLDER/report.")] = None,
) -> None:
    """Draw response curves and heat maps with intervals. Works while the sweep runs.

    \b
    Examples:
      hedon sweep report sweeps/cost
      hedon sweep report sweeps/cost --only alive_mean,w_action_mean
    """
    from hedon.compare.sweep_answer import sweep_answer
    from hedon.ensemble.collect import collect as write_table
    from hedon.ensemble.plan import load_bases
    from hedon.measure.world_measure import titles_of
    from hedon.report.answer import write_answer

    made, store = _opened(place)
    names = [name.strip() for name in only.split(",")] if only else []
    folder = out or (store.folder or Path("sweeps") / made.name) / "report"
    found = sweep_answer(made, write_table(made, store), names, titles_of(load_bases(made, store)))
    figures = [path for path in write_answer(folder, found) if path.suffix == ".svg"]
    page = folder / f"{found.name}.html"
    make_console().print(f"wrote {page}, its data and {count(len(figures), 'figure')} beside it", soft_wrap=True)


def _written(file: Path, out: str | None, *, skip_invalid: bool) -> "tuple[SweepPlan, Store]":
    """The plan of a sweep file, written to the sweep's folder or URL."""
    from hedon.ensemble.plan import write_plan
    from hedon.ensemble.store import Store
    from hedon.sweep.read import read_sweep

    asked = read_sweep(file, skip_invalid=skip_invalid)
    _say_left_out(asked, make_console())
    store = Store(out or str(Path("sweeps") / asked.plan.name))
    return write_plan(asked, store), store


def _opened(place: str) -> "tuple[SweepPlan, Store]":
    """The plan of an existing sweep."""
    from hedon.ensemble.plan import load_plan
    from hedon.ensemble.store import Store

    store = Store(place)
    return load_plan(store), store


def _say_size(made: "SweepPlan", console: "Console") -> None:
    batches = len(made.rounds) * len(made.conditions)
    console.print(
        f"hedon: sweep {made.name}: {count(len(made.conditions), 'setting')} x {count(len(made.seeds), 'seed')} x "
        f"{count(made.steps, 'step')} = {made.world_steps:,} world-steps, in {count(batches, 'batch')}",
        soft_wrap=True,
    )


def _tell_few_seeds(made: "SweepPlan") -> None:
    """Reports what a sweep cannot show. Values drawn from ranges need no repetition: neighbors are grouped."""
    if not made.ranged:
        tell_few_seeds(len(made.seeds), compared=len(made.conditions) > 1)


def _say_left_out(asked: "SweepFile", console: "Console") -> None:
    for reason in asked.left_out:
        console.print(f"  left out: {printable(reason)}", soft_wrap=True)


def _run_or_script(made: "SweepPlan", store: "Store", workers: int, checkpoint: float, options: ClusterOptions) -> None:
    """Runs a sweep, or writes a script that does. Its folder must be a URL or shared by all nodes."""
    _say_size(made, make_console())
    _tell_few_seeds(made)
    if not options.slurm:
        _run_and_report(made, store, workers, options.ray, options.part, checkpoint)
        return
    path = Path(f"{made.name}.sh") if store.folder is None else store.folder.with_name(f"{store.folder.name}.sh")
    place = store.location if store.folder is None else str(store.folder.absolute())
    words = ["sweep", "resume", place, "--workers", str(workers or 1), "--checkpoint", f"{checkpoint:g}"]
    batches = len(list(made.batches()))
    options.write_script(path, f"the sweep {made.name}", words, batches, workers or 1)
    make_console().print(f"wrote {path}. Next: sbatch {shlex.quote(str(path))}", soft_wrap=True)


def _run_and_report(
    made: "SweepPlan", store: "Store", workers: int, ray: str | None, part: str | None, checkpoint: float
) -> None:
    """Runs open batches, including ones added meanwhile, and prints the table. Raises EnsembleError if one failed."""
    from hedon.cli.display.analysis import analysis_group
    from hedon.compare.sweep_answer import settings_table
    from hedon.ensemble.batches import batch_jobs
    from hedon.ensemble.collect import collect as write_table
    from hedon.ensemble.demand import parse_part
    from hedon.ensemble.plan import load_bases, load_plan
    from hedon.measure.world_measure import titles_of

    console, share, again = make_console(), parse_part(part), f"Go on with: hedon sweep resume {_quoted(store)}"
    while True:
        with batch_jobs(made, store, checkpoint, share, on_cluster=ray is not None) as jobs:
            console.print(f"  {count(len(jobs), 'batch')} to make in {store.location}", soft_wrap=True)
            ends = make_runs(jobs, console, workers, ray) if jobs else {}
        require_finished(jobs, ends, console, again)
        before, made = made, load_plan(store)
        if made == before:
            break
        console.print("The sweep has grown meanwhile:")
    if part is None:
        titles = titles_of(load_bases(made, store))
        table = settings_table(made, write_table(made, store), most=PRINTED, titles=titles)
        console.print(analysis_group({"sweep": table}))
    console.print(f"All done. Next: hedon sweep report {_quoted(store)}", soft_wrap=True)


def _quoted(store: "Store") -> str:
    return command_word(store.location)
