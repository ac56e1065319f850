"""The command `hedon`."""

import errno
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from itertools import pairwise
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperGroup

from hedon.cli import assay, config, export, study, sweep
from hedon.cli.analyze import analyze
from hedon.cli.branch import branch
from hedon.cli.check import check
from hedon.cli.compare import compare
from hedon.cli.forecast import forecast
from hedon.cli.option import refused_value
from hedon.cli.output import OutputError, give_up, guard, pipe_closed
from hedon.cli.power import power
from hedon.cli.report import report
from hedon.cli.resume import resume
from hedon.cli.run import run
from hedon.cli.view import view
from hedon.error import HedonError
from hedon.limit import address_limit
from hedon.text import printable

NO_MEMORY = (
    "there is no more memory: lower population.capacity, world.rollout_steps or the number of seeds, "
    "or check the limit `ulimit -v`"
)
_CLOSED = 141  # exit code of a command whose output is no longer read, by the shells' convention: 128 plus SIGPIPE
ADDRESSES = 2_000_000_000
"""Memory that the libraries of a command reserve at most, before any world [byte]. Some abort if they get none."""

GONE = {
    ("reproduce",): "call `hedon study`: list, plan, run and report, with the same names of items",
    ("bench",): "the benchmarks are not in the package any more: call `uv run python -m benchmarks` in a checkout",
    ("demography",): "it is `hedon forecast` now",
    ("assay", "start"): "it is `hedon assay stability` now",
    ("diff",): "it is `hedon check RUN --against RUN` now",
    ("replay-fault",): "it is `hedon check RUN --fault` now",
    ("contrast",): "it is `hedon compare` now",
    ("study", "script"): "it is `hedon study run NAME --slurm` now",
    ("sweep", "script"): "it is `hedon sweep run FILE --slurm` now",
    ("video",): "it is `hedon export video` now",
}
"""Former commands, with their replacements."""
GONE_OPTIONS = {("run", "--device"): "--backend", ("power", "--against"): "the second PILOT"}
"""New names of options, by command and old name."""


GROUPS = {
    "Run worlds": {
        "run": "Run worlds, then write their report.",
        "resume": "Continue a run as if it had never stopped.",
        "branch": "Continue from a checkpoint with changed settings.",
    },
    "See what happened": {
        "view": "Watch a run, or a live world, in the browser.",
        "report": "Write one page of figures, tables and claims.",
        "analyze": "Answer statistical questions about runs.",
        "check": "Check that a run is complete and undamaged.",
        "export": "Write the records of a run for other tools.",
    },
    "Many worlds": {
        "sweep": "Vary settings and seeds.",
        "compare": "Compare two conditions, from any source.",
        "power": "Find out how many worlds show an effect.",
        "assay": "Measure fitness directly.",
        "study": "Answer a question: conditions, figures, claims.",
    },
    "Settings": {
        "presets": "List the presets.",
        "config": "Show, compare and check configs.",
        "forecast": "Predict from settings whether a world survives.",
    },
}
"""Commands in the order of the help."""


class Grouped(TyperGroup):
    """Commands whose help lists them by group, and whose options explain a value that they refuse."""

    def invoke(self, ctx: Any) -> Any:
        """Runs the command; a value that cannot be used ends it with one message."""
        try:
            return super().invoke(ctx)
        except typer.BadParameter as error:
            if not (message := refused_value(error)):
                raise
            fail(message)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Writes the list of commands."""
        del ctx
        for title, commands in GROUPS.items():
            with formatter.section(title):
                formatter.write_dl(list(commands.items()))


app = typer.Typer(
    name="hedon",
    cls=Grouped,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

# One file per command or group of commands.
for command in (run, resume, branch, view, report, analyze, compare, power, forecast, check, config.presets):
    app.command()(command)
for group in (export, assay, sweep, study, config):
    app.add_typer(group.app, name=group.__name__.rpartition(".")[2])


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
      hedon run poison --seeds 1-6 --steps 1024000 --out runs/poison
      hedon view --live
      hedon compare runs/poison runs/baseline
    """


def main(command: typer.Typer = app) -> None:
    """Runs a command line; a problem that the user can fix ends in one message and exit code 2."""
    sys.stdout, sys.stderr = guard(sys.stdout), guard(sys.stderr)
    _require_addresses()
    os.environ["MPLBACKEND"] = "agg"  # figures go to files, whatever backend the user's sessions use
    if command is app:
        _refuse_gone(sys.argv[1:])
        _refuse_empty(sys.argv[1:])
    try:
        try:
            command()
        finally:
            sys.stdout.flush()  # here, because at exit Python would print its own traceback
    except SystemExit as ending:
        if not pipe_closed() or ending.code not in (None, 0, _CLOSED):
            raise
        if ending.code == _CLOSED:  # the closed pipe has ended a run early
            typer.echo("hedon: interrupted: its output is no longer read", err=True)
        sys.exit(_CLOSED)
    except HedonError as error:
        fail(str(error))
    except OSError as error:
        if error.errno == errno.ENOMEM:
            fail(NO_MEMORY)
        if error.filename is None:
            raise
        # The file system refuses a path or cannot read it; any use of a path can raise this.
        fail(f"{error.filename}: {error.strerror}")
    except MemoryError:
        fail(NO_MEMORY)


def _refuse_gone(words: Sequence[str]) -> None:
    """Ends a command line that uses a command or option of an earlier version, with the replacement."""
    for gone, instead in GONE.items():
        if tuple(words[: len(gone)]) == gone:
            fail(f"there is no command '{' '.join(gone)}': {instead}")
    for (command, option), name in GONE_OPTIONS.items():
        if words[:1] == [command] and any(word.partition("=")[0] == option for word in words):
            fail(f"there is no option {option}: it is {name} now")


def _refuse_empty(words: Sequence[str]) -> None:
    """Ends a command line with an empty option, such as from an unset variable."""
    for word, following in pairwise([*words, "-"]):
        option, equals, value = word.partition("=")
        if option.startswith("--") and not (value if equals else following):
            fail(f"{option}: is empty")


def _require_addresses() -> None:
    """Ends the command if a limit on addresses leaves no room for its libraries."""
    allowed = address_limit()
    if allowed is not None and allowed < ADDRESSES:
        fail(
            f"`ulimit -v` allows this process {allowed / 1e9:.1f} GB of addresses, and hedon needs "
            f"at least {ADDRESSES / 1e9:.0f} GB: raise the limit"
        )


def fail(message: str) -> NoReturn:
    """Ends the command with a message and exit code 2. Names in it may hold any character, so it is made printable."""
    with suppress(OutputError):  # no stream is left for messages
        typer.echo(f"hedon: {printable(message)}", err=True)
    give_up()
    sys.exit(2)
