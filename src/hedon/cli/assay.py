"""`hedon assay`: measure fitness directly, with founders of chosen genes."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console
from hedon.cli.run import Checkpoint, Threads, parse_seeds
from hedon.experiment.argument import MAX_STEPS
from hedon.record.folder import CHECKPOINT_SECONDS
from hedon.text import printable

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.analysis.result import ResultTable
    from hedon.experiment.plan import RunPlan
    from hedon.record.reader import Run

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Measure fitness directly: founders with chosen genes compete. docs/guide/fitness.md explains each assay.",
)

Source = Annotated[str, typer.Argument(metavar="CONDITION", help="A preset's name or a config file (.toml).")]
Seeds = Annotated[str, typer.Option(help="One world per seed: 7, or 1-5, or 1,4,7-9.")]
Steps = Annotated[int, typer.Option(help="Steps of each world.", min=1, max=MAX_STEPS)]
Fidelity = Annotated[str | None, typer.Option(help="corrected (default), released or text.")]
Overrides = Annotated[
    list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change one setting; repeatable.")
]
Species = Annotated[
    str | None, typer.Option(help="Whose genes, where there are several species; by default the first.")
]
Out = Annotated[Path | None, typer.Option(help="Folder of the assay; by default one under assays/ for these settings.")]
STEPS = 204_800


@app.command()
def landscape(
    source: Source,
    seeds: Seeds = "1-10",
    steps: Steps = STEPS,
    spread: Annotated[
        str, typer.Option("--range", metavar="LOW:HIGH", help="Founders' genes lie evenly between these.")
    ] = "-8:8",
    sd: Annotated[float | None, typer.Option(help="Founders' genes are normal with this sd instead.", min=0.0)] = None,
    genes: Annotated[
        str | None, typer.Option(metavar="GENE,GENE", help="The two genes of the surface; by default food,action.")
    ] = None,
    species: Species = None,
    ends: Annotated[
        list[Path] | None,
        typer.Option(metavar="RUN|FILE", help="Show where these runs, summary.json or study.json ended."),
    ] = None,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    out: Out = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
) -> None:
    """Fitness as a surface over two genes.

    Founders are spread over all genes, and there is no mutation: descendants have the genes of their founder. Their
    numbers, children, food and lifespans, relative to the mean of their world, give a surface over two genes, with
    its optimum, its slope at 0 and its curvature. Sixteen neutral genes show what chance alone gives.

    Ctrl-C ends it, and the same command goes on. A finished assay is only read.

    \b
    Examples:
      hedon assay landscape baseline
      hedon assay landscape poison --genes poison,action --seeds 1-20
      hedon assay landscape predator --species prey --genes see_predator,see_prey
      hedon assay landscape baseline --set population.initial_count=100 --ends runs/baseline-corrected-s1-5
    """
    from hedon.assay.end import read_ends, reported_ends
    from hedon.assay.landscape import assay_config, measure_landscape, spread_founders
    from hedon.assay.option import assay_plan, choose_genes, parse_spread
    from hedon.assay.report_landscape import landscape_tables, write_landscape
    from hedon.config.layout import choose_species
    from hedon.config.load import load_config

    config = assay_config(load_config(source, fidelity, overrides or ()))
    own = choose_species(species, config)
    pair = choose_genes(genes, config, own)
    found = [] if len(config.species) > 1 else reported_ends(config)
    found += [end for path in ends or () for end in read_ends(path, config, own)]
    founders = spread_founders(config, parse_spread(spread, sd, config.species[own].genome), own)
    plan = assay_plan("landscape", config, parse_seeds(seeds), steps, out, threads, checkpoint, founders)
    console = make_console()
    runs = make([plan], console)
    if runs is None:
        return
    measured = measure_landscape(runs[0], pair, own)
    finish(landscape_tables(measured, found), write_landscape(measured, runs[0], found, plan.out.parent), console)


def make(plans: "Sequence[RunPlan]", console: "Console") -> "tuple[Run, ...] | None":
    """The runs of an assay, made or read; None if one was interrupted, which it prints.

    Args:
        plans: Of the runs.
        console: To print on.

    Raises:
        RecordError: A folder holds a run with other settings, founders or seeds.
        JobError: A run failed.
    """
    from hedon.cli.display.job import JobDisplay
    from hedon.jobs.error import JobError
    from hedon.jobs.make import make_jobs
    from hedon.jobs.run import RunJob, unfinished
    from hedon.record.reader import open_run

    jobs = [RunJob(plan, plan.steps * len(plan.seeds)) for plan in unfinished(plans)]
    for job in jobs:
        config, plan = job.plan.config, job.plan
        console.print(
            f"hedon: {config.name} ({config.fidelity}), {len(plan.seeds)} worlds, {plan.steps:,} steps, "
            f"into {printable(str(plan.out))}",
            soft_wrap=True,
        )
    with JobDisplay(console, jobs) as display:
        outcomes = make_jobs(jobs, display, plans[0].threads)
    if faults := [outcome.fault for outcome in outcomes.values() if outcome.status == "failed"]:
        raise JobError(faults[0])
    if all(folder in outcomes and outcomes[folder].status == "finished" for folder in (job.folder for job in jobs)):
        return tuple(open_run(plan.out) for plan in plans)
    console.print("Interrupted; all results so far are kept. The same command goes on.")
    return None


def finish(tables: "Sequence[ResultTable]", files: Sequence[Path], console: "Console") -> None:
    """Prints the tables, and where they were written.

    Args:
        tables: Of the assay.
        files: That were written.
        console: Where it prints.
    """
    from hedon.cli.display.analysis import analysis_group

    console.print(analysis_group({table.name: table for table in tables}))
    console.print(f"wrote {', '.join(map(str, files))}", soft_wrap=True)
