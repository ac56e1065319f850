"""`hedon run`: runs a condition and reports on it."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console
from hedon.cli.report import show_report
from hedon.error import HedonError
from hedon.experiment.argument import DEVICES, INSTRUCTION_SETS, MAX_STEPS, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS, require_no_run
from hedon.text import brief, command_word, count, printable

if TYPE_CHECKING:
    from hedon.experiment.plan import Callback, RunPlan
    from hedon.record.manifest import Manifest

DEFAULT_STEPS = 204_800
"""200 windows of the baseline: about two minutes on two cores."""

_BACKENDS = (*INSTRUCTION_SETS, *DEVICES)
"""All values of `--backend`."""

Threads = Annotated[int, typer.Option(help="Threads; 0 for all processors. Changes no result.", min=0, max=1024)]
Checkpoint = Annotated[float, typer.Option(help="Seconds between two checkpoints; 0 for every window.", min=0.0)]
Report = Annotated[bool, typer.Option(help="Write a report at the end; `hedon report` writes it at any time.")]


class RunError(HedonError):
    """Invalid arguments of `hedon run`."""


def run(
    source: Annotated[
        str, typer.Argument(metavar="PRESET|FILE", help="A preset's name or a config file (.toml).")
    ] = "baseline",
    seeds: Annotated[str, typer.Option(help="One world per seed: 7, or 1-5, or 1,4,7-9.")] = "1",
    steps: Annotated[int, typer.Option(help="Steps of each world.", min=1, max=MAX_STEPS)] = DEFAULT_STEPS,
    threads: Threads = 0,
    out: Annotated[Path | None, typer.Option(help="Folder of the run; by default a new one under runs/.")] = None,
    frames: Annotated[int, typer.Option(help="Save all positions every N steps; 0 for never.", min=0)] = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
    fidelity: Annotated[str | None, typer.Option(help="corrected (default), released or as_printed.")] = None,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change one setting; repeatable.")
    ] = None,
    founders: Annotated[
        str | None,
        typer.Option(
            metavar="SOURCE[:SHARE],…", help="Begin with these genomes: a table (.csv), RUN@STEP, or a point."
        ),
    ] = None,
    networks: Annotated[
        str | None,
        typer.Option(metavar="RUN|FILE", help='Networks for species with learning.policy = "fixed": those of a run.'),
    ] = None,
    backend: Annotated[
        str | None,
        typer.Option(
            help=f"Instruction set or device: {', '.join(_BACKENDS)}; by default the fastest instruction set."
        ),
    ] = None,
    report: Report = True,
) -> None:
    """Run a condition, then write its report.

    Ctrl-C ends the run after the current window, a second one immediately. All results so far are kept, and `hedon
    resume` continues from there, even after a power cut.

    \b
    Examples:
      hedon run baseline
      hedon run poison --seeds 1-6 --steps 1024000 --out runs/poison
      hedon run baseline --fidelity released --set population.capacity=100
      hedon run my.toml --set food.normal.growth_rate=0.5 --frames 64
      hedon run baseline --founders runs/a@1000000:0.5,runs/b@1000000:0.5

    The environment variable HEDON_BACKEND sets the backend for every command. hedon resume continues on the run's
    device if it can be used, and otherwise on the processor, with the same bits. HEDON_SCRATCH names a folder for
    data that only learners need, for worlds larger than memory.
    """
    from hedon.config.load import load_config
    from hedon.experiment.network import networks_from
    from hedon.experiment.plan import RunPlan, default_folder
    from hedon.experiment.rule import rules_beside
    from hedon.experiment.run import run as run_plan
    from hedon.record.founder_source import read_founders

    require_backend(backend)
    config = load_config(source, fidelity, overrides or ())
    world_seeds = parse_seeds(seeds, "--seeds")
    folder = out or default_folder(config, world_seeds)
    require_no_run(folder)
    begin_with = None if founders is None else read_founders(founders, config)
    act_by = None if networks is None else networks_from(networks, config)
    kept = rules_beside(source)
    plan = RunPlan(
        config, world_seeds, steps, folder, threads, frames, checkpoint, begin_with, act_by, backend or "", kept
    )
    run_and_report(plan, lambda callback: run_plan(plan, [callback]), report=report)


def run_and_report(plan: "RunPlan", go: Callable[["Callback"], "Manifest"], begun: str = "", *, report: bool) -> None:
    """Prints what will be run, shows its progress, and reports."""
    from hedon.cli.display.run import RunDisplay, duration
    from hedon.experiment.device import few_worlds, is_device
    from hedon.experiment.interrupt import interrupted_code
    from hedon.experiment.simulation import BACKEND_VARIABLE
    from hedon.record.provenance import usable_cpus
    from hedon.record.schema import columns_of

    config, console = plan.config, make_console()
    worlds, out = count(len(plan.seeds), "world"), printable(str(plan.out))
    console.print(
        f"hedon: {config.name} ({config.fidelity}), {worlds}, {plan.steps:,} steps{begun}, into {out}",
        soft_wrap=True,
    )
    backend = plan.backend or os.environ.get(BACKEND_VARIABLE, "")
    if is_device(backend) and (advice := few_worlds(len(plan.seeds), usable_cpus())):
        console.print(advice, soft_wrap=True)
    with RunDisplay(console, columns_of(config), plan.seeds) as display:
        manifest = go(display.update)
    for seed, extinct in zip(plan.seeds, manifest.extinct_steps, strict=True):
        if extinct is not None:
            console.print(f"The world of seed {seed} died out at step {extinct:,}.")
    folder = command_word(str(plan.out))
    if manifest.status == "interrupted":
        done = max(manifest.steps_done)
        console.print(f"Interrupted after step {done:,} of {plan.steps:,}; all results up to there are kept.")
        console.print(f"Continue with: hedon resume {folder}", soft_wrap=True)
    console.print(f"{duration(manifest.run_seconds or 0.0)} of simulation.")
    if report:
        show_report(plan.out, console)
    console.print(f"Write the report{' again' if report else ''} with: hedon report {folder}", soft_wrap=True)
    unseen = "" if plan.frames else " (plots only: a run with --frames 64 also shows its agents)"
    console.print(f"Watch it in the browser with: hedon view {folder}{unseen}", soft_wrap=True)
    if manifest.status == "interrupted":
        raise typer.Exit(interrupted_code())


def require_backend(backend: str | None) -> None:
    """Refuses a value of `--backend` that cannot be used here.

    Raises:
        RunError: The backend does not exist, or cannot be used here.
    """
    from hedon import _engine
    from hedon.config.problem import did_you_mean
    from hedon.experiment.device import EMULATED, device_problem, is_device

    if backend is None:
        return
    if backend not in (*_BACKENDS, EMULATED):
        hint = did_you_mean(backend, _BACKENDS)
        raise RunError(f"--backend {brief(repr(backend))}: is none of {', '.join(_BACKENDS)}{hint}")
    here = _engine.kernel.kernel_names()
    if backend in INSTRUCTION_SETS and backend not in here:
        raise RunError(f"--backend {backend}: this processor does not have it; it has {', '.join(here)}")
    if is_device(backend) and (problem := device_problem(backend)):
        raise RunError(problem)
