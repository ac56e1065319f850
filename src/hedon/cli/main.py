"""The command `hedon`."""

import sys
from typing import Annotated

import typer

from hedon.cli import config
from hedon.cli.analyze import analyze
from hedon.cli.bench import bench
from hedon.cli.branch import branch
from hedon.cli.check import check
from hedon.cli.demography import demography
from hedon.cli.replay_fault import replay_fault
from hedon.cli.report import report
from hedon.cli.reproduce import reproduce
from hedon.cli.resume import resume
from hedon.cli.run import run
from hedon.error import HedonError

app = typer.Typer(
    name="hedon",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

# One file per command or group of commands; they stand in the help in this order.
app.command()(run)
app.command()(resume)
app.command()(branch)
app.command()(report)
app.command()(reproduce)
app.command()(analyze)
app.command()(demography)
app.command()(check)
app.command()(replay_fault)
app.command()(config.presets)
app.command()(bench)
app.add_typer(config.app, name="config")


def _print_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        typer.echo(f"hedon {version('hedon')}")
        raise typer.Exit


@app.callback()
def _hedon(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit."),
    ] = False,
) -> None:
    """Study how reward systems evolve: agents that live, learn, breed and die in a continuous world.

    \b
    Examples:
      hedon run baseline
      hedon run poison --seeds 1-5 --steps 1024000 --out runs/poison
      hedon resume runs/poison --steps 2048000
      hedon report runs/poison
      hedon analyze runs/poison --only selection,drift
      hedon reproduce list
      hedon presets
      hedon config show baseline --set food.normal.growth_rate=0.5
      hedon bench
    """


def main() -> None:
    """Runs the command line; what the user can put right ends in one message and exit code 2."""
    try:
        app()
    except HedonError as error:
        typer.echo(f"hedon: {error}", err=True)
        sys.exit(2)
    except OSError as error:
        if error.filename is None:
            raise
        # A path that the file system does not take, or may not be read: anywhere that a path is looked at.
        typer.echo(f"hedon: {error.filename}: {error.strerror}", err=True)
        sys.exit(2)
