"""`hedon assay stability`: evolution from a claimed end point."""

from typing import Annotated

import typer

from hedon.cli.assay import STEPS, Fidelity, Out, Overrides, Seeds, Source, Steps, finish, make
from hedon.cli.console import make_console
from hedon.cli.run import Checkpoint, Threads, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS

Point = Annotated[str, typer.Option("--at", metavar="GENE=VALUE,…", help="Where founders begin: food=5,action=5.")]


def stability(
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
      hedon assay stability baseline --at food=5,action=5
      hedon assay stability baseline --at food=5,action=-5 --beside food=0,action=0 --steps 1024000
    """
    from hedon.assay.option import assay_plan, stability_config
    from hedon.assay.report import world_line, write_assay
    from hedon.assay.report_stability import draw_stability, stability_json, stability_tables
    from hedon.assay.stability import measure_stability
    from hedon.config.load import load_config
    from hedon.record.founder_source import parse_point

    config = load_config(source, fidelity, overrides or ())
    points = {"start": at} | ({} if beside is None else {"beside": beside})
    configs = {part: stability_config(config, parse_point(point, config)) for part, point in points.items()}
    first = assay_plan(
        "stability", configs["start"], parse_seeds(seeds), steps, out, threads, checkpoint, None, "start"
    )
    plans = [
        assay_plan("stability", each, first.seeds, steps, first.out.parent, threads, checkpoint, None, part)
        for part, each in configs.items()
    ]
    console = make_console()
    runs = make(plans, console)
    if runs is None:
        return
    starts = [measure_stability(run) for run in runs]
    tables = stability_tables(starts)
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
    figure = draw_stability(starts)
    files = write_assay(
        first.out.parent, "stability", runs, first.config, stability_json(starts), tables, intro, figure
    )
    finish(tables, files, console)


def add_to(app: typer.Typer) -> None:
    """Adds the command to `hedon assay`."""
    app.command()(stability)
