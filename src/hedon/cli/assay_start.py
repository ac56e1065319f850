"""`hedon assay start`: evolution from a claimed end point."""

from typing import Annotated

import typer

from hedon.cli.assay import STEPS, Fidelity, Out, Overrides, Seeds, Source, Steps, finish, make
from hedon.cli.console import make_console
from hedon.cli.run import Checkpoint, Threads, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS

Point = Annotated[str, typer.Option("--at", metavar="GENE=VALUE,…", help="Where founders begin: food=5,action=5.")]


def start(
    source: Source,
    at: Point,
    beside: Annotated[
        str | None, typer.Option(metavar="GENE=VALUE,…", help="Another start to compare with: food=0,action=0.")
    ] = None,
    seeds: Seeds = "1-5",
    steps: Steps = STEPS,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    out: Out = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
) -> None:
    """Begin evolution at a claimed end point, and see whether it stays.

    Founders have the condition's own spread around the point, and mutation is on. Prints where each weight went
    beside neutral genes that begin likewise and mutate along the same pedigrees. Ctrl-C ends it, and the same command
    goes on.

    \b
    Examples:
      hedon assay start baseline --at food=5,action=5
      hedon assay start baseline --at food=5,action=-5 --beside food=0,action=0 --steps 1024000
    """
    from hedon.assay.option import assay_plan, start_config
    from hedon.assay.report import world_line, write_assay
    from hedon.assay.report_start import draw_starts, start_json, start_tables
    from hedon.assay.start import measure_start
    from hedon.config.load import load_config
    from hedon.record.founder_source import parse_point

    config = load_config(source, fidelity, overrides or ())
    points = {"start": at} | ({} if beside is None else {"beside": beside})
    configs = {part: start_config(config, parse_point(point, config)) for part, point in points.items()}
    first = assay_plan("start", configs["start"], parse_seeds(seeds), steps, out, threads, checkpoint, None, "start")
    plans = [
        assay_plan("start", each, first.seeds, steps, first.out.parent, threads, checkpoint, None, part)
        for part, each in configs.items()
    ]
    console = make_console()
    runs = make(plans, console)
    if runs is None:
        return
    starts = [measure_start(run) for run in runs]
    tables = start_tables(starts)
    intro = "\n".join(
        [
            f"Evolution from {at}{'' if beside is None else f', and from {beside}'}. {world_line(runs)}",
            "",
            *(
                f"- `{each.name}`: {each.generations:.0f} generations, {each.extinct} worlds died out"
                for each in starts
            ),
        ]
    )
    figure = draw_starts(starts)
    files = write_assay(first.out.parent, "start", runs, first.config, start_json(starts), tables, intro, figure)
    finish(tables, files, console)


def add_to(app: typer.Typer) -> None:
    """Adds the command to `hedon assay`."""
    app.command()(start)
