"""`hedon replay-fault`: shows the fault again at which a run stopped."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.run import Threads


def replay_fault(
    run: Annotated[Path, typer.Argument(help="Folder of a run that stopped at a fault; it is only read.")],
    threads: Threads = 0,
) -> None:
    """Go on from the last checkpoint before a run's fault, and see whether the fault recurs.

    Exit code 0 where it does, 1 where it does not: then its cause lies outside of the rules.

    \b
    Example:
      hedon replay-fault runs/baseline
    """
    from hedon.experiment.fault import replay_fault as replay

    found = replay(run, threads)
    typer.echo(f"recorded: {found.recorded}")
    typer.echo(f"from step {found.start:,} on: {found.recurred or 'no fault'}")
    if found.recurred == found.recorded:
        typer.echo("The same fault recurs.")
        return
    typer.echo("It does not recur: suspect the memory of the machine, or a change of hedon's source.")
    raise typer.Exit(1)
