"""What the commands of `hedon assay` share: their options, and how runs are made and answers shown."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console
from hedon.cli.run import Checkpoint, Threads, parse_seeds
from hedon.experiment.argument import MAX_STEPS
from hedon.record.folder import CHECKPOINT_SECONDS
from hedon.text import printable

if TYPE_CHECKING:
    from rich.console import Console

    from hedon.assay.report import Answer
    from hedon.config.config import Config
    from hedon.experiment.plan import RunPlan
    from hedon.record.founder import Founders
    from hedon.record.reader import Run

SOURCES = "a table (.csv), RUN@STEP, RUN for its end, or a point such as food=5,action=0"
STEPS = 204_800

Source = Annotated[str, typer.Argument(metavar="CONDITION", help="A preset's name or a config file (.toml).")]
Seeds = Annotated[str, typer.Option(help="One world per seed: 7, or 1-5, or 1,4,7-9.")]
Species = Annotated[
    str | None, typer.Option(help="Whose genes, where there are several species; by default the first.")
]


@dataclass(frozen=True)
class AssayOptions:
    """The options of every assay."""

    seeds: Seeds = "1-10"
    steps: Annotated[int, typer.Option(help="Steps of each world.", min=1, max=MAX_STEPS)] = STEPS
    fidelity: Annotated[str | None, typer.Option(help="corrected (default), released or text.")] = None
    overrides: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change one setting; repeatable.")
    ] = None
    out: Annotated[
        Path | None, typer.Option(help="Folder of the assay; by default one under assays/ for these settings.")
    ] = None
    threads: Threads = 0
    checkpoint: Checkpoint = CHECKPOINT_SECONDS

    def config(self, source: str) -> "Config":
        """The condition with its changes. ConfigError: it cannot be used."""
        from hedon.config.load import load_config

        return load_config(source, self.fidelity, self.overrides or ())

    def plan(self, kind: str, config: "Config", founders: "Founders | None", part: str = "run") -> "RunPlan":
        """A run of the assay.

        Args:
            kind: Of the assay.
            config: Of the worlds.
            founders: To begin with; None for those that the config draws.
            part: Name of the run's folder.
        """
        from hedon.assay.option import assay_plan

        seeds = parse_seeds(self.seeds)
        return assay_plan(kind, config, seeds, self.steps, self.out, self.threads, self.checkpoint, founders, part)


@dataclass(frozen=True)
class StabilityOptions(AssayOptions):
    """The same with fewer worlds: each must evolve."""

    seeds: Seeds = "1-5"


@dataclass(frozen=True)
class _Place:
    condition: Annotated[
        str | None,
        typer.Option(
            "--in", metavar="PRESET|FILE", help="The world; by default that of the first run named, or baseline."
        ),
    ] = None
    species: Species = None


@dataclass(frozen=True)
class ContestOptions(AssayOptions, _Place):
    """The options of assays in which groups compete: where, then those of every assay."""

    def setting(self, *sources: str) -> "tuple[Config, str]":
        """The condition without mutation, and the species that competes with itself.

        Args:
            sources: Of the founders; the first that is a run gives the condition if the user gave none.

        Raises:
            ConfigError: The condition cannot be used.
            ArgumentError: There is no such species.
        """
        from hedon.assay.landscape import without_mutation
        from hedon.assay.option import condition_of
        from hedon.config.layout import choose_species

        config = without_mutation(self.config(condition_of(self.condition, sources)))
        return config, choose_species(self.species, config)


def answer(plans: "Sequence[RunPlan]", ask: "Callable[[Sequence[Run]], Answer]") -> None:
    """Makes the runs of an assay, or reads them, and prints and writes what they tell; says so if one was interrupted.

    Args:
        plans: Of the runs.
        ask: What they tell.

    Raises:
        RecordError: A folder holds a run with other settings, founders or seeds.
        JobError: A run failed.
    """
    from hedon.assay.report import write_assay
    from hedon.cli.display.analysis import analysis_group
    from hedon.record.reader import open_run

    console = make_console()
    if not _make(plans, console):
        console.print("Interrupted; all results so far are kept. The same command goes on.")
        return
    found = ask([open_run(plan.out) for plan in plans])
    files = write_assay(plans[0].out.parent, found)
    console.print(analysis_group({table.name: table for table in found.tables}))
    console.print(f"wrote {', '.join(map(str, files))}", soft_wrap=True)


def _make(plans: "Sequence[RunPlan]", console: "Console") -> bool:
    """Makes the runs that are not finished; whether all are now."""
    from hedon.cli.display.job import JobDisplay
    from hedon.jobs.error import JobError
    from hedon.jobs.make import make_jobs
    from hedon.jobs.run import RunJob, unfinished

    jobs = [RunJob(plan, plan.steps * len(plan.seeds)) for plan in unfinished(plans)]
    for job in jobs:
        config, plan = job.plan.config, job.plan
        console.print(
            f"hedon: {config.name} ({config.fidelity}), {len(plan.seeds)} worlds, {plan.steps:,} steps, "
            f"into {printable(str(plan.out))}",
            soft_wrap=True,
        )
    with JobDisplay(console, jobs) as display:
        outcomes = make_jobs(jobs, display, plans[0].threads)
    if faults := [outcome.fault for outcome in outcomes.values() if outcome.status == "failed"]:
        raise JobError(faults[0])
    return all(job.folder in outcomes and outcomes[job.folder].status == "finished" for job in jobs)
