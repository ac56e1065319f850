"""`hedon assay frequency`: fitness of one group against another, by its share."""

from typing import Annotated

import typer

from hedon.cli.assay import STEPS, Fidelity, Out, Overrides, Seeds, Species, Steps, finish, make
from hedon.cli.assay_contest import SOURCES, Condition, without_mutation_of
from hedon.cli.console import make_console
from hedon.cli.run import Checkpoint, Threads, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS

SHARES = "0.05,0.25,0.5,0.75,0.95"


def frequency(
    a: Annotated[str, typer.Argument(metavar="A", help=f"Genomes: {SOURCES}.")],
    b: Annotated[str, typer.Argument(metavar="B", help="Genomes likewise.")],
    shares: Annotated[
        str, typer.Option(metavar="SHARE,…", help="Of A among the founders, one run for each; two or more.")
    ] = SHARES,
    condition: Condition = None,
    species: Species = None,
    seeds: Seeds = "1-10",
    steps: Steps = STEPS,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    out: Out = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
) -> None:
    """Fitness against frequency: is the rarer of two groups the fitter one?

    As compete, from several shares of A. Prints the selection coefficient of A per generation at each share, its slope
    over the share, and the share at which neither grows, all with intervals over seeds. If each group grows where it is
    rare, the two can live together. Ctrl-C ends it, and the same command goes on; further shares are added to those
    that are there if the first is the same or --out is given.

    \b
    Examples:
      hedon assay frequency food=5,action=0 food=0,action=5
      hedon assay frequency runs/a@1000000 runs/b@1000000 --shares 0.1,0.5,0.9 --seeds 1-30
      hedon assay frequency see_prey=2 see_prey=-2 --in predator --species prey
    """
    from hedon.assay.contest import run_lines
    from hedon.assay.frequency import estimate_frequency
    from hedon.assay.option import assay_plan, competitors, condition_of, parse_shares
    from hedon.assay.report import world_line, write_assay
    from hedon.assay.report_frequency import draw_frequency, frequency_json, frequency_tables

    config, own = without_mutation_of(condition_of(condition, (a, b)), fidelity, overrides, species)
    parts, plans, groups = parse_shares(shares, config, own), [], (a, b)
    for share in parts:
        founders, groups = competitors((a, b), (share, 1.0 - share), config, own)
        folder = plans[0].out.parent if plans else out
        part = f"share-{share:g}"
        plans.append(
            assay_plan("frequency", config, parse_seeds(seeds), steps, folder, threads, checkpoint, founders, part)
        )
    console = make_console()
    runs = make(plans, console)
    if runs is None:
        return
    read = [run_lines(run, groups, own) for run in runs]
    found = estimate_frequency(groups, {share: lines for share, (lines, _) in zip(parts, read, strict=True)})
    tables = frequency_tables(found)
    intro = f"{groups[0]} against {groups[1]} from several shares, without mutation. {world_line(runs)}"
    files = write_assay(
        plans[0].out.parent, "frequency", runs, read[0][1], frequency_json(found), tables, intro, draw_frequency(found)
    )
    finish(tables, files, console)


def add_to(app: typer.Typer) -> None:
    """Adds the command to `hedon assay`."""
    app.command()(frequency)
