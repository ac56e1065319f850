"""Common parts of the commands of `hedon assay`: options, runs, and output of the answers."""

import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.cluster import ClusterOptions, own_words
from hedon.cli.console import make_console
from hedon.cli.make import make_worlds, require_finished, tell_few_seeds
from hedon.cli.run import Checkpoint, Threads
from hedon.experiment.argument import MAX_STEPS, parse_seeds
from hedon.record.folder import CHECKPOINT_SECONDS

if TYPE_CHECKING:
    from hedon.assay.sample import Sample
    from hedon.config.config import Config
    from hedon.ensemble.demand import Demand
    from hedon.record.founder import Founders
    from hedon.report.answer import Answer

SOURCES = "a table (.csv), RUN@STEP, RUN for its end, or a point such as food=5,action=0"
STEPS = 204_800

Source = Annotated[str, typer.Argument(metavar="CONDITION", help="A preset's name or a config file (.toml).")]
Seeds = Annotated[str, typer.Option(help="One world per seed: 7, or 1-5, or 1,4,7-9.")]
Species = Annotated[str | None, typer.Option(help="Whose genes, if there are several species; by default the first.")]


@dataclass(frozen=True)
class _Worlds:
    seeds: Seeds = "1-10"
    steps: Annotated[int, typer.Option(help="Steps of each world.", min=1, max=MAX_STEPS)] = STEPS
    out: Annotated[
        Path | None, typer.Option(help="Folder of the assay; by default one under assays/ for these settings.")
    ] = None
    threads: Threads = 0
    checkpoint: Checkpoint = CHECKPOINT_SECONDS


@dataclass(frozen=True)
class WorldOptions(ClusterOptions, _Worlds):
    """Options of every assay: its worlds, and how to run them."""

    def answer(self, kind: str, demands: "Sequence[Demand]", ask: "Callable[[Sequence[Sample]], Answer]") -> None:
        """Makes or reads the worlds of an assay, and prints and writes the answer.

        Raises:
            RecordError: A folder holds a run with other settings or founders.
            EnsembleError: A run failed.
        """
        from hedon.assay.option import assay_folder
        from hedon.assay.sample import read_samples
        from hedon.cli.display.analysis import analysis_group
        from hedon.ensemble.demand import parse_part, part_of, worlds_of
        from hedon.report.answer import write_answer

        console, folder = make_console(), self.out or assay_folder(kind, demands[0])
        if self.ray is not None or self.slurm:
            folder = folder.absolute()  # other machines have another current folder
        tell_few_seeds(min(len(demand.steps) for demand in demands), compared=False)
        if self.slurm:
            words = [*own_words("--jobs", "--hours", "--out"), "--out", str(folder)]
            path = self.write_script(Path(f"{folder.name}.sh"), kind, words, worlds_of(demands), self.threads or 1)
            console.print(f"wrote {path}. Next: sbatch {shlex.quote(str(path))}", soft_wrap=True)
            return
        config, asked = demands[0].config, part_of(demands, parse_part(self.part))
        what = f"{kind}, {config.name} ({config.fidelity})"
        made = make_worlds(asked, folder, what, console, self.threads, self.ray, self.checkpoint)
        require_finished(*made, console)
        if self.part is not None:
            console.print("This part is done. When all are, the same command without --part answers.", soft_wrap=True)
            return
        answer = ask(read_samples(demands, folder))
        files = write_answer(folder, answer)
        console.print(analysis_group({table.name: table for table in answer.tables}))
        console.print(f"wrote {', '.join(map(str, files))}", soft_wrap=True)


@dataclass(frozen=True)
class _Setting:
    fidelity: Annotated[str | None, typer.Option(help="corrected (default), released or as_printed.")] = None
    overrides: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Change one setting; repeatable.")
    ] = None


@dataclass(frozen=True)
class AssayOptions(WorldOptions, _Setting):
    """Options of an assay that starts from a condition: changes of its settings, then the options of every assay."""

    def config(self, source: str) -> "Config":
        """The condition with its changes. Raises ConfigError if it is invalid."""
        from hedon.config.load import load_config

        return load_config(source, self.fidelity, self.overrides or ())

    def worlds(self, config: "Config", founders: "Founders | None", part: str = "run") -> "Demand":
        """Worlds that the assay needs."""
        from hedon.assay.option import assay_worlds

        return assay_worlds(config, parse_seeds(self.seeds, "--seeds"), self.steps, founders, part)


@dataclass(frozen=True)
class ContingencyOptions(WorldOptions):
    """The same, with default seeds that a first run would not use."""

    seeds: Seeds = "101-110"


@dataclass(frozen=True)
class StabilityOptions(AssayOptions):
    """The same with fewer worlds, as each must evolve."""

    seeds: Seeds = "1-5"


@dataclass(frozen=True)
class _Place:
    condition: Annotated[
        str | None,
        typer.Option(
            "--in", metavar="PRESET|FILE", help="The world; by default that of the first run given, or baseline."
        ),
    ] = None
    species: Species = None


@dataclass(frozen=True)
class ContestOptions(AssayOptions, _Place):
    """Options of assays in which groups compete: the condition, then the options of every assay."""

    def setting(self, *sources: str) -> "tuple[Config, str]":
        """The condition without mutation, and the species whose groups compete.

        Raises:
            ConfigError: The condition is invalid.
            ArgumentError: There is no such species.
        """
        from hedon.assay.landscape import without_mutation
        from hedon.assay.option import condition_of
        from hedon.config.layout import choose_species

        config = without_mutation(self.config(condition_of(self.condition, sources)))
        return config, choose_species(self.species, config)
