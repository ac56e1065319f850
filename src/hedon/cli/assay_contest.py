"""`hedon assay compete`, `invade` and `knockout`: two groups of genomes in one world."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.assay import STEPS, Fidelity, Out, Overrides, Seeds, Species, Steps, finish, make
from hedon.cli.console import make_console
from hedon.cli.run import Checkpoint, Threads, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS

if TYPE_CHECKING:
    from hedon.config.config import Config
    from hedon.record.founder import Founders

SOURCES = "a table (.csv), RUN@STEP, RUN for its end, or a point such as food=5,action=0"
Condition = Annotated[
    str | None,
    typer.Option("--in", metavar="PRESET|FILE", help="The world; by default that of the first run named, or baseline."),
]


def compete(
    a: Annotated[str, typer.Argument(metavar="A", help=f"Genomes: {SOURCES}.")],
    b: Annotated[str, typer.Argument(metavar="B", help="Genomes likewise.")],
    condition: Condition = None,
    species: Species = None,
    seeds: Seeds = "1-10",
    steps: Steps = STEPS,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    out: Out = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
) -> None:
    """Two groups in one world, in equal numbers: which one grows?

    Half of the founders come from A and half from B; nothing mutates. Prints the selection coefficient of A per
    generation with an interval over worlds, and the log ratio of the numbers over time. Ctrl-C ends it, and the same
    command goes on.

    \b
    Examples:
      hedon assay compete food=5,action=5 food=0.5,action=0
      hedon assay compete runs/a@1000000 runs/b@1000000 --in baseline --seeds 1-20
      hedon assay compete food=1 food=0 --set population.initial_count=100
      hedon assay compete see_predator=-5 see_predator=0 --in predator --species prey
    """
    from hedon.assay.option import competitors, condition_of

    config, own = without_mutation_of(condition_of(condition, (a, b)), fidelity, overrides, species)
    founders, groups = competitors((a, b), (0.5, 0.5), config, own)
    _contest("compete", config, own, founders, groups, seeds, steps, out, threads, checkpoint)


def invade(
    resident: Annotated[str, typer.Argument(metavar="RESIDENT", help=f"Genomes: {SOURCES}.")],
    mutant: Annotated[str, typer.Argument(metavar="MUTANT", help="Genomes likewise.")],
    share: Annotated[float, typer.Option(help="Of the mutant among the founders.", min=0.001, max=0.999)] = 0.1,
    condition: Condition = None,
    species: Species = None,
    seeds: Seeds = "1-10",
    steps: Steps = STEPS,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    out: Out = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
) -> None:
    """A few mutants among many residents: do they spread?

    As compete, but the mutant begins with a small share. Numbers are those of the mutant against the resident.

    \b
    Example:
      hedon assay invade food=0.5,action=0 food=5,action=5 --share 0.06
    """
    from hedon.assay.option import competitors, condition_of

    config, own = without_mutation_of(condition_of(condition, (resident, mutant)), fidelity, overrides, species)
    founders, groups = competitors((mutant, resident), (share, 1.0 - share), config, own)
    _contest("invade", config, own, founders, groups, seeds, steps, out, threads, checkpoint)


def knockout(
    run: Annotated[str, typer.Argument(metavar="RUN[@STEP]", help="A run; its living, at the end or at a step.")],
    gene: Annotated[str, typer.Argument(metavar="GENE", help="The gene to set to 0, such as food or action.")],
    condition: Condition = None,
    species: Species = None,
    seeds: Seeds = "1-10",
    steps: Steps = STEPS,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    out: Out = None,
    threads: Threads = 0,
    checkpoint: Checkpoint = CHECKPOINT_SECONDS,
) -> None:
    """The living of a run against themselves with one gene at 0: what is the gene worth?

    As compete. Below 0, the gene is worth having.

    \b
    Example:
      hedon assay knockout runs/baseline-corrected-s1-5 action --seeds 1-20
    """
    from hedon.assay.option import condition_of, knocked_out

    config, own = without_mutation_of(condition_of(condition, (run,)), fidelity, overrides, species)
    founders, groups = knocked_out(run, gene, config, own)
    _contest("knockout", config, own, founders, groups, seeds, steps, out, threads, checkpoint)


def add_to(app: typer.Typer) -> None:
    """Adds the commands to `hedon assay`."""
    for command in (compete, invade, knockout):
        app.command()(command)


def without_mutation_of(
    source: str, fidelity: str | None, overrides: list[str] | None, species: str | None
) -> "tuple[Config, str]":
    """The condition without mutation, and the species that competes with itself.

    Args:
        source: A preset's name or a config file.
        fidelity: As for a run.
        overrides: As for `--set`.
        species: As the user gave it.

    Raises:
        ConfigError: The condition cannot be used.
        ArgumentError: There is no such species.
    """
    from hedon.assay.landscape import without_mutation
    from hedon.config.layout import choose_species
    from hedon.config.load import load_config

    config = without_mutation(load_config(source, fidelity, overrides or ()))
    return config, choose_species(species, config)


def _contest(
    kind: str,
    config: "Config",
    species: str,
    founders: "Founders",
    groups: tuple[str, str],
    seeds: str,
    steps: int,
    out: Path | None,
    threads: int,
    checkpoint: float,
) -> None:
    from hedon.assay.contest import measure_contest
    from hedon.assay.option import assay_plan
    from hedon.assay.report import world_line, write_assay
    from hedon.assay.report_contest import contest_json, contest_tables, draw_contest

    plan = assay_plan(kind, config, parse_seeds(seeds), steps, out, threads, checkpoint, founders)
    console = make_console()
    runs = make([plan], console)
    if runs is None:
        return
    contest = measure_contest(runs[0], groups, species)
    tables = contest_tables(contest)
    intro = f"{groups[0]} against {groups[1]}, without mutation. {world_line(runs)}"
    figure = draw_contest(contest)
    files = write_assay(plan.out.parent, kind, runs, contest.config, contest_json(contest), tables, intro, figure)
    finish(tables, files, console)
