"""The command: `python -m benchmarks`, from a checkout."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console
from hedon.cli.main import main
from hedon.cli.run import require_backend

if TYPE_CHECKING:
    from rich.console import Console

    from benchmarks.bench import Bench
    from benchmarks.measure import Table


def bench(
    parts: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[PART]...", help="What to measure; by default all that need neither a device nor minutes."
        ),
    ] = None,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write all raw numbers to this file.")
    ] = None,
    preset: Annotated[str, typer.Option(help="The condition: a preset or a config file.")] = "baseline",
    threads: Annotated[
        str, typer.Option(metavar="N,...", help="Numbers of threads; by default 1, 2, 4 ... all processors.")
    ] = "",
    worlds: Annotated[
        str,
        typer.Option(metavar="N,...", help="Numbers of worlds; by default 1, and one per thread on all processors."),
    ] = "",
    slots: Annotated[
        str,
        typer.Option(metavar="N,...", help="Sizes for discs, growth and crowd: 200,2000,20000,100000."),
    ] = "",
    kernel: Annotated[str, typer.Option(metavar="NAME", help="One instruction set instead of all.")] = "",
    windows: Annotated[int, typer.Option(help="Timed windows of whole worlds.", min=2, max=10_000)] = 8,
    device: Annotated[str | None, typer.Option(help="Measure the part device on this: cuda.")] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Tiny sizes, to see that everything works; the numbers have no meaning.")
    ] = False,
) -> None:
    """Measure how fast hedon is on this machine, compared with what the machine can do.

    \b
    Parts:
      rays      one agent's rays
      forward   one agent's network, acting
      update    PPO of one learner, on one thread
      physics   the rigid bodies of a populated world
      discs     a crowd of driven discs, 150 to 20,000
      world     whole worlds with learning, by threads, worlds and instruction sets
      records   writing a run's tables
      startup   from the start of a process to its first step
      value     one world as bytes, and back
      rule      rules in Python, beside the formulas of a config; needs hedon[rules]
      device    whole worlds on a device, by numbers of worlds; needs --device, and is then the only part by default
      growth    one world without learning, up to 500 times as large; takes minutes and 21 GB
      crowd     one world full of learning founders, up to 500 times as large; takes half an hour, and 37 GB of
                memory or 10 GB and a disk (HEDON_SCRATCH)

    Other programs may use the machine too. So the cases are measured in turn, several times, and times are
    medians with quartiles: compare only numbers from one run. Every part checks what it measured; if a check
    fails, the exit code is 1.

    \b
    Examples:
      python -m benchmarks
      python -m benchmarks world --threads 1,2,4 --worlds 1,4 --windows 20
      python -m benchmarks rays forward update --kernel avx2
      python -m benchmarks growth --json growth.json
      python -m benchmarks --device cuda --worlds 1,64,256
    """
    from benchmarks.bench import Bench, choose, need_writable
    from benchmarks.check import CheckError
    from benchmarks.machine import drifts
    from benchmarks.plan import make_plan

    require_backend(device)
    on = device or ""
    chosen = choose(parts or (), on)
    plan = make_plan(
        preset,
        threads=threads,
        worlds=worlds,
        slots=slots,
        kernel=kernel,
        windows=windows,
        quick=quick,
        device=on,
    )
    if json_file is not None:
        need_writable(json_file)
    measured = Bench(plan)
    console = make_console()
    _print_machine(console, measured)
    try:
        for table in measured.run(chosen):
            _print_table(console, table, _rates(measured))
    except CheckError as error:
        part = next(name for name in chosen if name not in measured.rows)
        typer.echo(f"hedon: {part} is not reported, because its check failed: {error}", err=True)
        raise typer.Exit(1) from None
    for line in drifts(measured.before, measured.after):
        console.print(f"warning: the machine's speed changed during the run: {line}", style="yellow")
    if json_file is not None:
        measured.save(json_file)
        console.print(f"wrote {json_file}", soft_wrap=True)


def _print_machine(console: "Console", measured: "Bench") -> None:
    machine = measured.machine
    revision = (machine["git_revision"] or "unknown")[:10] + (" with changes" if machine["git_modified"] else "")
    console.print(f"{machine['processor']}, {machine['cores']} cores, {', '.join(machine['instruction_sets'])}")
    console.print(f"hedon {machine['hedon_version']}, revision {revision}, {machine['date']}, {measured.plan.preset}")


def _print_table(console: "Console", table: "Table", caption: str) -> None:
    from hedon.cli.display.table import PrintedTable

    text = [i for i, heading in enumerate(table.headings) if heading == "kernel"]
    console.print()
    console.print(PrintedTable(table.headings, table.lines, title=table.title, text=text))
    for note in (*table.notes, caption):
        console.print(note, style="dim", markup=False)


def _rates(measured: "Bench") -> str:
    """The machine's rates in one line."""
    rates, kernel = measured.before, measured.plan.kernel
    adds = ", ".join(f"{rate:.0f} on {n}" for n, rate in rates.multiply_add_gflops[kernel].items())
    reads = ", ".join(f"{rate:.0f} on {n}" for n, rate in rates.cache_read_gbytes_per_s.items())
    copy = rates.copy_gbytes_per_s
    return f"machine: {kernel} multiply-adds {adds} [GF/s by threads]; cache reads {reads}, copies {copy:.0f} [GB/s]"


app = typer.Typer(rich_markup_mode=None, pretty_exceptions_enable=False)
app.command(context_settings={"help_option_names": ["-h", "--help"]})(bench)

if __name__ == "__main__":
    main(app)
