"""`hedon resume`: continues a run."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.run import Checkpoint, Report, Threads, run_and_report
from hedon.experiment.argument import MAX_STEPS
from hedon.record.folder import CHECKPOINT_SECONDS


def resume(
    run: Annotated[Path, typer.Argument(help="Folder of a run that was interrupted, killed, or finished.")],
    steps: Annotated[
        int | None,
        typer.Option(help="Total steps of each world, as for `hedon run`; by default unchanged.", min=1, max=MAX_STEPS),
    ] = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
    report: Report = True,
) -> None:
    """Continue a run, as if it had never stopped.

    Starts from the newest checkpoint. Later records are removed and computed again, with the same
    bits. A finished run can be made longer with --steps.

    \b
    Examples:
      hedon resume runs/baseline
      hedon resume runs/baseline --steps 2048000
    """
    from hedon.experiment.resume import continue_run, lock

    with lock(run, steps, threads, checkpoint) as found:
        for note in found.notes:
            typer.echo(f"hedon: note: {note}", err=True)
        run_and_report(
            found.plan, lambda callback: continue_run(found, [callback]), f" from step {found.step:,}", report=report
        )
