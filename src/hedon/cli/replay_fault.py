"""`hedon replay-fault`: computes the fault again at which a run stopped."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.run import Threads


def replay_fault(
    run: Annotated[Path, typer.Argument(help="Folder of a run that stopped at a fault; it is only read.")],
    threads: Threads = 0,
) -> None:
    """Compute again from the last checkpoint before a run's fault, and see whether the fault happens again.

    Exit code 0 if it does. Exit code 1 if it does not: then the machine or a changed source is the likely cause.

    \b
    Example:
      hedon replay-fault runs/baseline
    """
    from hedon.experiment.fault import replay_fault as replay

    found = replay(run, threads)
    typer.echo(f"recorded: {found.recorded}")
    typer.echo(f"from step {found.start:,} on: {found.recurred or 'no fault'}")
    if found.recurred == found.recorded:
        typer.echo("The same fault happened again.")
        return
    typer.echo("It did not happen again. Likely causes: bad memory in the machine, or a change of hedon's source.")
    raise typer.Exit(1)
