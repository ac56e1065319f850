"""`hedon branch`: continues from a run's checkpoint with changed settings."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.run import Checkpoint, Report, Threads, run_and_report
from hedon.experiment.argument import MAX_STEPS, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS


def branch(
    run: Annotated[Path, typer.Argument(help="Folder of the run to branch from; it is only read.")],
    out: Annotated[
        Path | None, typer.Option(help="Folder of the new run; by default next to the old one, named after the step.")
    ] = None,
    at: Annotated[int | None, typer.Option(help="Step of one of the run's checkpoints; by default the newest.")] = None,
    steps: Annotated[
        int | None,
        typer.Option(help="Total steps of each world; by default as in the old run.", min=1, max=MAX_STEPS),
    ] = None,
    seeds: Annotated[
        str | None, typer.Option(help="Replay the tape: one future of a world per seed, as in 1-30.")
    ] = None,
    of: Annotated[
        int | None,
        typer.Option(
            metavar="SEED", help="With --seeds: the seed of the world that gets futures, if the old run has several."
        ),
    ] = None,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change one setting; repeatable.")
    ] = None,
    threads: Threads = 0,
    frames: Annotated[
        int | None, typer.Option(help="Save all positions every N steps; by default as in the old run.", min=0)
    ] = None,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
    report: Report = True,
) -> None:
    """Continue from a checkpoint as a new run, with changed settings or different chance events.

    Without --set and --seeds the worlds continue unchanged in a new folder. With --seeds, one world has several
    futures, which begin with the same agents and differ only by chance. Settings that fix the layout of the saved
    worlds (arena, numbers of rays and touch sectors, kinds of food, window) cannot be changed.

    \b
    Examples:
      hedon branch runs/baseline --steps 400000 --set food.normal.growth_rate=0.2
      hedon branch runs/baseline --at 102400 --out runs/poorer --set energy.basic_cost=0.001
      hedon branch runs/baseline --steps 409600 --seeds 1-30 --of 1
    """
    from hedon.experiment.branch import plan_branch, start_branch

    futures = None if seeds is None else parse_seeds(seeds, "--seeds")
    plan = plan_branch(run, out, overrides or (), at, steps, threads, frames, checkpoint, futures, of)
    begun = f" from step {plan.parent.step:,}"
    run_and_report(plan.run, lambda callback: start_branch(plan, [callback]), begun, report=report)
